"""A point on a plane, worked out in closed form, and architectures that are wired by hand.

The point moves at the set-points of its two channels. It is all that the scheduler needs of a
world, so that the scheduler is tested without any physics.
"""

import hashlib
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from runtime.arbiter import Arbiter
from runtime.architecture import (
    Architecture,
    Channel,
    Choice,
    Command,
    Input,
    Node,
    Outside,
    Resolution,
    Setting,
    Signal,
    Way,
)
from runtime.arrays import Array, Booleans
from runtime.code import Code
from runtime.program import Kind, Origin, Program, Unit
from runtime.scenario import Robot, Scenario, Start
from runtime.scheduler.environment import Delivery
from runtime.scheduler.observer import Event, Observer, Resolved, Tick
from runtime.scheduler.scheduler import Scheduler
from runtime.world.model import (
    Body,
    Disc,
    Drive,
    DriveKind,
    Pose,
    Reading,
    Sensor,
    SensorKind,
    Shape,
    World,
)

ONE = Unit("1", 1.0)
HERE = "here.yaml:1:1"
SOURCE = Origin("here.yaml", "", "0" * 64)
STEP = 0.01


class Plane:
    """Points at (x, y) with the velocities that are commanded; a channel that rolls keeps its own.

    outside: gives the readings of a sensor from (robot, sensor, time) where they are no position.
    """

    def __init__(
        self,
        starts: Sequence[tuple[float, float]] = ((0.0, 0.0),),
        step: float = STEP,
        outside: Callable[[int, int, float], Sequence[float] | None] = lambda *_: None,
    ) -> None:
        self.at = np.array(starts, dtype=np.float64)
        self.velocity = np.zeros_like(self.at)
        self.step, self.steps, self.outside = step, 0, outside
        self.commands: list[tuple[int, int, Array, Booleans]] = []

    @property
    def time(self) -> float:
        return self.steps * self.step

    def sample(self, robot: int, sensor: int) -> Array:
        told = self.outside(robot, sensor, self.time)
        return self.at[robot].copy() if told is None else np.array(told, dtype=np.float64)

    def command(self, robot: int, channels: Array, driven: Booleans) -> None:
        self.commands.append((self.steps, robot, channels.copy(), driven.copy()))
        for axis in range(channels.size):
            if driven[axis]:
                self.velocity[robot, axis] = channels[axis]

    def advance(self) -> None:
        self.at += self.step * self.velocity
        self.steps += 1

    def state_hash(self) -> bytes:
        return hashlib.blake2b(self.at.tobytes() + self.velocity.tobytes()).digest()


class Plain:
    """Sensors without noise: each at its own rate (in steps), each late by so many steps."""

    def __init__(
        self, plane: Plane, sensors: Sequence[tuple[int, int]] = ((1, 0),), robots: int = 1
    ) -> None:
        self.plane, self.sensors, self.robots = plane, sensors, robots
        self.next_due = 0
        self.late: list[tuple[int, int, int, Array]] = []

    def due(self, instant: int) -> list[Delivery]:
        for robot in range(self.robots):
            for number, (every, latency) in enumerate(self.sensors):
                if instant % every == 0:
                    then = instant if instant == 0 else instant + latency
                    self.late.append((then, robot, number, self.plane.sample(robot, number)))
        now = [Delivery(*late[1:]) for late in self.late if late[0] == instant]
        self.late = [late for late in self.late if late[0] > instant]
        self.next_due = instant + 1
        return now

    def state(self) -> Array:
        return np.concatenate([np.zeros(0), *(readings for *_, readings in self.late)])


@dataclass
class N:
    """A node as a test writes it.

    inputs: entry to signal, to a number, or to (signal, scale, outside). commands: channel to
    (entry, mode) or (entry, mode, sign). choices: to nodes, or to (nodes, {"node.entry": value}).
    """

    name: str
    runs: Program | Arbiter | str
    period: float = STEP
    response: float = 0.0
    inputs: Mapping[str, str | float | tuple[str, float, Outside]] = field(default_factory=dict)
    commands: Mapping[str, tuple[str, str] | tuple[str, str, float]] = field(default_factory=dict)
    acts_when: str | None = None
    choices: Mapping[str, Sequence[str] | tuple[Sequence[str], Mapping[str, float]]] = field(
        default_factory=dict
    )
    replaces: Sequence[str] = ()
    level: int = 0
    tells: Sequence[str] = ()


def signal(name: str, low: float = -1e9, high: float = 1e9) -> Signal:
    return Signal(name, ONE, low, high, Kind.CONTINUOUS, (), HERE)


def told_by(node: N) -> list[str]:
    if isinstance(node.runs, str):
        return list(node.tells)
    outputs = [output.name for output in node.runs.outputs]
    return [*outputs, *node.runs.choices, "choice"] if isinstance(node.runs, Arbiter) else outputs


def architecture(
    nodes: Sequence[N],
    sensors: Mapping[str, Sequence[str]] | None = None,
    ways: Mapping[str, Resolution | Way] | None = None,
    rest: str = "stop",
    limit: float = 100.0,
    signals: Mapping[str, tuple[float, float]] | None = None,
) -> Architecture:
    """The architecture of a point with the channels `x` and `y`."""
    sensors = {"pos": ("x", "y")} if sensors is None else sensors
    names = [f"{s}.{r}" for s, readings in sensors.items() for r in readings]
    places: dict[str, list[int]] = {}
    for node in nodes:
        places[node.name] = [len(names) + i for i in range(len(told_by(node)))]
        names += [f"{node.name}.{told}" for told in told_by(node)]
    index = {node.name: i for i, node in enumerate(nodes)}
    programs = [node.runs for node in nodes if isinstance(node.runs, Program)]
    arbiters = [node.runs for node in nodes if isinstance(node.runs, Arbiter)]
    limits = signals or {}
    return Architecture(
        name="by_hand",
        about="",
        body="point.yaml",
        board=tuple(signal(name, *limits.get(name, (-1e9, 1e9))) for name in names),
        nodes=tuple(_node(node, names, index, places, programs, arbiters) for node in nodes),
        channels=tuple(
            _channel(name, nodes, index, (ways or {}).get(name), rest, limit) for name in "xy"
        ),
        programs=tuple(programs),
        arbiters=tuple(arbiters),
        order=tuple(range(len(nodes))),
        source=SOURCE,
    )


def _node(
    node: N,
    names: list[str],
    index: Mapping[str, int],
    places: Mapping[str, list[int]],
    programs: list[Program],
    arbiters: list[Arbiter],
) -> Node:
    return Node(
        name=node.name,
        period=node.period,
        response_time=node.response,
        level=node.level,
        inputs=tuple(_input(entry, source, names) for entry, source in _wires(node)),
        outputs=tuple(places[node.name]),
        behavior=programs.index(node.runs) if isinstance(node.runs, Program) else -1,
        arbiter=arbiters.index(node.runs) if isinstance(node.runs, Arbiter) else -1,
        module=node.runs if isinstance(node.runs, str) else "",
        commands=tuple(
            Command("xy".index(channel), what[1], what[0], float((*what, 1.0)[2]), HERE)
            for channel, what in node.commands.items()
        ),
        acts_when=Code(node.acts_when) if node.acts_when else None,
        choices=tuple(_choice(name, what, index) for name, what in node.choices.items()),
        replaces=tuple(index[name] for name in node.replaces),
        origin=HERE,
    )


def _wires(node: N) -> Iterable[tuple[str, str | float | tuple[str, float, Outside]]]:
    yield from node.inputs.items()
    if not isinstance(node.runs, str):
        for control in node.runs.controls:
            if control.name not in node.inputs:
                yield control.name, control.default


def _input(entry: str, source: str | float | tuple[str, float, Outside], names: list[str]) -> Input:
    match source:
        case str():
            return Input(entry, names.index(source), 0.0, 1.0, Outside.CLIP, HERE)
        case (name, scale, outside):
            return Input(entry, names.index(name), 0.0, scale, outside, HERE)
        case value:
            return Input(entry, -1, float(value), 1.0, Outside.CLIP, HERE)


def _choice(
    name: str,
    what: Sequence[str] | tuple[Sequence[str], Mapping[str, float]],
    index: Mapping[str, int],
) -> Choice:
    acts, sets = what if len(what) == 2 and isinstance(what[1], Mapping) else (what, {})
    settings = []
    for full, value in sets.items():
        node, entry = full.split(".")
        settings.append(Setting(index[node], entry, value, HERE))
    return Choice(name, tuple(index[node] for node in acts), tuple(settings), HERE)


def _channel(
    name: str,
    nodes: Sequence[N],
    index: Mapping[str, int],
    way: Resolution | Way | None,
    rest: str,
    limit: float,
) -> Channel:
    reaching = tuple(index[node.name] for node in nodes if name in node.commands)
    if not isinstance(way, Resolution):
        way = Resolution(way or Way.SINGLE, reaching, -1, "", "", HERE)
    return Channel(name, ONE, -limit, limit, rest, way, HERE)


def resolution(way: Way, *nodes: int, arbiter: int = -1, function: str = "") -> Resolution:
    return Resolution(way, nodes, arbiter, function, "", HERE)


def scenario(
    *architectures: Architecture,
    sensors: Mapping[str, Sequence[str]] | None = None,
    seed: int = 0,
    step: float = STEP,
    beginnings: Mapping[str, float] | None = None,
) -> Scenario:
    """A scenario with a robot `r` (then `r1`, ...) for each architecture."""
    sensors = {"pos": ("x", "y")} if sensors is None else sensors
    body = Body(
        "point",
        "",
        Shape((Disc(0.0, 0.0, 0.1),), ()),
        1.0,
        0.0,
        0.0,
        0.1,
        Drive(DriveKind.HOLONOMIC, 0.1, 1.0, 100.0, 100.0, 100.0, 100.0),
        tuple(_sensor(name, readings) for name, readings in sensors.items()),
        SOURCE,
    )
    robots = tuple(
        Robot(f"r{i or ''}", body, wired, Start(None), HERE)
        for i, wired in enumerate(architectures)
    )
    world = World("plane", "", ((-9, -9), (9, -9), (9, 9), (-9, 9)), 0.0, 0.0, (), (), (), SOURCE)
    begins = dict(beginnings or {})
    return Scenario("test", "", world, robots, 1.0, step, seed, begins, (), SOURCE)


def _sensor(name: str, readings: Sequence[str]) -> Sensor:
    said = tuple(Reading(r, ONE, -1e9, 1e9, Kind.CONTINUOUS, 0.0, 0.0) for r in readings)
    pose = Pose(0.0, 0.0, 0.0)
    return Sensor(name, SensorKind.POSE, pose, 0.0, 0.0, 1, 0.0, (), 0.0, STEP, 0.0, said, HERE)


class Noted(Observer):
    """An observer that keeps copies of everything."""

    def __init__(self) -> None:
        self.ticks: list[tuple[int, Tick]] = []
        self.events: list[tuple[int, Event]] = []
        self.channels: list[tuple[int, int, Array, Booleans]] = []
        self.acts: list[tuple[int, int, Booleans, Array]] = []
        self.readings: list[tuple[int, Delivery]] = []
        self.resolutions: list[tuple[int, int, int, Resolved]] = []

    def sensed(self, instant: int, delivery: Delivery) -> None:
        self.readings.append((instant, delivery))

    def ticked(self, instant: int, tick: Tick) -> None:
        copies = {key: getattr(tick, key).copy() for key in ("register", "outputs", "commands")}
        self.ticks.append((instant, tick._replace(**copies)))

    def acting(self, instant: int, robot: int, acts: Booleans, weights: Array) -> None:
        self.acts.append((instant, robot, acts.copy(), weights.copy()))

    def commanded(self, instant: int, robot: int, channels: Array, driven: Booleans) -> None:
        self.channels.append((instant, robot, channels.copy(), driven.copy()))

    def resolved(self, instant: int, robot: int, channel: int, how: Resolved) -> None:
        self.resolutions.append((instant, robot, channel, how))

    def happened(self, instant: int, event: Event) -> None:
        self.events.append((instant, event))

    def of(self, node: int) -> list[tuple[int, Tick]]:
        """The ticks of one node."""
        return [(instant, tick) for instant, tick in self.ticks if tick.node == node]


def positions(scheduler: Scheduler, plane: Plane, instants: int) -> Array:
    """Where robot 0 is at instants 0 .. `instants`, (instants + 1, 2)."""
    path = [plane.at[0].copy()]
    for _ in range(instants):
        scheduler.step()
        path.append(plane.at[0].copy())
    return np.array(path)
