"""What a world and the bodies in it are made of; SI, angles in radians, x right, y up.

Heights are above the floor: two things touch only where their heights overlap, so that a low robot
passes below a hanging light.
"""

from dataclasses import dataclass
from enum import StrEnum
from typing import final

from runtime.program import Kind, Origin, Unit


@final
@dataclass(frozen=True, slots=True)
class Disc:
    """A circle of `radius` around (x, y) in the thing's own frame."""

    x: float
    y: float
    radius: float


@final
@dataclass(frozen=True, slots=True)
class Polygon:
    """A convex polygon in the thing's own frame, counter-clockwise."""

    vertices: tuple[tuple[float, float], ...]


@final
@dataclass(frozen=True, slots=True)
class Shape:
    """A footprint: the union of its parts, which are rigidly joined."""

    discs: tuple[Disc, ...]
    polygons: tuple[Polygon, ...]


@final
@dataclass(frozen=True, slots=True)
class Pose:
    """Where something is."""

    x: float
    y: float
    heading: float


@final
@dataclass(frozen=True, slots=True)
class Thing:
    """An object that stands on the floor, or hangs above it.

    mass: kg, unused where it is fixed. friction: of its sides; of a contact, the product of both.
    floor: coefficient of friction between it and the floor. low, high: heights (m) that it fills.
    transmittance: the share of light that passes through it.
    """

    name: str
    shape: Shape
    pose: Pose
    is_fixed: bool
    mass: float
    friction: float
    floor: float
    low: float
    high: float
    transmittance: float
    origin: str


@final
@dataclass(frozen=True, slots=True)
class Scatter:
    """Things laid at random, anew for each seed: `count` copies named `name_1`, `name_2`...

    sizes: each copy is scaled by a factor within this range; its mass by the square of it.
    fixed: share of copies that are fixed. gap: at least so far from all else (m).
    area: (x, y) to (x, y), None for the whole arena.
    """

    name: str
    count: int
    prototype: Thing
    sizes: tuple[float, float]
    fixed: float
    gap: float
    area: tuple[float, float, float, float] | None
    origin: str


@final
@dataclass(frozen=True, slots=True)
class Light:
    """A point source of `power` candela at `height` metres.

    on: the name of the thing that carries it, empty for one that hangs in the world; `pose` is
    relative to that. cone: full width (rad) of the directions it shines to, 2 pi for all round.
    """

    name: str
    on: str
    pose: Pose
    height: float
    power: float
    cone: float
    origin: str


@final
@dataclass(frozen=True, slots=True)
class World:
    """An arena with things and lights in it.

    arena: the corners of a simple polygon, counter-clockwise; its edges are walls. ambient: lux.
    wall_friction: of the walls' sides.
    """

    name: str
    about: str
    arena: tuple[tuple[float, float], ...]
    wall_friction: float
    ambient: float
    things: tuple[Thing, ...]
    scattered: tuple[Scatter, ...]
    lights: tuple[Light, ...]
    source: Origin


@final
class DriveKind(StrEnum):
    """How a body moves: two wheels, or in any direction."""

    DIFFERENTIAL = "differential"
    HOLONOMIC = "holonomic"


@final
@dataclass(frozen=True, slots=True)
class Drive:
    """What moves a body.

    Its channels are `base.speed` and `base.turn`; of a holonomic one `base.forward`, `base.left`
    and `base.turn`.
    track: distance of the wheels (m). traction: friction of the wheels on the floor, which limits
    what it can push. speed, turn: the largest set-points (m/s, rad/s). acceleration, spin: the
    largest rates of change (m/s², rad/s²).
    """

    kind: DriveKind
    track: float
    traction: float
    speed: float
    turn: float
    acceleration: float
    spin: float


@final
@dataclass(frozen=True, slots=True)
class Reading:
    """One number that a sensor says: `noise` (standard deviation) and `step` (resolution) in SI."""

    name: str
    unit: Unit
    low: float
    high: float
    kind: Kind
    noise: float
    step: float


@final
class SensorKind(StrEnum):
    """What a sensor senses, and the readings that it has."""

    BUMP = "bump"  # hit
    RANGE = "range"  # range
    LIGHT = "light"  # light
    SIGHT = "sight"  # seen, bearing, distance
    ODOMETRY = "odometry"  # x, y, heading, speed, turn
    GYRO = "gyro"  # turn
    POSE = "pose"  # x, y, heading, speed, turn


@final
@dataclass(frozen=True, slots=True)
class Sensor:
    """A sensor of a body.

    pose: where on the body, and where it looks. width: full angle of its view (rad). reach: m.
    rays: of RANGE; it says the least range of so many rays over its width. height: m above the
    floor. of: of SIGHT, the names of what it looks for; `NAME_*` means all copies of a scatter,
    `light` any light. slip: of ODOMETRY, standard deviation of the scale of each wheel.
    every, latency: seconds; it samples at multiples of `every`, and says it `latency` later.
    """

    name: str
    kind: SensorKind
    pose: Pose
    width: float
    reach: float
    rays: int
    height: float
    of: tuple[str, ...]
    slip: float
    every: float
    latency: float
    readings: tuple[Reading, ...]
    origin: str


@final
@dataclass(frozen=True, slots=True)
class Body:
    """The body of a robot: what stands in the world, moves, and senses."""

    name: str
    about: str
    shape: Shape
    mass: float
    friction: float
    low: float
    high: float
    drive: Drive
    sensors: tuple[Sensor, ...]
    source: Origin
