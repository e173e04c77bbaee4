"""Drives: wheels and feet that push as hard as they grip, and no harder.

A robot is a body like any other. What moves it are *ghosts*: bodies without mass or shape that
move as the ground below a wheel would seem to, each joined to its wheel with a force that is
limited by traction. So wheels slip, a robot that pushes a wall stalls, and nothing is ever pushed
through anything; a robot that were moved directly would have endless force.
"""

import math
from collections.abc import Sequence
from typing import Final, NamedTuple, final

import pymunk

from runtime.world.chipmunk import aimer, compass
from runtime.world.floor import GRAVITY
from runtime.world.footprint import Spread
from runtime.world.model import Body, Drive, DriveKind

ROLLING: Final = 0.02
"""The share of traction that is left where nothing drives a body: wheels that roll freely."""
CHANNELS: Final = {
    DriveKind.DIFFERENTIAL: ("base.speed", "base.turn"),
    DriveKind.HOLONOMIC: ("base.forward", "base.left", "base.turn"),
}
"""What can be commanded."""


@final
class Motion(NamedTuple):
    """How a body moves: the velocity of its origin in its own frame (m/s), and its turn (rad/s)."""

    forward: float
    left: float
    turn: float


STILL: Final = Motion(0.0, 0.0, 0.0)


def drive_of(space: pymunk.Space, solid: pymunk.Body, body: Body, spread: Spread) -> "Motor":
    """The drive of a robot's body, with its ghosts in the space."""
    if body.drive.kind is DriveKind.DIFFERENTIAL:
        return Differential(space, solid, body.drive)
    return Holonomic(space, solid, body.drive, spread)


@final
class Ramps:
    """Set-points that change no faster than a drive can.

    Attributes:
        now: what the motors hold.
        is_free: whether nothing drives the body at all.
    """

    def __init__(self, drive: Drive) -> None:
        self.now = self._goal = STILL
        self._driven = (True, True, True)
        self._all_driven, self.is_free = True, False
        self._drive = drive

    def set(self, goal: Sequence[float | None]) -> None:
        """Head for `goal`: forward, left, turn; None for what rolls freely."""
        forward, left, turn = goal
        self._driven = (forward is not None, left is not None, turn is not None)
        self._all_driven, self.is_free = all(self._driven), not any(self._driven)
        self._goal = Motion(forward or 0.0, left or 0.0, turn or 0.0)

    def advance(self, solid: pymunk.Body, centre: tuple[float, float], seconds: float) -> None:
        """Let the motors come nearer to the goal; what rolls freely is as fast as the body is."""
        if self._all_driven and self.now == self._goal:
            return
        measured = self.now if self._all_driven else local_velocity(solid, centre)
        forward, left, turn = (
            goal if driven else is_now
            for goal, driven, is_now in zip(self._goal, self._driven, measured, strict=True)
        )
        was = [
            now if driven else is_now
            for now, driven, is_now in zip(self.now, self._driven, measured, strict=True)
        ]
        most = self._drive.acceleration * seconds
        change = math.hypot(forward - was[0], left - was[1])
        if change > most:
            forward = was[0] + (forward - was[0]) * most / change
            left = was[1] + (left - was[1]) * most / change
        most = self._drive.spin * seconds
        turn = min(max(turn, was[2] - most), was[2] + most)
        self.now = Motion(forward, left, turn)


@final
class Differential:
    """Two wheels beside the origin of the body, its axle; each grips with half of its weight.

    Attributes:
        ramps: what the motors hold.
        grip: the largest force of both wheels together (N).
    """

    def __init__(self, space: pymunk.Space, solid: pymunk.Body, drive: Drive) -> None:
        self.ramps = Ramps(drive)
        self.grip = drive.traction * solid.mass * GRAVITY
        self._solid = solid
        self._half = drive.track / 2.0
        x, y = solid.center_of_gravity
        self._centre = (x, y)
        right, left = (
            _ghost(space, solid, (0.0, side), self.grip / 2.0) for side in (-self._half, self._half)
        )
        self._joints = (right[1], left[1])
        self._right, self._left = aimer(right[0]), aimer(left[0])
        self._heading_in = compass(solid)
        self._grips = True
        self._stands = False

    def set(self, goal: Sequence[float | None]) -> None:
        """Head for speed (m/s) and turn (rad/s); None for what rolls freely."""
        speed, turn = goal
        self.ramps.set((speed, 0.0 if speed is not None or turn is not None else None, turn))

    def steer(self, seconds: float) -> None:
        """Give the wheels their velocities for the coming step."""
        self.ramps.advance(self._solid, self._centre, seconds)
        if self._grips is self.ramps.is_free:
            self._grips = not self._grips
            for joint in self._joints:
                joint.max_force = self.grip / 2.0 * (1.0 if self._grips else ROLLING)
        speed, _, turn = self.ramps.now
        if speed == 0.0 == turn:
            if not self._stands:
                self._right(0.0, 0.0)
                self._left(0.0, 0.0)
            self._stands = True
            return
        self._stands = False
        heading = self._heading_in(seconds)  # at which the step finds velocities: it moves first
        cosine, sine = math.cos(heading), math.sin(heading)
        # Along the middle of the arc, so that turning while driving leaves no error of first order;
        # what differs between the wheels is a turn of the rigid axle as it is then.
        ahead = heading + 0.5 * turn * seconds
        x, y = speed * math.cos(ahead), speed * math.sin(ahead)
        apart = turn * self._half
        self._right(x + apart * cosine, y + apart * sine)
        self._left(x - apart * cosine, y - apart * sine)


@final
class Holonomic:
    """Feet or wheels that drive in any direction: one grip at the centre of mass.

    Attributes:
        ramps: what the motors hold.
        grip: the largest force of the drive (N).
    """

    def __init__(
        self, space: pymunk.Space, solid: pymunk.Body, drive: Drive, spread: Spread
    ) -> None:
        self.ramps = Ramps(drive)
        self.grip = drive.traction * solid.mass * GRAVITY
        self._solid = solid
        self._centre = (spread.x, spread.y)
        self._ghost, self._joint = _ghost(space, solid, self._centre, self.grip)
        self._aim, self._heading_in = aimer(self._ghost), compass(solid)
        self._gear = pymunk.GearJoint(self._ghost, solid, 0.0, 1.0)
        self._gear.max_bias = 0.0
        self._torque = self.grip * spread.arm
        self._gear.max_force = self._torque
        space.add(self._gear)
        self._grips = True

    def set(self, goal: Sequence[float | None]) -> None:
        """Head for forward, left (m/s) and turn (rad/s); None for what rolls freely."""
        self.ramps.set(goal)

    def steer(self, seconds: float) -> None:
        """Give the ghost its velocity for the coming step."""
        self.ramps.advance(self._solid, self._centre, seconds)
        if self._grips is self.ramps.is_free:
            self._grips = not self._grips
            share = 1.0 if self._grips else ROLLING
            self._joint.max_force = self.grip * share
            self._gear.max_force = self._torque * share
        forward, left, turn = self.ramps.now
        # The channels say how the origin of the body moves; the ghost holds its centre of mass.
        forward, left = forward - turn * self._centre[1], left + turn * self._centre[0]
        ahead = self._heading_in(seconds) + 0.5 * turn * seconds
        cosine, sine = math.cos(ahead), math.sin(ahead)
        self._aim(forward * cosine - left * sine, forward * sine + left * cosine)
        self._ghost.angular_velocity = turn


Motor = Differential | Holonomic


def local_velocity(solid: pymunk.Body, centre: tuple[float, float]) -> Motion:
    """How a body moves whose centre of mass is there, seen from its origin."""
    heading, turn = solid.angle, solid.angular_velocity
    u, v = solid.velocity
    cosine, sine = math.cos(heading), math.sin(heading)
    forward = cosine * u + sine * v + turn * centre[1]
    left = cosine * v - sine * u - turn * centre[0]
    return Motion(forward, left, turn)


def _ghost(
    space: pymunk.Space, solid: pymunk.Body, place: tuple[float, float], force: float
) -> tuple[pymunk.Body, pymunk.PivotJoint]:
    """A ghost that holds the point `place` of a body with at most `force` (N)."""
    ghost = pymunk.Body(body_type=pymunk.Body.KINEMATIC)
    joint = pymunk.PivotJoint(ghost, solid, (0.0, 0.0), place)
    joint.max_bias = 0.0
    joint.max_force = force
    space.add(ghost, joint)
    return ghost, joint
