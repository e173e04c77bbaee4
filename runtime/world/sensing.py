"""What each sensor of each robot would say now, without noise: all that a robot knows of a world.

A sensor is carried by its robot, whose own body hides and shades nothing from it. What comes out
are numbers; the world itself is reachable from here only.
"""

import math
from collections.abc import Sequence
from typing import Protocol, assert_never, final

import numpy as np

from runtime.arrays import Array
from runtime.chance import generator
from runtime.direct_calls import machine_code
from runtime.world.drive import Motion
from runtime.world.geometry import Geometry
from runtime.world.kernels.rays import nearest_hit, nearest_seen
from runtime.world.kernels.shade import illuminance
from runtime.world.light import ANYWHERE, LightMap, Sources
from runtime.world.model import Body, DriveKind, Light, Sensor, SensorKind
from runtime.world.odometry import Odometry
from runtime.world.rays import View, half_cosine, parts_of, spread
from runtime.world.world import Contact, SimulatedWorld


class Surroundings(Protocol):
    """What sensors ask of the world that they are in; a `SimulatedWorld` is such."""

    def geometry(self) -> Geometry:
        """What stands where now; always the same object."""
        ...

    def motion(self, robot: int) -> Motion:
        """How a robot moves, in its own frame."""
        ...

    def commanded(self, robot: int) -> Motion:
        """How its wheels turn, whether they slip or not."""
        ...

    def touching(self, robot: int) -> tuple[Contact, ...]:
        """Where something touches it now."""
        ...


def senses_of(world: SimulatedWorld) -> "Senses":
    """The senses of all robots in a world: what a `SimulatedWorld` is given as its `senses`."""
    robots = [(robot.name, robot.body) for robot in world.inhabitants]
    return Senses(world, robots, world.lights, world.model.ambient, world.seed)


class Sense(Protocol):
    """One sensor of one robot."""

    def read(self) -> tuple[float, ...]:
        """Its readings now; NaN for one that it has nothing new to say about."""
        ...


@final
class Senses:
    """All sensors of all robots in a world."""

    def __init__(
        self,
        around: Surroundings,
        robots: Sequence[tuple[str, Body]],
        lights: Sequence[Light],
        ambient: float,
        seed: int,
    ) -> None:
        """Robots by name, in the order of their owners. Nothing of the world is written to."""
        self._scene = _Scene(around, tuple(lights), ambient)
        self._odometers: list[tuple[int, Odometry]] = []
        self._bodies = tuple(body for _, body in robots)
        self._senses = tuple(
            tuple(self._sense(robot, name, body, sensor, seed) for sensor in body.sensors)
            for robot, (name, body) in enumerate(robots)
        )

    def sample(self, robot: int, sensor: int) -> Array:
        """The readings of one sensor at this instant, in the order of `Sensor.readings`.

        NaN stands for what it said last: bearing and distance of a sight that sees nothing.
        """
        return np.array(self._senses[robot][sensor].read())

    def advance(self, seconds: float) -> None:
        """Let odometers add what wheels turned in the step that has just passed."""
        for robot, odometer in self._odometers:
            odometer.advance(self._scene.around.commanded(robot), seconds)

    def light(self, robot: int) -> float:
        """Lux at the middle of a robot, half-way up its height; it does not shade itself."""
        body, scene = self._bodies[robot], self._scene
        x, y, _ = scene.pose(robot)
        place = (x, y, 0.5 * (body.low + body.high))
        return scene.lux(place, ANYWHERE, robot) + scene.ambient

    def light_map(self, cells: tuple[int, int]) -> LightMap:
        """The light on the floor of the arena, on (nx, ny) cells over its bounding box.

        It is as of now; ask the world for its `geometry` before each `update` of the map.
        """
        geometry, scene = self._scene.around.geometry(), self._scene
        corners = geometry.segments[geometry.owner[: len(geometry.segments)] == scene.walls, :2]
        box = (*corners.min(axis=0).tolist(), *corners.max(axis=0).tolist())
        return LightMap(scene.parts, scene.sources, box, cells, scene.ambient)

    def state(self) -> Array:
        """All that the senses remember, for digests: what odometers added up."""
        return np.concatenate([np.zeros(0), *(odometer.state() for _, odometer in self._odometers)])

    def _sense(self, robot: int, name: str, body: Body, sensor: Sensor, seed: int) -> Sense:
        scene = self._scene
        sense: Sense
        match sensor.kind:
            case SensorKind.BUMP:
                sense = _Bump(scene, robot, sensor)
            case SensorKind.RANGE:
                sense = _Range(scene, robot, sensor)
            case SensorKind.LIGHT:
                sense = _Meter(scene, robot, sensor)
            case SensorKind.SIGHT:
                sense = _Sight(scene, robot, sensor)
            case SensorKind.GYRO:
                sense = _Gyro(scene, robot)
            case SensorKind.POSE:
                sense = _Pose(scene, robot, body)
            case SensorKind.ODOMETRY:
                sense = self._odometer(robot, name, body, sensor, seed)
            case _:
                assert_never(sensor.kind)
        return sense

    def _odometer(self, robot: int, name: str, body: Body, sensor: Sensor, seed: int) -> Odometry:
        """One that goes on with every step."""
        chance = generator(seed, "slip", f"{name}.{sensor.name}")
        odometer = Odometry(sensor, body.drive, chance)
        self._odometers.append((robot, odometer))
        return odometer


@final
class _Scene:
    """What the sensors share."""

    def __init__(self, around: Surroundings, lights: tuple[Light, ...], ambient: float) -> None:
        self.around, self.lights, self.ambient = around, lights, ambient
        geometry = around.geometry()
        self.parts = parts_of(geometry)
        self.sources = Sources(lights, geometry)
        self.first, self.walls = geometry.things, geometry.things + geometry.robots
        self._lux = machine_code(
            illuminance, ((0.0, 0.0, 0.0), ANYWHERE, self.sources.rows, 0, self.parts)
        )

    def pose(self, robot: int) -> tuple[float, float, float]:
        x, y, heading = self.around.geometry().poses[self.first + robot].tolist()
        return x, y, heading

    def pose_of(self, robot: int, sensor: Sensor) -> tuple[float, float, float]:
        """Where a sensor is, and where it looks."""
        x, y, heading = self.pose(robot)
        at, cosine, sine = sensor.pose, math.cos(heading), math.sin(heading)
        return (
            x + cosine * at.x - sine * at.y,
            y + sine * at.x + cosine * at.y,
            heading + at.heading,
        )

    def lux(self, place: tuple[float, float, float], view: View, robot: int) -> float:
        self.sources.place()
        return self._lux(place, view, self.sources.rows, self.first + robot, self.parts)


@final
class _Bump:
    """Whether something touches the robot within the width, seen from the robot's middle."""

    def __init__(self, scene: _Scene, robot: int, sensor: Sensor) -> None:
        self._scene, self._robot = scene, robot
        self._heading, self._half = sensor.pose.heading, 0.5 * sensor.width

    def read(self) -> tuple[float, ...]:
        """Whether it is hit."""
        touching = self._scene.around.touching(self._robot)
        return (float(any(self._is_within(contact.bearing) for contact in touching)),)

    def _is_within(self, bearing: float) -> bool:
        return abs(math.remainder(bearing - self._heading, math.tau)) <= self._half


@final
class _Range:
    """The least distance along the rays; its reach where they hit nothing."""

    def __init__(self, scene: _Scene, robot: int, sensor: Sensor) -> None:
        self._scene, self._robot, self._sensor = scene, robot, sensor
        turns, skip = spread(sensor.width, sensor.rays), scene.first + robot
        self._rest = (turns, float(sensor.reach), float(sensor.height), skip, scene.parts)
        self._nearest = machine_code(nearest_hit, ((0.0, 0.0, 0.0), *self._rest))

    def read(self) -> tuple[float, ...]:
        place = self._scene.pose_of(self._robot, self._sensor)
        return (self._nearest(place, *self._rest),)


@final
class _Meter:
    """Lux on a horizontal surface that sees the directions within the width, and from above."""

    def __init__(self, scene: _Scene, robot: int, sensor: Sensor) -> None:
        self._scene, self._robot, self._sensor = scene, robot, sensor
        self._cosine = half_cosine(sensor.width)
        self._ambient = scene.ambient * min(sensor.width / math.tau, 1.0)

    def read(self) -> tuple[float, ...]:
        x, y, heading = self._scene.pose_of(self._robot, self._sensor)
        view = View(math.cos(heading), math.sin(heading), self._cosine, 0.0)
        place = (x, y, self._sensor.height)
        return (self._scene.lux(place, view, self._robot) + self._ambient,)


@final
class _Sight:
    """Whether one of its targets is in view; bearing and distance of the middle of the nearest.

    The bearing is from where it looks, the distance along the floor. A thing is looked at where it
    is as high as the sensor, or else as near to that as it gets; a light where it is.
    """

    def __init__(self, scene: _Scene, robot: int, sensor: Sensor) -> None:
        self._scene, self._robot, self._sensor = scene, robot, sensor
        geometry, own = scene.around.geometry(), scene.first + robot
        things = [
            owner
            for owner, name in enumerate(geometry.names[:-1])
            if owner != own and any(_is_named(name, wanted) for wanted in sensor.of)
        ]
        self._things = np.array(things, dtype=np.int64)
        self._lights = np.array(
            [
                index
                for index, light in enumerate(scene.lights)
                if "light" in sensor.of or any(_is_named(light.name, it) for it in sensor.of)
            ],
            dtype=np.int64,
        )
        self._owners = np.concatenate([self._things, scene.sources.owners[self._lights]])
        self._targets = np.zeros((len(self._owners), 3))
        for row, owner in enumerate(things):
            of = geometry.owner == owner
            low, high = geometry.low[of].min(), geometry.high[of].max()
            self._targets[row, 2] = min(max(sensor.height, low), high)
        self._cosine = half_cosine(sensor.width)
        self._rest = (self._targets, self._owners, own, scene.parts)
        nobody = View(1.0, 0.0, self._cosine, float(sensor.reach))
        self._nearest = machine_code(nearest_seen, ((0.0, 0.0, 0.0), nobody, *self._rest))

    def read(self) -> tuple[float, ...]:
        scene, sensor = self._scene, self._sensor
        count = len(self._things)
        self._targets[:count, :2] = scene.around.geometry().poses[self._things, :2]
        if len(self._lights):
            scene.sources.place()
            self._targets[count:] = scene.sources.rows[self._lights, :3]
        x, y, heading = scene.pose_of(self._robot, sensor)
        view = View(math.cos(heading), math.sin(heading), self._cosine, sensor.reach)
        eye = (x, y, sensor.height)
        seen, distance = self._nearest(eye, view, *self._rest)
        if seen < 0:
            return 0.0, math.nan, math.nan
        to_x, to_y = self._targets[seen, 0] - x, self._targets[seen, 1] - y
        bearing = math.remainder(math.atan2(to_y, to_x) - heading, math.tau)
        return 1.0, bearing, distance


@final
class _Gyro:
    """How fast the body turns, by itself or pushed, whatever its wheels do."""

    def __init__(self, scene: _Scene, robot: int) -> None:
        self._around, self._robot = scene.around, robot

    def read(self) -> tuple[float, ...]:
        """Its turn rate."""
        return (self._around.motion(self._robot).turn,)


@final
class _Pose:
    """Where the robot is and how it moves, without error."""

    def __init__(self, scene: _Scene, robot: int, body: Body) -> None:
        self._scene, self._robot = scene, robot
        self._has_wheels = body.drive.kind is DriveKind.DIFFERENTIAL

    def read(self) -> tuple[float, ...]:
        x, y, heading = self._scene.pose(self._robot)
        motion = self._scene.around.motion(self._robot)
        speed = motion.forward if self._has_wheels else math.hypot(motion.forward, motion.left)
        return x, y, math.remainder(heading, math.tau), speed, motion.turn


def _is_named(name: str, wanted: str) -> bool:
    """Whether `wanted` means a thing of this name: itself, or all copies of a scatter.

    >>> _is_named("clutter_12", "clutter_*"), _is_named("clutter_12", "clutter_1")
    (True, False)
    """
    if wanted.endswith("_*"):
        stem, _, number = name.rpartition("_")
        return stem == wanted[:-2] and number.isdigit()
    return name == wanted
