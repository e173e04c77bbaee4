"""Bodies in SI: what stands in the world, the readings of its sensors, and its channels."""

import math
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final, final

from compiler.findings import Findings
from compiler.lower_parts import origin_of
from compiler.quantities import is_without_ms, si_time, si_value
from compiler.world.shapes import RADIAN, heights_of, length, pose_of, positive, shape_of
from runtime.program import Kind, Unit
from runtime.world.model import Body, Drive, DriveKind, Reading, Sensor, SensorKind
from spec_schema.body import BodySpec, DifferentialSpec, DriveSpec, HolonomicSpec, SensorSpec
from spec_schema.load import Loaded
from spec_schema.places import Path
from spec_schema.suggest import did_you_mean, there_are
from spec_schema.units import parse_unit

FAR: Final = sys.float_info.max
"""The limit of what has none: every number that there is."""


@final
@dataclass(frozen=True, slots=True)
class Port:
    """A channel as its body has it, before anybody drives it."""

    name: str
    unit: Unit
    low: float
    high: float
    rest: str


@final
@dataclass(frozen=True, eq=False, slots=True)
class BodyPart:
    """A body, and the channels that it has."""

    body: Body
    ports: tuple[Port, ...]


READINGS: Final[Mapping[str, tuple[tuple[str, str, Kind], ...]]] = {
    "bump": (("hit", "1", Kind.DISCRETE),),
    "range": (("range", "m", Kind.CONTINUOUS),),
    "light": (("light", "lx", Kind.CONTINUOUS),),
    "sight": (
        ("seen", "1", Kind.DISCRETE),
        ("bearing", "rad", Kind.PERIODIC),
        ("distance", "m", Kind.CONTINUOUS),
    ),
    "gyro": (("turn", "rad/s", Kind.CONTINUOUS),),
    **dict.fromkeys(
        ("odometry", "pose"),
        (
            ("x", "m", Kind.CONTINUOUS),
            ("y", "m", Kind.CONTINUOUS),
            ("heading", "rad", Kind.PERIODIC),
            ("speed", "m/s", Kind.CONTINUOUS),
            ("turn", "rad/s", Kind.CONTINUOUS),
        ),
    ),
}
"""For each sort of sensor what it says: name, unit, kind."""


def lower_body(spec: BodySpec, loaded: Loaded, findings: Findings) -> BodyPart:
    """The body in SI, with a finding for each mistake."""
    low, high = heights_of(spec.height, ("height",), findings)
    drive = _drive(spec.drive, findings)
    sensors = tuple(
        _sensor(name, sensor, (low + high) / 2, loaded, findings)
        for name, sensor in spec.sensors.items()
    )
    for sensor in sensors:
        if spec.sensors[sensor.name].height is not None and sensor.height > high:
            message = f"{sensor.name} is {sensor.height:.4g} m high, above its body ({high:.4g} m)"
            remedy = "write a height within the body's, or make the body as high as its mast"
            findings.warning("S338", ("sensors", sensor.name, "height"), message, remedy)
    body = Body(
        name=spec.name,
        about=spec.about or "",
        shape=shape_of(spec.shape, ("shape",), findings),
        mass=positive(spec.mass, "kg", "a mass", ("mass",), findings),
        friction=spec.friction,
        low=low,
        high=high,
        drive=drive,
        sensors=sensors,
        source=origin_of(loaded),
    )
    return BodyPart(body, _ports(spec, drive, findings))


def _drive(spec: DriveSpec, findings: Findings) -> Drive:
    kind = DriveKind.DIFFERENTIAL if spec.differential is not None else DriveKind.HOLONOMIC
    given = spec.differential or spec.holonomic
    assert given is not None, "the model has seen to it"
    path: Path = ("drive", kind.value)
    return Drive(
        kind=kind,
        track=_track(given, path, findings),
        traction=given.traction,
        speed=positive(given.speed, "m/s", "the largest speed", (*path, "speed"), findings),
        turn=positive(given.turn, "rad/s", "the largest turn rate", (*path, "turn"), findings),
        acceleration=positive(
            given.acceleration, "m/s^2", "an acceleration", (*path, "acceleration"), findings
        ),
        spin=positive(given.spin, "rad/s^2", "an acceleration", (*path, "spin"), findings),
    )


def _track(given: DifferentialSpec | HolonomicSpec, path: Path, findings: Findings) -> float:
    if isinstance(given, HolonomicSpec):
        return 0.0
    return positive(given.track, "m", "the distance of the wheels", (*path, "track"), findings)


def _ports(spec: BodySpec, drive: Drive, findings: Findings) -> tuple[Port, ...]:
    is_holonomic = drive.kind is DriveKind.HOLONOMIC
    moves = ("base.forward", "base.left") if is_holonomic else ("base.speed",)
    names = (*moves, "base.turn")
    for name in spec.rest:
        if name not in names:
            message = f"this body has no channel '{name}'"
            remedy = did_you_mean(name, names) or there_are(names)
            findings.error("S340", ("rest", name), message, remedy, key=True)
    metres, radians = Unit("m/s", 1.0), Unit("rad/s", 1.0)
    rests = {name: spec.rest.get(name, "stop") for name in names}
    ports = [Port(name, metres, -drive.speed, drive.speed, rests[name]) for name in moves]
    return (*ports, Port("base.turn", radians, -drive.turn, drive.turn, rests["base.turn"]))


def _sensor(
    name: str, spec: SensorSpec, middle: float, loaded: Loaded, findings: Findings
) -> Sensor:
    path: Path = ("sensors", name)
    reach = 0.0
    if spec.reach is not None:
        reach = positive(spec.reach, "m", "a reach", (*path, "reach"), findings)
    latency = si_time(spec.latency, (*path, "latency"), findings) or 0.0
    if latency < 0.0:
        message = f"a latency can't be below 0 (got {spec.latency})"
        findings.error("S212", (*path, "latency"), message, "write how much later it says it")
    return Sensor(
        name=name,
        kind=SensorKind(spec.senses),
        pose=pose_of(spec.at, (*path, "at"), findings),
        width=_width(spec, path, findings),
        reach=reach,
        rays=spec.rays,
        height=middle if spec.height is None else length(spec.height, (*path, "height"), findings),
        of=spec.of,
        slip=spec.slip,
        every=_every(spec, (*path, "every"), findings),
        latency=max(latency, 0.0),
        readings=_readings(spec, reach, path, findings),
        origin=loaded.origin(path),
    )


def _every(spec: SensorSpec, path: Path, findings: Findings) -> float:
    if is_without_ms(spec.every, path, findings):
        return 1.0
    return positive(spec.every, "s", "the time between samples", path, findings)


def _width(spec: SensorSpec, path: Path, findings: Findings) -> float:
    if spec.width is None:
        return 0.0 if spec.senses == "range" else math.tau
    width = si_value(spec.width, RADIAN, (*path, "width"), findings) or 0.0
    if not 0.0 <= width <= math.tau + 1e-9:
        message = f"a sensor looks into an angle of 0 to 360 deg (got {spec.width})"
        findings.error("S212", (*path, "width"), message, "write 'width: 60 deg'")
    return width


def _readings(
    spec: SensorSpec, reach: float, path: Path, findings: Findings
) -> tuple[Reading, ...]:
    has = READINGS[spec.senses]
    names = [name for name, _, _ in has]
    for key in ("noise", "resolution"):
        for name in getattr(spec, key):
            if name not in names:
                message = f"a sensor of {spec.senses} has no reading '{name}'"
                remedy = did_you_mean(name, names) or there_are(names)
                findings.error("S322", (*path, key, name), message, remedy, key=True)
    return tuple(
        Reading(
            name,
            Unit(unit, 1.0),
            *_limits(name, kind, reach),
            kind,
            _amount(spec.noise.get(name, 0.0), unit, (*path, "noise", name), findings),
            _amount(spec.resolution.get(name, 0.0), unit, (*path, "resolution", name), findings),
        )
        for name, unit, kind in has
    )


def _limits(name: str, kind: Kind, reach: float) -> tuple[float, float]:
    match kind, name:
        case Kind.DISCRETE, _:
            return 0.0, 1.0
        case Kind.PERIODIC, _:
            return -math.pi, math.pi
        case _, "range" | "distance":
            return 0.0, reach
        case _, "light":
            return 0.0, FAR
    return -FAR, FAR


def _amount(value: float | str, unit: str, path: Path, findings: Findings) -> float:
    found = si_value(value, parse_unit(unit), path, findings) or 0.0
    if found < 0.0:
        message = f"this can't be below 0 (got {value})"
        findings.error("S212", path, message, "write 0 for none")
    return max(found, 0.0)
