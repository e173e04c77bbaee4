"""The audit of a run: how deep bodies stood in one another, and robots that were stuck.

A simulated robot that hangs on a thing looks like one that has decided to stand. So whoever is
commanded to move and does not is reported, with what held it; and so is one that the contact
solver holds with more force than its drive has, which no real thing would do.
"""

from collections import deque
from dataclasses import dataclass
from enum import StrEnum
from typing import Final, NamedTuple, final

import numpy as np

from runtime.arrays import Array
from runtime.world.drive import Motor
from runtime.world.space import SLOP, Space

LOOK: Final = 0.05
"""Seconds between two looks at the robots."""
LOOKS: Final = 20
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
    """A robot at one look: what it was commanded since the last, did, and was held with."""

    commanded: tuple[float, float]
    done: tuple[float, float]
    force: float
    thing: int


@final
class Auditor:
    """Watches a space as it moves.

    names: of solids and, last, the walls. motors: of robots, the last solids. step: seconds of a
    scenario's step.
    """

    def __init__(
        self, space: Space, names: tuple[str, ...], motors: tuple[Motor, ...], step: float
    ) -> None:
        self._space = space
        self._names = names
        self._motors = motors
        self._first = len(names) - 1 - len(motors)
        self._every = max(round(LOOK / step), 1)
        self._seconds = self._every * step
        self._depth, self._pair, self._time = 0.0, ("", ""), 0.0
        self._poses = space.states()[self._first :, :3]
        self._looks: tuple[deque[_Look], ...] = tuple(deque(maxlen=LOOKS) for _ in motors)
        self._open: dict[int, Jam] = {}
        self._jams: list[Jam] = []

    def note(self, depth: float, time: float) -> None:
        """Note how deep the worst contact is at `time`."""
        if depth <= self._depth:
            return
        self._depth, self._time = depth, time
        if depth > SLOP:  # who it is between matters only above what is usual
            touches = self._space.touches()
            worst = int(touches.depth.argmax())
            self._pair = (
                self._names[int(touches.a[worst])],
                self._names[int(touches.b[worst])],
            )

    def look(self, steps: int, time: float, seconds: float) -> None:
        """Look at the robots after so many steps, the last part of which took `seconds`."""
        if steps % self._every == 0:
            self._look(time, seconds)

    def found(self) -> Audit:
        """What was found up to now; a jam that lasts ends now."""
        jams = sorted((*self._jams, *self._open.values()), key=lambda jam: (jam.begin, jam.robot))
        return Audit(self._depth, self._pair, self._time, tuple(jams))

    def _look(self, time: float, step: float) -> None:
        touches = self._space.touches()
        poses = self._space.states()[self._first :, :3]
        travelled = np.hypot(*(poses - self._poses)[:, :2].T)
        turned = np.abs(poses[:, 2] - self._poses[:, 2])
        self._poses = poses
        for robot, motor in enumerate(self._motors):
            solid = self._first + robot
            ours = (touches.a == solid) | (touches.b == solid)
            others = touches.a[ours] + touches.b[ours] - solid
            held, thing = _strongest(others, touches.impulse[ours])
            forward, left, turn = motor.ramps.now
            commanded = (np.hypot(forward, left) * self._seconds, abs(turn) * self._seconds)
            done = (float(travelled[robot]), float(turned[robot]))
            self._looks[robot].append(_Look(commanded, done, held / step, thing))
            self._judge(robot, time)

    def _judge(self, robot: int, time: float) -> None:
        """Open a jam, let it last, or close it."""
        looks = self._looks[robot]
        cause = _cause(looks, self._motors[robot].grip)
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


def _strongest(others: Array, impulses: Array) -> tuple[float, int]:
    """The impulses of all contacts together, and who has the largest; -1 for nobody."""
    if not len(others):
        return 0.0, -1
    # A pair's impulse stands at each of its points; it counts once.
    by_thing: dict[int, float] = {}
    for other, impulse in zip(others.tolist(), impulses.tolist(), strict=True):
        by_thing[int(other)] = max(by_thing.get(int(other), 0.0), impulse)
    return sum(by_thing.values()), max(by_thing, key=lambda thing: (by_thing[thing], -thing))


def _cause(looks: deque[_Look], grip: float) -> Cause | None:
    """Why a robot is stuck by its last looks; None where it is not."""
    if len(looks) < LOOKS:
        return None
    if min(look.force for look in looks) > ABOVE * grip:
        return Cause.WEDGED
    wanted = [sum(look.commanded[k] for look in looks) for k in range(2)]
    done = [sum(look.done[k] for look in looks) for k in range(2)]
    asked = [k for k, least in enumerate((TRAVEL, TURN)) if wanted[k] >= least]
    if asked and all(done[k] < SHARE * wanted[k] for k in asked):
        return Cause.STALLED
    return None
