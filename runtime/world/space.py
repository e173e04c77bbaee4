"""The space of the physics: bodies, shapes and walls from the model, and what can be read of them.

Everything of pymunk's that has no promise to stay (its batches) is used here and nowhere else.
"""

import math
from dataclasses import dataclass
from typing import Final, final

import numpy as np
import pymunk
from pymunk import batch

from runtime.arrays import Array, Integers
from runtime.world.footprint import Spread
from runtime.world.model import Pose, Shape

ITERATIONS: Final = 20
SLOP: Final = 2e-4
"""How deep shapes stand in one another where they touch (m), so that contacts last."""
SKIN: Final = SLOP / 2.0
"""By so much (m) a shape is larger than its outline: outlines that touch just touch."""
BIAS: Final = 0.8**240
"""The share of a deeper one that is left after a second: a fifth goes in each 1/240 s."""
IDLE_SPEED: Final = 0.002
SLEEP_AFTER: Final = 0.25
PERSISTENCE: Final = 1
"""Steps that a contact is remembered: what is remembered is what touches now."""

BODY: Final = (
    batch.BodyFields.BODY_ID
    | batch.BodyFields.POSITION
    | batch.BodyFields.ANGLE
    | batch.BodyFields.VELOCITY
    | batch.BodyFields.ANGULAR_VELOCITY
)
SPEEDS: Final = batch.BodyFields.VELOCITY | batch.BodyFields.ANGULAR_VELOCITY
DEPTHS: Final = batch.ArbiterFields.DISTANCE_1 | batch.ArbiterFields.DISTANCE_2
CONTACT: Final = (
    batch.ArbiterFields.BODY_A_ID
    | batch.ArbiterFields.BODY_B_ID
    | batch.ArbiterFields.CONTACT_COUNT
    | batch.ArbiterFields.TOTAL_IMPULSE
    | batch.ArbiterFields.POINT_A_1
    | batch.ArbiterFields.DISTANCE_1
    | batch.ArbiterFields.POINT_A_2
    | batch.ArbiterFields.DISTANCE_2
)


@final
@dataclass(frozen=True, slots=True)
class Solid:
    """A body as the physics takes it. mass: kg; None for one that is fixed. band: see heights."""

    shape: Shape
    pose: Pose
    spread: Spread
    mass: float | None
    friction: float
    band: int


@final
@dataclass(frozen=True, eq=False, slots=True)
class Touches:
    """Pairs of solids that touch now, a < b each, in a fixed order; the walls come last.

    a, b: (k,) numbers of solids. points: (k, 2) where, in the world. impulse: (k,) of the last
    step, of all points of the pair's parts together (N s). depth: (k,) metres that outlines stand
    in one another; negative where they only just touch.
    """

    a: Integers
    b: Integers
    points: Array
    impulse: Array
    depth: Array


NOTHING: Final = Touches(
    np.zeros(0, dtype=np.int64),
    np.zeros(0, dtype=np.int64),
    np.zeros((0, 2)),
    np.zeros(0),
    np.zeros(0),
)


@final
class Space:
    """Solids within walls. Numbers of solids are their places; the walls have the next one.

    Attributes:
        space: pymunk's own, for the joints of floor and drives.
        bodies: pymunk's, one for each solid.
    """

    def __init__(self, solids: tuple[Solid, ...], arena: Array, wall_friction: float) -> None:
        self.space = pymunk.Space()
        self.space.iterations = ITERATIONS
        self.space.collision_slop = SLOP
        self.space.collision_bias = BIAS
        self.space.collision_persistence = PERSISTENCE
        self.space.sleep_time_threshold = SLEEP_AFTER
        self.space.idle_speed_threshold = IDLE_SPEED
        self.bodies = tuple(_added(self.space, solid) for solid in solids)
        _enclose(self.space, arena, wall_friction)
        self._numbers = {body.id: number for number, body in enumerate(self.bodies)}
        self._numbers[self.space.static_body.id] = len(self.bodies)
        self._buffer = batch.Buffer()
        self._arm = max((_arm(solid) for solid in solids if solid.mass is not None), default=0.0)
        self._order = b""
        self._rows = np.zeros(0, dtype=np.int64)
        self._kept = np.zeros(0, dtype=np.int64)

    def states(self) -> Array:
        """Of all solids (n, 6): x, y, heading; velocity of the centre of mass x, y; turn rate."""
        self._buffer.clear()
        batch.get_space_bodies(self.space, BODY, self._buffer)
        order = bytes(self._buffer.int_buf())
        if order != self._order:
            self._sort(order)
        found = np.frombuffer(self._buffer.float_buf(), dtype=np.float64).reshape(-1, 6)
        states = np.empty((len(self.bodies), 6))
        states[self._rows] = found[self._kept]
        return states

    def deepest(self) -> float:
        """How deep outlines stand in one another now, at the worst (m); -inf where none touch."""
        self._buffer.clear()
        batch.get_space_arbiters(self.space, DEPTHS, self._buffer)
        depths = memoryview(self._buffer.float_buf()).cast("d")
        # A pair that touches at one point has 0 for the other, which is less deep than the skin.
        least = float(min(depths, default=math.inf))
        return -least - SLOP

    def fastest(self) -> float:
        """A speed that no point of a body exceeds now (m/s)."""
        self._buffer.clear()
        batch.get_space_bodies(self.space, SPEEDS, self._buffer)
        found = np.frombuffer(self._buffer.float_buf(), dtype=np.float64).reshape(-1, 3)
        x, y, turn = np.abs(found).max(axis=0).tolist()
        speed: float = math.hypot(x, y) + turn * self._arm
        return speed

    def touches(self) -> Touches:
        """What touches now."""
        self._buffer.clear()
        batch.get_space_arbiters(self.space, CONTACT, self._buffer)
        whole = np.frombuffer(self._buffer.int_buf(), dtype=np.uintp).reshape(-1, 3)
        reals = np.frombuffer(self._buffer.float_buf(), dtype=np.float64).reshape(-1, 8)
        if not len(whole):
            return NOTHING
        rows = []
        for (first, second, count), real in zip(whole.tolist(), reals.tolist(), strict=True):
            a, b = sorted((self._numbers[first], self._numbers[second]))
            impulse = float(np.hypot(real[0], real[1]))
            rows += [
                (a, b, real[2 + 3 * k], real[3 + 3 * k], impulse, -real[4 + 3 * k] - SLOP)
                for k in range(count)
            ]
        # The physics keeps contacts by addresses, which differ from process to process.
        table = np.array(sorted(rows), dtype=np.float64).reshape(-1, 6)
        numbers = table[:, :2].astype(np.int64)
        return Touches(numbers[:, 0], numbers[:, 1], table[:, 2:4], table[:, 4], table[:, 5])

    def _sort(self, order: bytes) -> None:
        """Note which rows of a batch are which solids; they change as bodies fall asleep."""
        self._order = order
        numbers = [self._numbers.get(int(i), -1) for i in np.frombuffer(order, dtype=np.uintp)]
        kept = [row for row, number in enumerate(numbers) if 0 <= number < len(self.bodies)]
        self._kept = np.array(kept, dtype=np.int64)
        self._rows = np.array([numbers[row] for row in kept], dtype=np.int64)
        assert len(kept) == len(self.bodies), "a batch holds all bodies"


def _arm(solid: Solid) -> float:
    """How far a point of the outline is from the centre of mass (m)."""
    middle = (solid.spread.x, solid.spread.y)
    corners = [math.dist(corner, middle) for p in solid.shape.polygons for corner in p.vertices]
    # A circle turns within itself, but for where its middle is.
    return max((*corners, *(math.dist((d.x, d.y), middle) for d in solid.shape.discs)))


def _added(space: pymunk.Space, solid: Solid) -> pymunk.Body:
    if solid.mass is None:
        body = pymunk.Body(body_type=pymunk.Body.STATIC)
    else:
        body = pymunk.Body(solid.mass, solid.mass * solid.spread.gyration)
        body.center_of_gravity = (solid.spread.x, solid.spread.y)
    body.angle = solid.pose.heading
    body.position = (solid.pose.x, solid.pose.y)
    band = pymunk.ShapeFilter(categories=solid.band, mask=solid.band)
    shapes: list[pymunk.Shape] = [
        pymunk.Circle(body, disc.radius + SKIN, (disc.x, disc.y)) for disc in solid.shape.discs
    ]
    shapes += [pymunk.Poly(body, polygon.vertices, radius=SKIN) for polygon in solid.shape.polygons]
    for shape in shapes:
        shape.friction = solid.friction
        shape.filter = band
    space.add(body, *shapes)
    return body


def _enclose(space: pymunk.Space, arena: Array, friction: float) -> None:
    """Put up the walls: the edges of the arena, on the side of which there is no way out."""
    corners: list[tuple[float, float]] = [(float(x), float(y)) for x, y in arena]
    for a, b in zip(corners, (*corners[1:], corners[0]), strict=True):
        wall = pymunk.Segment(space.static_body, a, b, SKIN)
        wall.friction = friction
        space.add(wall)
