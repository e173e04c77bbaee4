"""The simulated world: what the scheduler commands and lets advance, and what senses see.

Physics resolves what behaviors want against what the world allows: bodies do not overlap, a pushed
box moves by friction, and a wheel that is asked for too much slips. The same scenario and seed give
the same bits in every process, whatever else the machine does.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from hashlib import blake2b
from typing import Final, NamedTuple, Protocol, final

import numpy as np

from runtime.arrays import Array, Booleans
from runtime.direct_calls import machine_code
from runtime.world.audit import Audit, Auditor
from runtime.world.chipmunk import finder
from runtime.world.drive import CHANNELS, Motion, Motor, drive_of, local_velocity
from runtime.world.floor import FEET, Feet, feet_of, stand
from runtime.world.footprint import spread
from runtime.world.geometry import Geometry, Outline, Plan
from runtime.world.heights import bands
from runtime.world.kernels import nearness
from runtime.world.layout import Layout, lay_out
from runtime.world.model import Body, Light, Pose, Shape, Thing, World
from runtime.world.space import SLOP, Solid, Space, Touch

LONGEST: Final = 1.0 / 200.0
"""Seconds of the longest step of the physics."""
FURTHEST: Final = 2.0e-3
"""Metres that things may come nearer to one another in it: so deep they stand in one another where
they meet. The outlines touch SLOP before."""
FINEST: Final = 8
"""Parts of a step at most: nothing in these worlds is as fast as that."""
SETTLED: Final = 0.25
"""Seconds after the last contact in which what was hit may still move."""


@final
@dataclass(frozen=True, slots=True)
class Inhabitant:
    """A robot as the world takes it.

    start: None for anywhere that is free. channels: what is commanded, in the order of commands.
    """

    name: str
    body: Body
    start: Pose | None
    channels: tuple[str, ...]


@final
class Contact(NamedTuple):
    """A point at which a robot touches another owner.

    x, y: in the world. bearing: seen from the origin of the body, 0 ahead, in (-pi, pi].
    """

    owner: int
    x: float
    y: float
    bearing: float


class Senses(Protocol):
    """What samples the sensors of robots."""

    def sample(self, robot: int, sensor: int) -> Array:
        """The readings of one sensor at this instant, as they are."""
        ...

    def advance(self, seconds: float) -> None:
        """Remember what wheels turned in a step that has just passed."""
        ...

    def state(self) -> Array:
        """All that they remember."""
        ...


@final
class SimulatedWorld:
    """A world with robots in it; it is an `Environment` of the scheduler.

    Owners are numbered as in `Geometry`: things, robots, walls.

    Attributes:
        model, inhabitants, step, seed: what it was made of.
        layout: where all stood at the beginning.
        lights: of the world.
    """

    def __init__(
        self,
        model: World,
        inhabitants: Sequence[Inhabitant],
        step: float,
        seed: int,
        *,
        feet: tuple[int, int] = FEET,
        senses: "Callable[[SimulatedWorld], Senses] | None" = None,
    ) -> None:
        """Lay the world out. feet: that a thing stands on, along and across.

        Raises:
            NoRoomError: there is no room for what is placed at random.
            ValueError: the physics cannot tell so many heights apart.
        """
        self.model = model
        self.inhabitants = tuple(inhabitants)
        self.step = step
        self.seed = seed
        self.lights: tuple[Light, ...] = model.lights
        robots = [(robot.name, robot.body, robot.start) for robot in self.inhabitants]
        self.layout: Layout = lay_out(model, robots, seed)
        arena = np.array(model.arena, dtype=np.float64)
        self._space, self._motors = _built(self.layout, self.inhabitants, model, arena, feet)
        self._plan = Plan(*_outlines(self.layout, self.inhabitants), arena)
        self._gap_of = _gaps(self._plan)
        self._gaps = tuple(machine_code(nearness.gap, given) for given in self._gap_of)
        names = self._plan.geometry.names
        self._auditor = Auditor(self._space, names, self._motors, step)
        self._fewest = max(math.ceil(step / LONGEST - 1e-9), 1)
        self._tips = tuple(
            (motor.ramps, _arm(robot.body))
            for motor, robot in zip(self._motors, self.inhabitants, strict=True)
        )
        self._find = tuple(finder(body) for body in self._space.bodies)
        self._restless = 0.0
        self._ways = tuple(_ways(robot) for robot in self.inhabitants)
        self._steps = 0
        self._states = self._space.states()
        self._states_at = self._placed_at = 0
        self._touches: list[Touch] | None = None
        self._senses = senses(self) if senses else None

    @property
    def steps(self) -> int:
        """How many steps were taken."""
        return self._steps

    @property
    def time(self) -> float:
        """Seconds since the beginning."""
        return self._steps * self.step

    def sample(self, robot: int, sensor: int) -> Array:
        """The readings of one sensor at this instant, as they are: without noise."""
        assert self._senses is not None, "a world that is sampled has senses"
        return self._senses.sample(robot, sensor)

    def command(self, robot: int, channels: Array, driven: Booleans) -> None:
        """Set what a robot's drive is to do from now on; what is not driven rolls freely."""
        self._motors[robot].set(
            [
                0.0 if way < 0 else float(channels[way]) if driven[way] else None
                for way in self._ways[robot]
            ]
        )

    def advance(self) -> None:
        """Let one step pass."""
        parts = self._parts()
        seconds = self.step / parts
        for part in range(parts):
            for motor in self._motors:
                motor.steer(seconds)
            depth = self._space.step(seconds)
            if self._senses is not None:
                self._senses.advance(seconds)
            self._restless = SETTLED if depth > -math.inf else self._restless - seconds
            if depth > self._auditor.depth:
                self._auditor.note(depth, self.time + (part + 1) * seconds)
        self._steps += 1
        self._touches = None
        if self._steps % self._auditor.every == 0:
            self._auditor.look(self.time, seconds)

    def state_hash(self) -> bytes:
        """A digest of where all are and how they move, and of what the motors hold.

        What contacts remember is not in it; it shows in the next step.
        """
        digest = blake2b(self._now().tobytes(), digest_size=16)
        held = [value for motor in self._motors for value in motor.ramps.now]
        digest.update(np.array([self._steps, *held]).tobytes())
        if self._senses is not None:
            digest.update(self._senses.state().tobytes())
        return digest.digest()

    def poses(self) -> Array:
        """Of things and robots (n, 3): x, y, heading, which is not wrapped."""
        return self._now()[:, :3].copy()

    def pose(self, owner: int) -> tuple[float, float, float]:
        """Of a thing or a robot: x, y, heading, which is not wrapped."""
        return self._find[owner]()

    def motion(self, robot: int) -> Motion:
        """How a robot moves."""
        solid = self._space.bodies[len(self.layout.things) + robot]
        x, y = solid.center_of_gravity
        return local_velocity(solid, (x, y))

    def commanded(self, robot: int) -> Motion:
        """How a robot's motors want it to move: wheels turn so, whether they slip or not."""
        return self._motors[robot].ramps.now

    def geometry(self) -> Geometry:
        """What stands where now; the same object each time, brought up to date."""
        if self._placed_at != self._steps:
            self._plan.place(self._now(), self._steps)
            self._placed_at = self._steps
        return self._plan.geometry

    def touching(self, robot: int) -> tuple[Contact, ...]:
        """Where a robot touches something now, in a fixed order."""
        if self._touches is None:
            self._touches = self._space.touches()
        owner = len(self.layout.things) + robot
        ours = [touch for touch in self._touches if owner in (touch.a, touch.b)]
        if not ours:
            return ()
        x, y, heading = self.pose(owner)
        found = []
        for touch in ours:
            bearing = math.remainder(math.atan2(touch.y - y, touch.x - x) - heading, math.tau)
            found.append(Contact(touch.a + touch.b - owner, touch.x, touch.y, bearing))
        return tuple(found)

    def clearance(self, robot: int) -> float:
        """How far a robot is from the nearest other thing or wall at any of its heights (m)."""
        self.geometry()
        return self._gaps[robot](*self._gap_of[robot])

    def audit(self) -> Audit:
        """How deep bodies stood in one another, and which robots were stuck, up to now."""
        return self._auditor.found()

    def _parts(self) -> int:
        """Into how many parts of the physics the coming step is cut: by what may meet in it.

        Robots are as fast as their motors; what they hit may be faster for a while.
        """
        closing = self._space.fastest() if self._restless > 0.0 else 0.0
        first = second = 0.0
        for ramps, arm in self._tips:
            forward, left, turn = ramps.now
            speed = math.hypot(forward, left) + abs(turn) * arm
            if speed > first:
                first, second = speed, first
            elif speed > second:
                second = speed
        fine = math.ceil(self.step * max(closing, first + second) / (FURTHEST + SLOP))
        return max(self._fewest, min(fine, FINEST))

    def _now(self) -> Array:
        """The states of all solids after the last step."""
        if self._states_at != self._steps:
            self._states = self._space.states()
            self._states_at = self._steps
        return self._states


def _built(
    layout: Layout,
    inhabitants: tuple[Inhabitant, ...],
    model: World,
    arena: Array,
    feet: tuple[int, int],
) -> tuple[Space, tuple[Motor, ...]]:
    """The space with all solids, things on their feet and robots on their drives."""
    parts: list[Thing | Body] = [*layout.things, *(robot.body for robot in inhabitants)]
    masks = bands([(part.low, part.high) for part in parts])
    spreads = [spread(part.shape) for part in parts]
    poses = (*(thing.pose for thing in layout.things), *layout.starts)
    solids = tuple(
        Solid(
            shape=part.shape,
            pose=pose,
            spread=lies,
            mass=None if isinstance(part, Thing) and part.is_fixed else part.mass,
            friction=part.friction,
            band=mask,
        )
        for part, pose, lies, mask in zip(parts, poses, spreads, masks, strict=True)
    )
    space = Space(solids, arena, model.wall_friction)
    known: dict[Shape, Feet] = {}
    things = len(layout.things)
    for thing, body, lies in zip(layout.things, space.bodies, spreads, strict=False):
        if not thing.is_fixed:
            if thing.shape not in known:
                known[thing.shape] = feet_of(thing.shape, lies, feet)
            stand(space.space, body, known[thing.shape], thing.floor)
    motors = tuple(
        drive_of(space.space, solid, robot.body, lies)
        for solid, robot, lies in zip(
            space.bodies[things:], inhabitants, spreads[things:], strict=True
        )
    )
    return space, motors


def _arm(body: Body) -> float:
    """How far a point of a robot's outline is from its origin, where it turns with the body."""
    corners = [math.hypot(*corner) for part in body.shape.polygons for corner in part.vertices]
    return max((*corners, *(math.hypot(disc.x, disc.y) for disc in body.shape.discs)))


def _outlines(
    layout: Layout, inhabitants: tuple[Inhabitant, ...]
) -> tuple[tuple[Outline, ...], tuple[Outline, ...]]:
    """What senses see of things and robots; robots are opaque."""
    things = tuple(
        Outline(t.name, t.shape, t.pose, t.low, t.high, t.transmittance) for t in layout.things
    )
    robots = tuple(
        Outline(r.name, r.body.shape, pose, r.body.low, r.body.high, 0.0)
        for r, pose in zip(inhabitants, layout.starts, strict=True)
    )
    return things, robots


def _gaps(plan: Plan) -> tuple[tuple[Array, Array, Array, Array, Booleans, float], ...]:
    """For each robot what tells how far it is from others that stand at one of its heights."""
    geometry, found = plan.geometry, []
    for robot in range(geometry.robots):
        ours = geometry.owner == geometry.things + robot
        low, high = geometry.low[ours].min(), geometry.high[ours].max()
        near = ~ours & (geometry.low < high) & (geometry.high > low)
        edges, circles = plan.outline(geometry.things + robot)
        found.append((edges, circles, geometry.segments, geometry.discs, near, math.inf))
    return tuple(found)


def _ways(robot: Inhabitant) -> tuple[int, ...]:
    """For each channel of the drive its place among the commands; -1 for one that stands still."""
    names = robot.channels
    return tuple(
        names.index(name) if name in names else -1 for name in CHANNELS[robot.body.drive.kind]
    )
