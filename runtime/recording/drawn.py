"""What of a run is drawn: bodies, things, walls and lights, poses, the light on the floor, echoes.

Foxglove draws the scene, the frames, the grid and the scans; rerun makes its own of the frames, the
poses, the image and the points. So one file opens in both.
"""

import math
from itertools import pairwise
from typing import Any, Final

import numpy as np

from runtime.arrays import Array
from runtime.recording.foxglove import classes
from runtime.recording.messages import NANOSECONDS, Messages, nanoseconds
from runtime.recording.tracks import LightFrames, SensorTrack, WorldTrack
from runtime.run import Run
from runtime.scenario import Robot
from runtime.world.model import Pose, Sensor, SensorKind, Shape

WORLD: Final = "world"
WALL_HEIGHT: Final = 0.05
WALL_WIDTH: Final = 0.02
LAMP: Final = 0.06
"""Metres across that a light is drawn."""
FLOAT32: Final = 7
"""`PackedElementField.FLOAT32`."""
FIXED: Final = (0.45, 0.45, 0.48, 1.0)
MOVABLE: Final = (0.80, 0.60, 0.35, 1.0)
WALLS: Final = (0.30, 0.30, 0.33, 1.0)
LIT: Final = (1.0, 0.85, 0.2, 1.0)
ROBOTS: Final = ((0.0, 0.45, 0.70, 1.0), (0.84, 0.37, 0.0, 1.0), (0.0, 0.62, 0.45, 1.0))
NOSE: Final = (1.0, 1.0, 1.0, 1.0)
FLOOR: Final = -0.001
"""Height (m) of the light on the floor: below all that stands on it."""


def tell_drawn(messages: Messages, run: Run) -> None:
    """All topics that are drawn."""
    _tell_scene(messages, run)
    _tell_frames(messages, run.world, _moving(run))
    if run.floor is not None:
        _tell_floor(messages, run.floor)
    for robot, track in zip(run.scenario.robots, run.robots, strict=True):
        for sensor, said in zip(robot.body.sensors, track.sensors, strict=True):
            if sensor.kind is SensorKind.RANGE:
                _tell_echoes(messages, robot, sensor, said)


def _moving(run: Run) -> list[int]:
    """Places of what may move: things that are not fixed, and robots."""
    things = [i for i, thing in enumerate(run.layout.things) if not thing.is_fixed]
    return [*things, *range(len(run.layout.things), len(run.world.names))]


def _tell_scene(messages: Messages, run: Run) -> None:
    """What there is, once: what may move stands in a frame of its own."""
    made = classes()
    update = made["SceneUpdate"]()
    for thing in run.layout.things:
        frame = WORLD if thing.is_fixed else thing.name
        entity = _entity(update, thing.name, frame)
        pose = thing.pose if thing.is_fixed else Pose(0.0, 0.0, 0.0)
        _add_shape(
            entity, thing.shape, pose, (thing.low, thing.high), FIXED if thing.is_fixed else MOVABLE
        )
    for place, robot in enumerate(run.scenario.robots):
        entity = _entity(update, robot.name, robot.name)
        body, origin = robot.body, Pose(0.0, 0.0, 0.0)
        color = ROBOTS[place % len(ROBOTS)]
        _add_shape(entity, body.shape, origin, (body.low, body.high), color)
        arrow = entity.arrows.add(
            shaft_length=0.06, shaft_diameter=0.02, head_length=0.04, head_diameter=0.05
        )
        _place(arrow.pose, origin, body.high)
        _paint(arrow.color, NOSE)
    _add_walls(update, run.scenario.world.arena)
    fixed = {thing.name: thing.pose for thing in run.layout.things if thing.is_fixed}
    for light in run.scenario.world.lights:
        frame = light.on if light.on and light.on not in fixed else WORLD
        entity = _entity(update, f"light {light.name}", frame)
        ball = entity.spheres.add()
        pose = light.pose
        if light.on in fixed:
            pose = _beyond(fixed[light.on], light.pose)
        _place(ball.pose, pose, light.height)
        ball.size.x = ball.size.y = ball.size.z = LAMP
        _paint(ball.color, LIT)
    messages.draw(messages.drawn_topic("/world/scene", "SceneUpdate"), 0.0, update)


def _beyond(carrier: Pose, pose: Pose) -> Pose:
    """A pose that is relative to its carrier's, in the world."""
    c, s = math.cos(carrier.heading), math.sin(carrier.heading)
    x, y = carrier.x + c * pose.x - s * pose.y, carrier.y + s * pose.x + c * pose.y
    return Pose(x, y, carrier.heading + pose.heading)


def _entity(update: Any, name: str, frame: str) -> Any:
    entity = update.entities.add(id=name, frame_id=frame, frame_locked=True)
    entity.timestamp.SetInParent()
    return entity


def _add_shape(
    entity: Any,
    shape: Shape,
    pose: Pose,
    heights: tuple[float, float],
    color: tuple[float, float, float, float],
) -> None:
    low, high = heights
    for disc in shape.discs:
        cylinder = entity.cylinders.add(bottom_scale=1.0, top_scale=1.0)
        _place(cylinder.pose, _beyond(pose, Pose(disc.x, disc.y, 0.0)), 0.5 * (low + high))
        cylinder.size.x = cylinder.size.y = 2.0 * disc.radius
        cylinder.size.z = high - low
        _paint(cylinder.color, color)
    for polygon in shape.polygons:
        prism = entity.triangles.add()
        _place(prism.pose, pose, 0.0)
        _paint(prism.color, color)
        for x, y, z in _prism(polygon.vertices, low, high):
            prism.points.add(x=x, y=y, z=z)


def _prism(
    corners: tuple[tuple[float, float], ...], low: float, high: float
) -> list[tuple[float, float, float]]:
    """The corners of the triangles that bound a convex prism."""
    points = []
    first = corners[0]
    for one, other in pairwise(corners[1:]):
        points += [(*first, high), (*one, high), (*other, high)]
        points += [(*first, low), (*other, low), (*one, low)]
    for one, other in zip(corners, (*corners[1:], first), strict=True):
        points += [(*one, low), (*other, low), (*other, high)]
        points += [(*one, low), (*other, high), (*one, high)]
    return points


def _add_walls(update: Any, arena: tuple[tuple[float, float], ...]) -> None:
    entity = _entity(update, "walls", WORLD)
    for (x, y), (u, v) in zip(arena, (*arena[1:], arena[0]), strict=True):
        wall = entity.cubes.add()
        pose = Pose(0.5 * (x + u), 0.5 * (y + v), math.atan2(v - y, u - x))
        _place(wall.pose, pose, 0.5 * WALL_HEIGHT)
        wall.size.x = math.hypot(u - x, v - y) + WALL_WIDTH
        wall.size.y, wall.size.z = WALL_WIDTH, WALL_HEIGHT
        _paint(wall.color, WALLS)


def _tell_frames(messages: Messages, world: WorldTrack, moving: list[int]) -> None:
    """Where everything is that may move: as frames, and as poses."""
    made = classes()
    frames = messages.drawn_topic("/tf", "FrameTransforms")
    poses = messages.drawn_topic("/world/poses", "PosesInFrame")
    names = [world.names[place] for place in moving]
    for time, rows in zip(world.times.tolist(), world.poses[:, moving].tolist(), strict=True):
        transforms = made["FrameTransforms"]()
        together = made["PosesInFrame"](frame_id=WORLD)
        _stamp(together.timestamp, time)
        for name, (x, y, heading) in zip(names, rows, strict=True):
            each = transforms.transforms.add(parent_frame_id=WORLD, child_frame_id=name)
            _stamp(each.timestamp, time)
            each.translation.x, each.translation.y, each.translation.z = x, y, 0.0
            each.rotation.z, each.rotation.w = math.sin(0.5 * heading), math.cos(0.5 * heading)
            _place(together.poses.add(), Pose(x, y, heading), 0.0)
        messages.draw(frames, time, transforms)
        messages.draw(poses, time, together)


def _tell_floor(messages: Messages, floor: LightFrames) -> None:
    """The light on the floor: in lux as a grid, and as a picture, the brightest cell white."""
    made = classes()
    grids = messages.drawn_topic("/world/light", "Grid")
    images = messages.drawn_topic("/world/light_image", "RawImage")
    rows, columns = floor.lux.shape[1:]
    width = float(floor.xs[1] - floor.xs[0]) if columns > 1 else 1.0
    height = float(floor.ys[1] - floor.ys[0]) if rows > 1 else 1.0
    corner = Pose(float(floor.xs[0]) - 0.5 * width, float(floor.ys[0]) - 0.5 * height, 0.0)
    top = max(float(floor.lux.max()), 1e-12)
    for time, lux in zip(floor.times.tolist(), floor.lux, strict=True):
        grid = made["Grid"](
            frame_id=WORLD, column_count=columns, row_stride=4 * columns, cell_stride=4
        )
        _stamp(grid.timestamp, time)
        _place(grid.pose, corner, FLOOR)
        grid.cell_size.x, grid.cell_size.y = width, height
        grid.fields.add(name="lux", offset=0, type=FLOAT32)
        grid.data = lux.astype("<f4").tobytes()
        messages.draw(grids, time, grid)
        image = made["RawImage"](
            frame_id=WORLD, width=columns, height=rows, encoding="mono8", step=columns
        )
        _stamp(image.timestamp, time)
        # The eye tells ratios, not differences; the first row of a picture is its top.
        shown = np.round(255.0 * np.sqrt(lux[::-1] / top)).astype(np.uint8)
        image.data = shown.tobytes()
        messages.draw(images, time, image)


def _tell_echoes(messages: Messages, robot: Robot, sensor: Sensor, said: SensorTrack) -> None:
    """The least range over the rays, drawn on all of them: somewhere on that arc is something."""
    made = classes()
    scans = messages.drawn_topic(f"/{robot.name}/{sensor.name}/scan", "LaserScan")
    points = messages.drawn_topic(f"/{robot.name}/{sensor.name}/points", "PointCloud")
    half = 0.5 * sensor.width if sensor.rays > 1 else 0.0
    angles = np.linspace(-half, half, sensor.rays)
    for time, (distance,) in zip(said.times.tolist(), said.readings.tolist(), strict=True):
        scan = made["LaserScan"](frame_id=robot.name, start_angle=-half, end_angle=half)
        _stamp(scan.timestamp, time)
        _place(scan.pose, sensor.pose, sensor.height)
        scan.ranges.extend([distance] * sensor.rays)
        messages.draw(scans, time, scan)
        cloud = made["PointCloud"](frame_id=robot.name, point_stride=12)
        _stamp(cloud.timestamp, time)
        _place(cloud.pose, sensor.pose, sensor.height)
        for index, name in enumerate("xyz"):
            cloud.fields.add(name=name, offset=4 * index, type=FLOAT32)
        cloud.data = _arc(angles, distance).astype("<f4").tobytes()
        messages.draw(points, time, cloud)


def _arc(angles: Array, distance: float) -> Array:
    arc: Array = distance * np.stack([np.cos(angles), np.sin(angles), 0.0 * angles], axis=1)
    return arc


def _place(pose: Any, where: Pose, height: float) -> None:
    pose.position.x, pose.position.y, pose.position.z = where.x, where.y, height
    pose.orientation.z = math.sin(0.5 * where.heading)
    pose.orientation.w = math.cos(0.5 * where.heading)


def _paint(color: Any, rgba: tuple[float, float, float, float]) -> None:
    color.r, color.g, color.b, color.a = rgba


def _stamp(stamp: Any, time: float) -> None:
    stamp.seconds, stamp.nanos = divmod(nanoseconds(time), int(NANOSECONDS))
