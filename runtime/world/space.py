"""The space of the physics: bodies, shapes and walls from the model, and what is read of them."""

import math
from dataclasses import dataclass
from typing import Final, NamedTuple, final

import pymunk
from pymunk.batch import ArbiterFields

from runtime.arrays import Array
from runtime.world.chipmunk import Bodies, Contacts, stepper
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

DEPTHS: Final = ArbiterFields.DISTANCE_1 | ArbiterFields.DISTANCE_2
CONTACT: Final = (
    ArbiterFields.BODY_A_ID
    | ArbiterFields.BODY_B_ID
    | ArbiterFields.CONTACT_COUNT
    | ArbiterFields.TOTAL_IMPULSE
    | ArbiterFields.POINT_A_1
    | ArbiterFields.DISTANCE_1
    | ArbiterFields.POINT_A_2
    | ArbiterFields.DISTANCE_2
)
WHOLE, REAL = 3, 8
"""How many whole and real numbers a contact has in such a batch."""


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
class Touch(NamedTuple):
    """A point at which two solids a < b touch; the walls come last.

    x, y: in the world. impulse: of the last step, of all points of the two parts together (N s).
    depth: metres that outlines stand in one another; negative where they only just touch.
    """

    a: int
    b: int
    x: float
    y: float
    impulse: float
    depth: float


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
        self._step = stepper(self.space)
        self._solids = Bodies(self.bodies)
        self._all: Bodies | None = None
        self._depths = Contacts(self.space, DEPTHS)
        self._contacts = Contacts(self.space, CONTACT)
        self._arm = max((_arm(solid) for solid in solids if solid.mass is not None), default=0.0)

    def states(self) -> Array:
        """Of all solids (n, 6): x, y, heading; velocity of the centre of mass x, y; turn rate."""
        return self._solids.states()

    def step(self, seconds: float) -> float:
        """Let so many seconds pass; how deep outlines stand in one another then, at the worst (m).

        -inf where none touch.
        """
        self._step(seconds)
        found = self._depths.read()
        # A pair that touches at one point has 0 for the other, which is less deep than the skin.
        return -min(found) - SLOP if found else -math.inf

    def fastest(self) -> float:
        """A speed that no point of a body, nor a wheel, exceeds now (m/s)."""
        if self._all is None:  # drives are added to the space later than solids
            self._all = Bodies(tuple(self.space.bodies))
        x, y, turn = self._all.largest_speeds()
        return math.hypot(x, y) + turn * self._arm

    def touches(self) -> list[Touch]:
        """What touches now, in a fixed order."""
        real = self._contacts.read()
        if not real:
            return []
        whole, numbers = self._contacts.whole(), self._numbers
        found = []
        for row in range(len(real) // REAL):
            at, of = REAL * row, WHOLE * row
            a, b = numbers[whole[of]], numbers[whole[of + 1]]
            if a > b:
                a, b = b, a
            impulse = math.hypot(real[at], real[at + 1])
            found += [
                Touch(a, b, real[k], real[k + 1], impulse, -real[k + 2] - SLOP)
                for k in range(at + 2, at + 2 + 3 * whole[of + 2], 3)
            ]
        # The physics keeps contacts by addresses, which differ from process to process.
        return sorted(found)


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
