"""What a run did, as arrays, each at its own rate: seconds and SI; angles of things not wrapped."""

from dataclasses import dataclass
from typing import final

from runtime.arrays import Array, Booleans, Floats
from runtime.program import Kind, Unit


@final
@dataclass(frozen=True, eq=False, slots=True)
class Quantity:
    """A named quantity of a run.

    times: (T,) strictly increasing. Of what a node tells: when it takes effect, which is before
    the run ends, and 0 for what is read before that. values: (T,) SI.
    A discrete one is the index of one of `labels`, where it has such; -1 where none holds.
    low, high: its domain; a periodic one wraps there. is_held: it stays until its next sample.
    """

    name: str
    unit: Unit
    kind: Kind
    labels: tuple[str, ...]
    low: float
    high: float
    is_held: bool
    times: Array
    values: Array


@final
@dataclass(frozen=True, eq=False, slots=True)
class NodeTrack:
    """The ticks of a node; see `runtime.scheduler.observer.Tick`.

    times: (T,). register: (T, r) as sampled. outputs: (T, q) and commands: (T, c), in effect its
    response time later. allowed, acts: (T,).
    """

    times: Array
    register: Array
    outputs: Array
    commands: Array
    allowed: Booleans
    acts: Booleans


@final
@dataclass(frozen=True, eq=False, slots=True)
class SensorTrack:
    """What a sensor said: readings (T, k) that went on the board at times (T,)."""

    times: Array
    readings: Array


@final
@dataclass(frozen=True, eq=False, slots=True)
class ActingTrack:
    """Who acts from times (T,) on: acts (T, nodes), weights (T, nodes)."""

    times: Array
    acts: Booleans
    weights: Array


@final
@dataclass(frozen=True, eq=False, slots=True)
class ChannelTrack:
    """What the channels are from times (T,) on: set_points (T, c), driven (T, c)."""

    times: Array
    set_points: Array
    driven: Booleans


@final
@dataclass(frozen=True, eq=False, slots=True)
class ResolutionTrack:
    """Who has their way on a channel from times (T,) on; see `runtime.scheduler.observer.Resolved`.

    weights: (T, nodes). limited, in_conflict: (T,).
    """

    times: Array
    weights: Array
    limited: Booleans
    in_conflict: Booleans


@final
@dataclass(frozen=True, eq=False, slots=True)
class RobotTrack:
    """Everything that went on in one robot, in the order of its nodes, sensors and channels."""

    nodes: tuple[NodeTrack, ...]
    sensors: tuple[SensorTrack, ...]
    acting: ActingTrack
    channels: ChannelTrack
    resolutions: tuple[ResolutionTrack, ...]


@final
@dataclass(frozen=True, eq=False, slots=True)
class WorldTrack:
    """Where all were.

    names: of things, then robots (n,). times: (T,). poses: (T, n, 3) x, y, heading. motions:
    (T, robots, 2) speed ahead and turn. light: (T, robots) lux. close_times: (S,) every step.
    clearance, contacts: (S, robots).
    """

    names: tuple[str, ...]
    times: Array
    poses: Array
    motions: Array
    light: Array
    close_times: Array
    clearance: Array
    contacts: Array


@final
@dataclass(frozen=True, eq=False, slots=True)
class LightFrames:
    """The light on the floor, lux (T, ny, nx) at times (T,).

    xs, ys: the middles of the cells.
    """

    xs: Array
    ys: Array
    times: Array
    lux: Floats


@final
@dataclass(frozen=True, slots=True)
class Happening:
    """Something that should not pass in silence; `where`: the node or channel, or empty."""

    time: float
    robot: str
    what: str
    where: str


@final
@dataclass(frozen=True, slots=True)
class Touch:
    """A robot began to touch something at (x, y): a thing, another robot, or `walls`."""

    time: float
    robot: str
    what: str
    x: float
    y: float
