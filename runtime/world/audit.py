"""The audit of a run: how deep bodies stood in one another, and robots that were stuck.

A simulated robot that hangs on a thing looks like one that has decided to stand. So whoever is
commanded to move and does not is reported, with what held it; and so is one that the contact
solver holds with more force than its drive has, which no real thing would do.
"""

import math
from collections import deque
from dataclasses import dataclass
from enum import StrEnum
from typing import Final, NamedTuple, final

from runtime.world.chipmunk import finder
from runtime.world.drive import Motor
from runtime.world.space import SLOP, Space, Touch

LOOK: Final = 0.1
"""Seconds between two looks at the robots."""
LOOKS: Final = 10
"""Looks that a judgement needs: it is over a second."""
TRAVEL: Final = 0.03
"""Metres that must be commanded within these looks, before a robot can be stuck."""
TURN: Final = 0.3
"""Radians, likewise."""
SHARE: Final = 0.1
"""The share of what is commanded, below which a robot is stuck."""
ABOVE: Final = 5.0
"""Times the force of its drive, above which a contact is a wedge."""


@final
class Cause(StrEnum):
    """Why a robot is stuck."""

    STALLED = "stalled"  # its wheels slip, or it stands against what does not yield
    WEDGED = "wedged"  # contacts hold it with more force than its drive has


@final
@dataclass(frozen=True, slots=True)
class Jam:
    """A robot was commanded to move, and did not.

    begin, end: seconds. thing: what held it the most: a thing, a robot, `walls`, or empty.
    force: the mean force of its contacts (N).
    """

    robot: str
    thing: str
    cause: Cause
    begin: float
    end: float
    force: float


@final
@dataclass(frozen=True, slots=True)
class Audit:
    """What the audit found up to now.

    depth: metres that the worst contact was deep, between `pair` at `time` (s).
    """

    depth: float
    pair: tuple[str, str]
    time: float
    jams: tuple[Jam, ...]


class _Look(NamedTuple):
    """A robot at one look: what it is commanded, did since the last, and was held with."""

    commanded: tuple[float, float]
    done: tuple[float, float]
    force: float
    thing: int


@final
class Auditor:
    """Watches a space as it moves.

    names: of solids and, last, the walls. motors: of robots, the last solids. step: seconds of a
    scenario's step.

    Attributes:
        depth: the deepest yet (m).
        every: how many steps after one another it is to look.
    """

    def __init__(
        self, space: Space, names: tuple[str, ...], motors: tuple[Motor, ...], step: float
    ) -> None:
        self._space = space
        self._names = names
        self._motors = motors
        self._first = len(names) - 1 - len(motors)
        self.every = max(round(LOOK / step), 1)
        self._seconds = self.every * step
        self.depth, self._pair, self._time = 0.0, ("", ""), 0.0
        self._find = [finder(body) for body in space.bodies[self._first :]]
        self._poses = [find() for find in self._find]
        self._looks: tuple[deque[_Look], ...] = tuple(deque(maxlen=LOOKS) for _ in motors)
        self._open: dict[int, Jam] = {}
        self._jams: list[Jam] = []

    def note(self, depth: float, time: float) -> None:
        """Note that the worst contact is deeper than `depth` was before, at `time`."""
        self.depth, self._time = depth, time
        if depth > SLOP:  # who it is between matters only above what is usual
            worst = max(self._space.touches(), key=lambda touch: touch.depth)
            self._pair = (self._names[worst.a], self._names[worst.b])

    def found(self) -> Audit:
        """What was found up to now; a jam that lasts ends now."""
        jams = sorted((*self._jams, *self._open.values()), key=lambda jam: (jam.begin, jam.robot))
        return Audit(self.depth, self._pair, self._time, tuple(jams))

    def look(self, time: float, part: float) -> None:
        """Look at the robots, every so many steps; the last part of a step took so many seconds."""
        held = _held(self._space.touches(), self._first)
        for robot, motor in enumerate(self._motors):
            before = self._poses[robot]
            x, y, heading = self._poses[robot] = self._find[robot]()
            forward, left, turn = motor.ramps.now
            impulse, thing = held.get(self._first + robot, (0.0, -1))
            self._looks[robot].append(
                _Look(
                    commanded=(math.hypot(forward, left), abs(turn)),
                    done=(math.hypot(x - before[0], y - before[1]), abs(heading - before[2])),
                    force=impulse / part,
                    thing=thing,
                )
            )
            if len(self._looks[robot]) == LOOKS:
                self._judge(robot, time)

    def _judge(self, robot: int, time: float) -> None:
        """Open a jam, let it last, or close it."""
        looks = self._looks[robot]
        cause = _cause(looks, self._motors[robot].grip, self._seconds)
        jam = self._open.pop(robot, None)
        if cause is None:
            if jam is not None:
                self._jams.append(jam)
            return
        force = sum(look.force for look in looks) / len(looks)
        thing = max(looks, key=lambda look: look.force).thing
        begin = jam.begin if jam else time - LOOKS * self._seconds
        self._open[robot] = Jam(
            robot=self._names[self._first + robot],
            thing=self._names[thing] if thing >= 0 else "",
            cause=cause if jam is None or cause is jam.cause else Cause.WEDGED,
            begin=begin,
            end=time,
            force=max(force, jam.force if jam else 0.0),
        )


def _held(touches: list[Touch], first: int) -> dict[int, tuple[float, int]]:
    """For each robot that touches something: the sum of impulses, and who has the largest.

    Robots are the solids from `first`. A pair's impulse stands at each of its points; of the
    points of a pair, the largest counts.
    """
    pairs: dict[tuple[int, int], float] = {}
    for touch in touches:
        for one, other in ((touch.a, touch.b), (touch.b, touch.a)):
            if one >= first:
                pairs[one, other] = max(pairs.get((one, other), 0.0), touch.impulse)
    found: dict[int, tuple[float, int]] = {}
    largest: dict[int, float] = {}
    for (one, other), impulse in pairs.items():
        total, thing = found.get(one, (0.0, -1))
        if impulse > largest.get(one, -1.0):
            largest[one], thing = impulse, other
        found[one] = (total + impulse, thing)
    return found


def _cause(looks: deque[_Look], grip: float, seconds: float) -> Cause | None:
    """Why a robot is stuck by its last looks, which are `seconds` apart; None where it is not."""
    if all(look.force > ABOVE * grip for look in looks):
        return Cause.WEDGED
    wanted = [sum(look.commanded[k] for look in looks) * seconds for k in range(2)]
    asked = [k for k, least in enumerate((TRAVEL, TURN)) if wanted[k] >= least]
    if asked and all(sum(look.done[k] for look in looks) < SHARE * wanted[k] for k in asked):
        return Cause.STALLED
    return None
