"""Nodes at their ticks: a behavior, an arbiter, or a module of the user's own."""

import math
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Final, NamedTuple, Protocol, final

import numpy as np

from runtime.arbiter import Arbiter as CompiledArbiter
from runtime.arbiter import Paradigm
from runtime.arbitration.conditions import Conditions, entries_of
from runtime.arbitration.protocol import Arbiter
from runtime.arrays import Array, frozen
from runtime.scheduler.inputs import Inputs
from runtime.scheduler.kernels.tick import BROKEN, CHATTERS, CLIPPED, OUTSIDE
from runtime.scheduler.observer import What
from runtime.scheduler.ticker import AGAINST, Ticker
from runtime.user_code import Callee, UserCodeError, call

NOTHING = frozen([])
ONE_AT_A_TIME: Final = frozenset({Paradigm.RULES, Paradigm.PLAN})
"""Arbiters that hold one choice at a time by what they are."""
REMARKS = ((OUTSIDE, What.OUTSIDE), (BROKEN, What.BROKEN))
REMARKS_OF_ACTING = ((CHATTERS, What.CHATTERING), (CLIPPED, What.AT_THE_EDGE))


@final
class Said(NamedTuple):
    """What a node says at a tick, for its response time later; the arrays are new ones.

    register: as sampled. outputs: what goes on the board. commands: (c,). acts: whether it is to
    act then, as far as it is its own to say.
    """

    register: Array
    outputs: Array
    commands: Array
    acts: bool
    remarks: tuple[What, ...]


class Ticking(Protocol):
    """A node that samples the board at its ticks."""

    inputs: Inputs

    def tick(self, board: Array, time: float, *, allowed: bool) -> Said:
        """Sample; allowed: whether nothing outside the node keeps it from acting."""
        ...

    def state(self) -> Array:
        """What it keeps from tick to tick, for the hash."""
        ...


@final
class BehaviorNode:
    """A behavior: one compiled call a tick."""

    def __init__(self, ticker: Ticker) -> None:
        self.ticker, self.inputs = ticker, ticker.inputs
        self._outputs = len(ticker.program.outputs)

    def tick(self, board: Array, time: float, *, allowed: bool) -> Said:  # noqa: ARG002  # no clock
        """Sample, say the outputs, look a period ahead."""
        flags = self.ticker.tick(board, allowed=allowed)
        told = self.ticker.told.copy()
        acts = flags & AGAINST == 0
        remarks: tuple[What, ...] = ()
        if flags:
            remarks = tuple(what for flag, what in REMARKS if flags & flag)
            if acts and allowed:
                remarks += tuple(what for flag, what in REMARKS_OF_ACTING if flags & flag)
        outputs, commands = told[: self._outputs], told[self._outputs :]
        return Said(self.ticker.register, outputs, commands, acts, remarks)

    def state(self) -> Array:
        """Its own states."""
        return self.ticker.own


class Learner(NamedTuple):
    """An arbiter that is given from outside, and what it is rewarded with at its ticks.

    In the place of `rules` or of a `plan` only the largest of its numbers counts: these hold one
    choice at a time, and exclusion may be proved by that. What is proved by the conditions of the
    arbiter that it stands for does not hold for it; a run tells conflicts.
    """

    arbiter: Arbiter
    reward: Callable[[], float]


@final
class ArbiterNode:
    """An arbiter: says its outputs, the number of each choice, and which is the largest."""

    def __init__(
        self,
        compiled: CompiledArbiter,
        arbiter: Arbiter,
        inputs: Inputs,
        reward: Callable[[], float] | None,
    ) -> None:
        self.inputs, self._arbiter, self._reward = inputs, arbiter, reward
        self._conditions = Conditions(compiled, [output.code for output in compiled.outputs])
        entries = [inputs.entries.index(name) for name in entries_of(compiled)]
        self._entries = np.array(entries, dtype=np.int64)
        self._in_order = entries == list(range(len(inputs.entries)))
        self._holds_one = reward is not None and compiled.paradigm in ONE_AT_A_TIME
        self._has_decided = False
        self._numbers: Array = np.zeros(len(compiled.choices))

    def tick(self, board: Array, time: float, *, allowed: bool) -> Said:  # noqa: ARG002  # it decides
        """Sample and decide; a choice of -1 where none holds."""
        read, acts = self.inputs.read(board)
        reads = read if self._in_order else read[self._entries]
        if self._reward is not None and self._has_decided:
            self._arbiter.learn(self._reward())
        self._has_decided = True
        self._numbers = self._arbiter.decide(reads, time)
        largest = int(self._numbers.argmax())
        if self._holds_one:
            self._numbers = np.where(np.arange(self._numbers.size) == largest, self._numbers, 0.0)
        choice = float(largest) if self._numbers[largest] > 0.0 else -1.0
        outputs = np.concatenate([self._conditions.at(reads), self._numbers, [choice]])
        return Said(reads, outputs, NOTHING, acts, () if acts else (What.OUTSIDE,))

    def state(self) -> Array:
        """What it decided last."""
        return self._numbers


@final
class ModuleNode:
    """A Python function of the user's: from a mapping that cannot be changed to floats."""

    def __init__(self, text: str, function: Callee, inputs: Inputs, tells: tuple[str, ...]) -> None:
        self.inputs = inputs
        self._text, self._function, self._tells = text, function, tells

    def tick(self, board: Array, time: float, *, allowed: bool) -> Said:  # noqa: ARG002  # it tells
        """Call the function.

        Raises:
            UserCodeError: it raised, or did not give a number for each thing that it tells.
        """
        read, _ = self.inputs.read(board)
        frozen_reads = MappingProxyType(dict(zip(self.inputs.entries, read.tolist(), strict=True)))
        answer = call(self._text, self._function, frozen_reads, time)
        if not isinstance(answer, Mapping) or set(answer) != set(self._tells):
            raise UserCodeError(
                f"{self._text} must return a dict with {', '.join(self._tells)} "
                f"(got {answer!r:.60})"
            )
        outputs = np.array([self._number(answer[name]) for name in self._tells])
        return Said(read, outputs, NOTHING, acts=True, remarks=())

    def state(self) -> Array:
        """Nothing that anybody here could know of."""
        return NOTHING

    def _number(self, value: object) -> float:
        if isinstance(value, int | float) and math.isfinite(value):
            return float(value)
        raise UserCodeError(f"{self._text} gave {value!r:.60}, which is no finite number")
