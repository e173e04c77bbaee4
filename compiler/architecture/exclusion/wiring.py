"""What of an architecture the question of exclusion is asked of."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, final

from runtime.arbiter import Arbiter, Paradigm
from runtime.architecture import Node, Signal
from runtime.program import Program
from runtime.world.model import Sensor

WHAT: Final = {
    Paradigm.COMPETITION: "a competition of activations that are never quite 0",
    Paradigm.MODULE: "a Python function",
}


@final
@dataclass(frozen=True, eq=False, slots=True)
class Wiring:
    """What of an architecture the question depends on: all but its channels."""

    nodes: Sequence[Node]
    board: Sequence[Signal]
    programs: Sequence[Program]
    arbiters: Sequence[Arbiter]
    sensors: Sequence[Sensor]
