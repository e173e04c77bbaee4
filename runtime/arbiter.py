"""Arbiters: control modules that say which behaviors act (thesis, section 3.2.3), in SI.

An arbiter reads named quantities at its decision ticks and says how strongly each of its *choices*
holds: a number of 0 or more per choice. What a choice means (which behaviors act, which controls
are set) is the architecture's to say, so that one arbiter can serve several robots and can be held
against a log by itself.

The *register* of an arbiter is the vector that its code may read: reads, controls, constants.
"""

from dataclasses import dataclass
from enum import StrEnum
from typing import Final, final

from runtime.code import Code
from runtime.program import Binding, Constant, Control, Kind, Origin, Output, Program, Unit

LEARNERS: Final = ("alcsr", "xcsr")
"""What rules can be learned by."""


@final
class Paradigm(StrEnum):
    """How an arbiter comes to its choice."""

    RULES = "rules"
    SUBSUMPTION = "subsumption"
    WEIGHTS = "weights"
    COMPETITION = "competition"
    PLAN = "plan"
    MODULE = "module"


@final
@dataclass(frozen=True, slots=True)
class Read:
    """A quantity that the arbiter reads; a discrete one has `values`, and is their index."""

    name: str
    unit: Unit
    low: float
    high: float
    kind: Kind
    values: tuple[str, ...]
    about: str
    origin: str


@final
@dataclass(frozen=True, slots=True)
class Rule:
    """A rule, or a layer of a subsumption: `choice` holds where `when` is not zero.

    when: None for always. until: once it held, it goes on holding until this is not zero
    (hysteresis); None where it ends with `when`. lasts: it holds for at least so many seconds.
    right, wrong: of a learned rule, how often its choice was right in training.
    """

    choice: int
    when: Code | None
    until: Code | None
    lasts: float
    origin: str
    right: int = 0
    wrong: int = 0


@final
@dataclass(frozen=True, slots=True)
class Competition:
    """Competing activations, a field of their own (Large, Christensen, Bajcsy 1999, eq. 4).

    time * u_i' = a_i u_i - |a_i| u_i**3 - sum over j != i of g_ji u_j**2 u_i, plus noise.
    advantage: (k,) codes of a_i in [-1, 1]. suppression: (k, k) codes of g_ji, row j, column i.
    time: seconds. noise: standard deviation of the noise of u per square root of a second, which
    lets activations leave the unstable state 0.
    """

    advantage: tuple[Code, ...]
    suppression: tuple[tuple[Code, ...], ...]
    time: float
    noise: float


@final
@dataclass(frozen=True, slots=True)
class Agreement:
    """What it means that a robot's own arbiter decides as this one: the share of decisions.

    confidence is the verifier's. regions: cells along each read for telling where it does not.
    """

    share: float
    origin: str


@final
@dataclass(frozen=True, eq=False, slots=True)
class Arbiter:
    """A compiled arbiter; of its paradigms one is filled.

    rules: of RULES the first that holds is chosen; of SUBSUMPTION all that hold are, the first
    being the highest layer. weights: (k,) codes, of WEIGHTS. plan: of PLAN, a program with modes
    whose values are the choices. module: of MODULE, `package.module:function`.
    bindings: where reads, controls and `choice` stand in a log. learner: what its rules were
    learned by, one of `LEARNERS`; empty where its author wrote them. A learned
    arbiter is one of RULES whose last rule always holds.
    """

    name: str
    about: str
    reads: tuple[Read, ...]
    controls: tuple[Control, ...]
    constants: tuple[Constant, ...]
    outputs: tuple[Output, ...]
    choices: tuple[str, ...]
    paradigm: Paradigm
    rules: tuple[Rule, ...]
    weights: tuple[Code, ...]
    competition: Competition | None
    plan: Program | None
    module: str
    agreement: Agreement | None
    bindings: tuple[Binding, ...]
    judge_when: Code | None
    source: Origin
    learner: str = ""

    @property
    def way(self) -> str:
        """How it decides, in words: `rules`, or `rules learned by ALCSR`."""
        if not self.learner:
            return self.paradigm.value
        learned = "learned" if len(self.rules) > 1 else "to be learned"
        return f"rules {learned} by {self.learner.upper()}"

    @property
    def register(self) -> tuple[str, ...]:
        """The names of everything that its code may read: reads, controls, constants."""
        return (
            *(read.name for read in self.reads),
            *(control.name for control in self.controls),
            *(constant.name for constant in self.constants),
        )
