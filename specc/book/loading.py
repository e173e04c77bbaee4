"""A book read back: the program that it was made with, and the same from its specs."""

from dataclasses import dataclass
from pathlib import Path
from typing import final

from runtime import architecture_artifact, scenario_artifact
from runtime.architecture import Architecture
from runtime.progress import Progress, in_silence
from runtime.scenario import Scenario
from runtime.world.model import Body
from specc import loading
from specc.book.folder import read_book
from specc.book.manifest import Book
from specc.book.sources import sources_of
from specc.origins import renamed


@final
@dataclass(frozen=True, eq=False, slots=True)
class LoadedBook:
    """A whole book with its program. scenario: None of the book of an architecture."""

    path: Path
    book: Book
    scenario: Scenario | None
    architectures: tuple[tuple[Architecture, Body], ...]


def load_book(path: Path | str) -> LoadedBook:
    """A book, checked file by file, and the compiled program in it.

    Raises:
        SpecError: it is no book (V432), not as it was written (V433), or the artifact is damaged.
    """
    path = Path(path)
    book = read_book(path)
    if book.kind == "architecture":
        pair = loading.load_architecture(path / book.artifact)
        return LoadedBook(path, book, None, (pair,))
    scenario = loading.load_scenario(path / book.artifact).scenario
    pairs = {r.architecture.source.file: (r.architecture, r.body) for r in scenario.robots}
    return LoadedBook(path, book, scenario, tuple(pairs.values()))


def compile_book(
    path: Path | str, progress: Progress = in_silence, *, allow_code: bool = False
) -> bytes:
    """The artifact of a book, made anew from the specs in it: the same bytes.

    Raises:
        SpecError: it is no book, or its specs are wrong.
    """
    path = Path(path)
    book = read_book(path)
    spec = path / book.spec
    if book.kind == "architecture":
        made = loading.compile_architecture_spec(spec, progress, allow_code=allow_code)
        names = sources_of(spec, made.architecture, made.body)
        architecture = renamed(made.architecture, names.name_of)
        return architecture_artifact.to_bytes(architecture, renamed(made.body, names.name_of))
    compiled = loading.compile_scenario_spec(spec, progress, allow_code=allow_code).scenario
    names = sources_of(spec, compiled)
    return scenario_artifact.to_bytes(renamed(compiled, names.name_of))
