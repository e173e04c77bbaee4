"""The program: what the compiler emits, the runtime runs and the verifier reads.

All numbers in a program are in coherent SI units; a `Unit` only says how people read a quantity.
Every part carries `origin`, the place `file:line:column` in the user's YAML that it came from, so
that a finding at the very end still points into the spec.

The *register* of a program is the vector of everything that its code may read, in this order:
states (n), controls (p), constants (c). `Program.register` names its entries.
"""

import dataclasses
from dataclasses import dataclass
from enum import StrEnum
from typing import final

from runtime.claim import Claim
from runtime.code import Code
from runtime.table import Table


@final
class Role(StrEnum):
    """How a behavior relates to a state variable (thesis, section 3.2.2)."""

    SENSED = "sensed"
    DRIVEN = "driven"
    BOTH = "both"


@final
class Kind(StrEnum):
    """What values a state variable takes."""

    CONTINUOUS = "continuous"
    PERIODIC = "periodic"
    DISCRETE = "discrete"


@final
@dataclass(frozen=True, slots=True)
class Unit:
    """A unit as the user wrote it; `scale` is the SI value of one of it."""

    text: str
    scale: float


@final
@dataclass(frozen=True, slots=True)
class State:
    """A state variable. A periodic one has the period `high - low`.

    A discrete one has `values` (names); its numbers are their indices 0, 1, ... The one that
    `Field.mode` names changes where a guard says so, else a discrete state is sensed only.
    `closure` is the rate (for a step map: the next value) that the author assumes for a
    sensed-only variable when the behavior runs alone; without one it is held at `hold`.
    """

    name: str
    unit: Unit
    low: float
    high: float
    role: Role
    kind: Kind
    hold: float
    closure: Code | None
    values: tuple[str, ...]
    relates: tuple[str, str]
    about: str
    origin: str

    @property
    def is_driven(self) -> bool:
        """Whether the field gives a rate for this variable."""
        return self.role is not Role.SENSED


@final
@dataclass(frozen=True, slots=True)
class Control:
    """A control parameter, set from outside the behavior (thesis, section 3.2.1)."""

    name: str
    unit: Unit
    low: float
    high: float
    default: float
    about: str
    origin: str


@final
@dataclass(frozen=True, slots=True)
class Constant:
    """A named number of the spec; `fit` may refit it."""

    name: str
    unit: Unit
    value: float
    about: str
    origin: str


@final
@dataclass(frozen=True, slots=True)
class Output:
    """An output parameter: an expression of the register."""

    name: str
    unit: Unit
    code: Code
    about: str
    origin: str


@final
@dataclass(frozen=True, slots=True)
class Coordinate:
    """A coordinate that tables may stand over: an expression of one state and the controls.

    A sketch that moves with its controls keeps one small table in coordinates that move with
    them. A table that stands over it has an axis of its name; `low` to `high` is where its values
    lie for all states and controls within their domains.
    """

    name: str
    code: Code
    low: float
    high: float
    origin: str


@final
@dataclass(frozen=True, slots=True)
class Noise:
    """Restlessness of a driven state: white noise that is added to its rate.

    size: over the register; the standard deviation that it adds up to in one second, growing with
    the square root of time (of a step map: that is added at each step).
    """

    state: str
    size: Code
    origin: str


@final
@dataclass(frozen=True, slots=True)
class Guard:
    """A way out of a mode, taken as soon as `condition` is zero or more.

    mode, target: indices of values of the discrete state `Field.mode`. condition: over the
    register; it is positive where the guard is open. resets: the value (SI) that each named state
    jumps to, worked out before any of them has jumped; the others stay.
    """

    mode: int
    target: int
    condition: Code
    resets: tuple[tuple[str, Code], ...]
    origin: str


@final
@dataclass(frozen=True, slots=True)
class Term:
    """`coefficient(register) * tables[table][column]`, added to the rate of `driven[component]`.

    The coefficient reads only controls, constants and discrete states. A `table` of -1 stands
    for the constant 1: the term is its coefficient.
    """

    component: int
    coefficient: Code
    table: int
    column: int


@final
@dataclass(frozen=True, slots=True)
class ErrorBound:
    """How far the tables are from the field itself, for one driven variable, in its rate's unit.

    `measured` is the largest difference seen on `points` random points that did not choose the
    nodes, with a margin: an estimate, not a proof.
    """

    measured: float
    tolerance: float
    points: int


@final
@dataclass(frozen=True, eq=False, slots=True)
class Field:
    """The vector field: rates (SI per second) of the driven states, in the order of the states.

    driven: the states that it moves; the discrete one that `mode` names is not among them.
    form: formula, arrows, grid, module, step, sketch or modes. For `step` the field gives the
    *next value* of each driven state, `every` seconds later; otherwise `every` is 0.
    tables, terms: the interpolated field; empty where it stays as code.
    formula: the field's own expressions, one per driven state, where the form has them.
    coordinates: what tables stand over beside states and controls.
    mode, guards: the discrete state whose value chooses the field, and how it changes; without
    modes the name is empty.
    """

    driven: tuple[str, ...]
    form: str
    every: float
    tables: tuple[Table, ...]
    terms: tuple[Term, ...]
    bounds: tuple[ErrorBound, ...]
    formula: tuple[Code, ...] | None
    origin: str
    coordinates: tuple[Coordinate, ...] = ()
    mode: str = ""
    guards: tuple[Guard, ...] = ()

    @property
    def is_map(self) -> bool:
        """Whether the field is a discrete-time map."""
        return self.every > 0.0


@final
@dataclass(frozen=True, slots=True)
class Binding:
    """Where a variable stands in a log: `value = scale * raw * unit.scale + offset`.

    The measurement at log time t speaks of time `t - delay`. `path` is empty and `constant` set
    for a variable that was not logged and is declared constant. values: of a discrete variable
    or signal, each text that the log may hold and the index that it stands for. noise: the
    standard deviation of the sensor's noise, None where it is to be estimated.
    """

    name: str
    path: str
    unit: Unit
    delay: float
    scale: float
    offset: float
    constant: float | None
    values: tuple[tuple[str, int], ...]
    origin: str
    noise: float | None = None


@final
@dataclass(frozen=True, slots=True)
class Fidelity:
    """What "the robot does this" means: SI tolerances at the horizon, and where it must be seen.

    scatter: by how much (SI, standard deviation) single runs may depart beside the tolerance.
    """

    tolerance: dict[str, float]
    horizon: float
    region: dict[str, tuple[float, float]]
    coverage: float
    origin: str
    scatter: dict[str, float] = dataclasses.field(default_factory=dict)


@final
@dataclass(frozen=True, slots=True)
class Realization:
    """The channel of a body that a variable acts on, as what, and with which sign (1 or -1).

    variable: a driven state, or an output or control (as set-point).
    """

    variable: str
    channel: str
    mode: str
    origin: str
    sign: float = 1.0


@final
@dataclass(frozen=True, slots=True)
class Feasibility:
    """What is known of whether a real robot can do this (thesis, section 2.3, caveat 3)."""

    level: str
    evidence: str


@final
@dataclass(frozen=True, slots=True)
class Origin:
    """The spec that a program was compiled from."""

    file: str
    text: str
    sha256: str


@final
@dataclass(frozen=True, eq=False, slots=True)
class Program:
    """A compiled behavior.

    bindings: one for each state and control that the log holds or the spec declares constant,
    and for each further signal that `judge_when` reads (the names that are neither state,
    control, constant nor output).
    judge_when: over register entries and signals; non-zero where the behavior had its way.
    claims: what its author, or a sketch, says of the topology of the field, in their order.
    noise: of driven states that are moved at random beside the field.
    """

    name: str
    about: str
    states: tuple[State, ...]
    controls: tuple[Control, ...]
    constants: tuple[Constant, ...]
    outputs: tuple[Output, ...]
    field: Field
    fidelity: Fidelity | None
    bindings: tuple[Binding, ...]
    judge_when: Code | None
    realizes: tuple[Realization, ...]
    feasibility: Feasibility | None
    source: Origin
    claims: tuple[Claim, ...] = ()
    noise: tuple[Noise, ...] = ()

    @property
    def register(self) -> tuple[str, ...]:
        """The names of everything that code may read: states, controls, constants."""
        return (
            *(state.name for state in self.states),
            *(control.name for control in self.controls),
            *(constant.name for constant in self.constants),
        )

    @property
    def driven(self) -> tuple[int, ...]:
        """Indices of the driven states; the one that holds the mode is not among them."""
        return tuple(
            i for i, s in enumerate(self.states) if s.is_driven and s.name != self.field.mode
        )
