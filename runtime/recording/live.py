"""Named quantities of a run while it goes on, by the names that a finished run has."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import Final, TypeAlias, final

import numpy as np

from runtime.architecture import Architecture
from runtime.arrays import Array
from runtime.program import Kind, Unit
from runtime.recording.quantities import METRES, RADIANS, measured, of_board, of_state
from runtime.recording.tracks import Quantity
from runtime.scenario import Scenario
from runtime.scheduler.observer import Silent, Tick
from runtime.start import Started

Read: TypeAlias = tuple[Quantity, Callable[[], float]]
"""What a quantity is, without samples, and its value now."""
NONE: Final = np.zeros(0)
OF_POSE: Final = {"x": METRES, "y": METRES, "heading": RADIANS}


class LastTicks(Silent):
    """An observer that keeps what each node sampled last."""

    def __init__(self) -> None:
        self._registers: dict[tuple[int, int], Array] = {}

    def ticked(self, instant: int, tick: Tick) -> None:  # noqa: ARG002
        """Keep it."""
        self._registers[tick.robot, tick.node] = tick.register

    def last(self, robot: int, node: int, entry: int) -> float:
        """One entry of what a node sampled last."""
        return float(self._registers[robot, node][entry])


@final
class Live:
    """Reads some quantities of a run at the instant where it is.

    Args:
        names: which, in this order.
        scenario: what runs.
        begun: the run; `ticks` is its observer.
        ticks: where states of nodes are found.

    Raises:
        KeyError: the run has no quantity of that name.
    """

    def __init__(
        self, names: Sequence[str], scenario: Scenario, begun: Started, ticks: LastTicks
    ) -> None:
        self._begun, self._ticks, self._scenario = begun, ticks, scenario
        self._robots = [robot.name for robot in scenario.robots]
        self._owners = [*(thing.name for thing in begun.world.layout.things), *self._robots]
        self._reads = [self._read(name) for name in names]

    @property
    def count(self) -> int:
        """How many it reads."""
        return len(self._reads)

    def now(self) -> list[float]:
        """Their values, in SI."""
        return [read() for _, read in self._reads]

    def sampled(self, times: Array, values: Array) -> dict[str, Quantity]:
        """Them as quantities, with the values (T, q) that they had at times (T,)."""
        columns = zip(self._reads, values.T, strict=True)
        return {what.name: replace(what, times=times, values=own) for (what, _), own in columns}

    def _read(self, name: str) -> Read:
        owner, _, what = name.partition(".")
        if owner in self._owners and what in OF_POSE:
            place, column = self._owners.index(owner), [*OF_POSE].index(what)
            kind = Kind.PERIODIC if what == "heading" else Kind.CONTINUOUS
            about = measured(name, OF_POSE[what], NONE, NONE, kind)
            return about, lambda: self._begun.world.pose(place)[column]
        if owner not in self._robots:
            raise KeyError(name)
        found = self._of_robot(name, self._robots.index(owner), what)
        return found or self._of_nodes(name, self._robots.index(owner), what)

    def _of_robot(self, name: str, robot: int, what: str) -> Read | None:
        world, senses = self._begun.world, self._begun.senses
        of: dict[str, tuple[str, Callable[[], float]]] = {
            "clearance": ("m", lambda: world.clearance(robot)),
            "contacts": ("1", lambda: len({touch.owner for touch in world.touching(robot)})),
            "light": ("lx", lambda: senses.light(robot)),
            "speed": ("m/s", lambda: world.motion(robot).forward),
            "turn": ("rad/s", lambda: world.motion(robot).turn),
        }
        if what not in of:
            return None
        unit, read = of[what]
        kind = Kind.DISCRETE if what == "contacts" else Kind.CONTINUOUS
        return measured(name, Unit(unit, 1.0), NONE, NONE, kind), read

    def _of_nodes(self, name: str, robot: int, what: str) -> Read:
        """A signal of the board, or a state of a node as it was sampled last."""
        architecture: Architecture = self._scenario.robots[robot].architecture
        board = self._begun.scheduler.agents[robot].board.values
        for place, signal in enumerate(architecture.board):
            if signal.name == what:
                about = of_board(self._robots[robot], signal, NONE, NONE)
                return about, partial(_entry, board, place)
        owner, _, wanted = what.partition(".")
        for node, each in enumerate(architecture.nodes):
            states = architecture.programs[each.behavior].states if each.behavior >= 0 else ()
            for column, state in enumerate(states):
                if (each.name, state.name) == (owner, wanted):
                    about = of_state(name, state, NONE, NONE)
                    return about, partial(self._ticks.last, robot, node, column)
        raise KeyError(name)


def _entry(values: Array, place: int) -> float:
    return float(values[place])
