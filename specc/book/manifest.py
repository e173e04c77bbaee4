"""`book.json`: what a book holds, for programs. Written and read exactly; one way for each book.

All numbers are in SI; each quantity says the unit in which people read it. Paths are relative to
the book, with forward slashes.
"""

import hashlib
from dataclasses import dataclass
from typing import Final, final

from runtime.document import Document
from specc.book.trials import Trial

ARTIFACTS: Final = {"architecture": "architecture.specc", "scenario": "scenario.specc"}
"""The compiled program in a book of each kind."""


@final
@dataclass(frozen=True, slots=True)
class File:
    """A file of the book, and by what it is known to be whole."""

    path: str
    bytes: int
    sha256: str


@final
@dataclass(frozen=True, slots=True)
class Quantity:
    """A state, control, output or read; of outputs no range is declared, and they are 0.

    kind: continuous, periodic or discrete. role: of a state. values: labels of a discrete one.
    agent, environment: the two parts that a state relates. default: of a control.
    unit, scale: as people read it, and the SI value of one of it.
    """

    name: str
    kind: str
    role: str
    unit: str
    scale: float
    low: float
    high: float
    default: float
    values: tuple[str, ...]
    agent: str
    environment: str
    about: str


@final
@dataclass(frozen=True, slots=True)
class Wire:
    """Where an entry of a module comes from: `scale` times a signal, or (signal empty) a value.

    outside: clip or inhibit, where the signal leaves the entry's domain.
    """

    entry: str
    signal: str
    value: float
    scale: float
    outside: str


@final
@dataclass(frozen=True, slots=True)
class Action:
    """How a behavior acts on a channel: `sign` times an entry, as `mode` (rate, set-point...)."""

    channel: str
    entry: str
    mode: str
    sign: float


@final
@dataclass(frozen=True, slots=True)
class Setting:
    """Values (SI) of the controls at which the book shows a behavior, and who sets them so.

    by: `default`, or the choices of arbiters that set them, as `mission.far`.
    """

    name: str
    by: tuple[str, ...]
    controls: dict[str, float]


@final
@dataclass(frozen=True, slots=True)
class Tabulated:
    """A table in the book's data: a rate, next state or output at one setting.

    quantity: `rate NAME` (in `unit` per second), `next NAME` or `output NAME`. unit: of its values.
    axes: names, in order; what is not among them does not change it. error: the largest difference
    from the compiled program that was seen at `points` random places, in `unit`; `size` is the
    largest value seen there.
    """

    quantity: str
    setting: str
    unit: str
    axes: tuple[str, ...]
    counts: tuple[int, ...]
    error: float
    size: float
    points: int


@final
@dataclass(frozen=True, slots=True)
class Faithful:
    """What "the robot does this" means, SI: see `runtime.program.Fidelity`."""

    tolerance: dict[str, float]
    scatter: dict[str, float]
    horizon: float
    region: dict[str, tuple[float, float]]
    coverage: float


@final
@dataclass(frozen=True, slots=True)
class Choice:
    """What a choice of an arbiter means: nodes that act, and `NODE.CONTROL` that are set (SI)."""

    name: str
    acts: tuple[str, ...]
    sets: dict[str, float]


@final
@dataclass(frozen=True, slots=True)
class Module:
    """A node of an architecture: what is to be built, and verified by itself.

    kind: behavior, arbiter or module (a program of the author's own). spec: its file in the book,
    empty of a module. page: its HTML. level: 0 of base behaviors. period, response_time: seconds.
    agreement: of an arbiter the share of decisions that must agree, None where none is declared.
    trial: how to test it.
    """

    node: str
    kind: str
    name: str
    about: str
    spec: str
    page: str
    level: int
    period: float
    response_time: float
    states: tuple[Quantity, ...]
    reads: tuple[Quantity, ...]
    controls: tuple[Quantity, ...]
    outputs: tuple[Quantity, ...]
    wires: tuple[Wire, ...]
    actions: tuple[Action, ...]
    choices: tuple[Choice, ...]
    settings: tuple[Setting, ...]
    tables: tuple[Tabulated, ...]
    data: tuple[str, ...]
    figures: tuple[str, ...]
    faithful: Faithful | None
    agreement: float | None
    feasibility: str
    evidence: str
    trial: Trial


@final
@dataclass(frozen=True, slots=True)
class ChannelEntry:
    """A channel of the body: its range (SI), who reaches it, and how conflicts are resolved."""

    name: str
    unit: str
    scale: float
    low: float
    high: float
    rest: str
    way: str
    nodes: tuple[str, ...]
    proof: str


@final
@dataclass(frozen=True, slots=True)
class ArchitectureEntry:
    """An architecture of the book. robots: of a scenario, those that it controls."""

    name: str
    about: str
    spec: str
    body: str
    robots: tuple[str, ...]
    modules: tuple[Module, ...]
    channels: tuple[ChannelEntry, ...]


@final
@dataclass(frozen=True, slots=True)
class Required:
    """A requirement, and what the run of the scenario with its own seed says of it."""

    text: str
    outcome: str
    sentence: str


@final
@dataclass(frozen=True, slots=True)
class Book:
    """A whole book. kind: architecture or scenario. spec: what it was made of, within the book.

    specc: the version that made it. files: all files of the book but this one, by path.
    """

    kind: str
    name: str
    about: str
    specc: str
    spec: str
    artifact: str
    seed: int | None
    architectures: tuple[ArchitectureEntry, ...]
    requirements: tuple[Required, ...]
    files: tuple[File, ...]

    @property
    def modules(self) -> tuple[Module, ...]:
        """All modules of all architectures."""
        return tuple(module for one in self.architectures for module in one.modules)


DOCUMENT: Final = Document("book", "book", 1, Book)


def to_bytes(book: Book) -> bytes:
    """The manifest as it stands in `book.json`.

    Raises:
        ArtifactError: a number is not finite.
    """
    return DOCUMENT.written(book)


def from_bytes(data: bytes) -> Book:
    """The manifest.

    Raises:
        ArtifactError: it is not exactly what `to_bytes` writes.
    """
    book: Book = DOCUMENT.read(data)
    return book


def file_entry(path: str, data: bytes) -> File:
    """The entry of a file of the book."""
    return File(path, len(data), hashlib.sha256(data).hexdigest())
