"""What pictures of a run are drawn from: plain arrays, so that they depend on nothing that runs."""

from dataclasses import dataclass
from enum import StrEnum
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Booleans, Floats, Integers
from runtime.world.model import Shape

NOBODY: Final = -1
"""In `Trails.acting`: none of the robot's behaviors acts."""


@final
class EyeKind(StrEnum):
    """What of a sensor can be drawn: how far it is free, what it sees, whether it is hit."""

    RANGE = "range"
    SIGHT = "sight"
    BUMP = "bump"


@final
@dataclass(frozen=True, slots=True)
class Eye:
    """A sensor of a robot: where on it, where it looks, over which angle, and how far."""

    kind: EyeKind
    x: float
    y: float
    heading: float
    width: float
    reach: float


@final
@dataclass(frozen=True, slots=True)
class Item:
    """A thing or a robot: its footprint in its own frame, and whether it can be moved."""

    name: str
    shape: Shape
    is_fixed: bool = False
    eyes: tuple[Eye, ...] = ()


@final
@dataclass(frozen=True, slots=True)
class Lamp:
    """A light. on: the index of the thing that carries it, -1 for none; x, y are relative to it."""

    name: str
    x: float
    y: float
    on: int = NOBODY


@final
@dataclass(frozen=True, eq=False, slots=True)
class Glow:
    """Lux on the floor: xs (nx,), ys (ny,) are the middles of cells; lux (T, ny, nx) at times."""

    xs: Array
    ys: Array
    times: Array
    lux: Floats

    def at(self, time: float) -> int:
        """Which of the times is the last one up to `time`; the first one before all."""
        return max(int(np.searchsorted(self.times, time + 1e-9, side="right")) - 1, 0)


@final
@dataclass(frozen=True, eq=False, slots=True)
class Scene:
    """What stands in a world. arena: (k, 2) the corners; its edges are walls.

    glow: the light on the floor through the run. last_glow: as it was at the end, finer. spoken:
    names of things that a requirement or a behavior speaks of.
    """

    title: str
    arena: Array
    things: tuple[Item, ...]
    robots: tuple[Item, ...]
    lamps: tuple[Lamp, ...] = ()
    glow: Glow | None = None
    last_glow: Glow | None = None
    spoken: frozenset[str] = frozenset()
    about: str = ""
    seed: int | None = None


@final
@dataclass(frozen=True, slots=True)
class Mark:
    """Something that happened at a place: a robot touched something, or was stuck until `end`.

    Of a touch the place is where it touched; of a jam it is where the robot was.
    """

    robot: int
    time: float
    x: float
    y: float
    end: float = 0.0


@final
@dataclass(frozen=True, slots=True)
class Outcome:
    """A requirement, whether it held (None: it can't be said), and by how much, in words."""

    text: str
    holds: bool | None
    margin: str = ""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Said:
    """What an eye said at times (k,), increasing: (k,) each.

    seen: something is within reach, in view, or hits. distance, bearing: where, from the eye; of
    a range the bearing is where it looks.
    """

    times: Array
    seen: Booleans
    distance: Array
    bearing: Array

    def at(self, time: float) -> int:
        """Which of the times is the last one up to `time`; -1 before all."""
        return int(np.searchsorted(self.times, time + 1e-9, side="right")) - 1


@final
@dataclass(frozen=True, eq=False, slots=True)
class Trails:
    """Where everything was.

    Attributes:
        times: (n,) seconds, increasing.
        things: (n, t, 3) x, y, heading of each thing, in the order of the scene.
        robots: (n, r, 3) likewise.
        doers: for each robot the names of what may act.
        acting: (n, r) an index into the robot's doers, or NOBODY.
        contacts, jams: where they began.
        outcomes: of the requirements.
        said: for each robot what its eyes said, in their order; empty where nothing is known.
    """

    times: Array
    things: Array
    robots: Array
    doers: tuple[tuple[str, ...], ...]
    acting: Integers
    contacts: tuple[Mark, ...] = ()
    jams: tuple[Mark, ...] = ()
    outcomes: tuple[Outcome, ...] = ()
    said: tuple[tuple[Said, ...], ...] = ()
