"""Recordings held against a book: each module by all that was recorded of it, together."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TypeAlias, final

from runtime.arbiter import Arbiter
from runtime.architecture import Architecture
from runtime.program import Program
from runtime.scenario import Robot, Start
from spec_schema.diagnostics import SpecError
from spec_schema.suggest import did_you_mean
from specc.book.loading import LoadedBook
from specc.faults import fault
from specc.verifying.architecture import NotJudged
from specc.verifying.book_matching import SEVERAL, spec_held
from specc.verifying.book_modules import Piece, Place, pieces_of
from specc.verifying.recording import verify_standard
from specc.verifying.runs import Unusable, distinct
from specc.verifying.spec_finding import claimed_spec
from specc.verifying.standard import Carried, Standard, carried_by
from specc.verifying.trace import Clock, Verification, verify_by
from verifier.report.examination import Depth
from verifier.report.report import SpecIdentity
from verifier.report.wording import listed
from verifier.traces.files.log import Progress

NO_MODULE = "V440"
"""The code of a recording of nothing that is in the book."""
NO_SUCH = "V444"
"""The code of a module that the book does not have."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class OfModules:
    """What one recording says, and of which modules of the book."""

    places: tuple[Place, ...]
    outcome: Verification | NotJudged


Outcome: TypeAlias = OfModules | Unusable


@final
@dataclass(frozen=True, eq=False, slots=True)
class How:
    """How recordings are held against a book.

    program_of: makes the spec that tells where in logs things stand. spec: the path of that one;
    None: what a log carries, else what the project names, else what its own names tell. only: the
    modules that are judged; None: all.
    """

    program_of: Callable[[Path], Program | Arbiter]
    spec: Path | None = None
    clock: Clock = "auto"
    allow_code: bool = False
    strict: bool = False
    depth: Depth = "reasons"
    only: frozenset[Place] | None = None

    def counts(self, place: Place) -> bool:
        """Whether a module is judged."""
        return self.only is None or place in self.only


def only_of(book: LoadedBook, names: Sequence[str] | None) -> frozenset[Place] | None:
    """The modules of these names, `NODE` or `ARCHITECTURE.NODE`, or of specs; None: all.

    Raises:
        SpecError: the book has none of a name (V444).
    """
    if names is None:
        return None
    every = {name: place for piece in _pieces(book) for name, place in _names(piece)}
    found = [
        piece.place for wanted in names for piece in _pieces(book) if wanted in dict(_names(piece))
    ]
    strange = next((name for name in names if name not in every), None)
    if strange is not None:
        there = f"modules: {', '.join(piece.place.node for piece in _pieces(book))}"
        meant = did_you_mean(strange, every)
        message = f"no module of the book is called '{strange}'"
        raise fault(NO_SUCH, book.path, message, f"{meant}\n{there}" if meant else there)
    return frozenset(found)


def _names(piece: Piece) -> Iterator[tuple[str, Place]]:
    """What a module may be called."""
    yield piece.place.node, piece.place
    yield f"{piece.place.architecture}.{piece.place.node}", piece.place
    if piece.spec is not None:
        yield piece.spec.name, piece.place


def judge_each(
    book: LoadedBook,
    traces: Sequence[Path],
    how: How,
    progress: Callable[[str, str], None] | None = None,
    reading: Progress | None = None,
) -> Iterator[Outcome]:
    """What each recording says of the modules of the book; one that can't be used stops none."""
    for trace in map(Path, distinct(traces)):
        tell = None if progress is None else partial(progress, str(trace))
        try:
            carried = carried_by(trace)
            if carried is None:
                yield from _of_log(book, trace, how, tell, reading)
            else:
                yield from _of_run(book, trace, carried, how, tell, reading)
        except SpecError as error:
            yield Unusable(str(trace), error)


def _of_run(
    book: LoadedBook,
    trace: Path,
    carried: Carried,
    how: How,
    tell: Callable[[str], None] | None,
    reading: Progress | None,
) -> Iterator[Outcome]:
    """Every node of every robot that runs an architecture of the book."""
    robots = tuple(
        Robot(robot.name, robot.body, found, Start(None), "")
        for robot in carried.robots
        if (found := _architecture_of(book, robot.architecture)) is not None
    )
    if not robots:
        raise _no_module(book, trace, [robot.architecture.name for robot in carried.robots])
    first = robots[0].architecture
    counting = _counting(robots, how)
    if counting is not None and not counting:
        return
    standard = Standard(
        robots=robots,
        requirements=(),
        only=counting,
        spec=SpecIdentity(first.name, first.source.file, first.source.sha256),
        how=f"the book {book.path}",
        beside=(book.path / first.source.file).parent,
    )
    run = verify_standard(
        trace,
        carried,
        standard,
        allow_code=how.allow_code,
        strict=how.strict,
        depth=how.depth,
        is_named=True,
        progress=tell,
        reading=reading,
    )
    names = {robot.name: robot.architecture.name for robot in robots}
    for verified in run.nodes:
        yield OfModules((_place(names, verified.part),), verified)
    for lost in run.not_judged:
        part = lost.source.removeprefix(f"{trace}: ")
        yield OfModules((_place(names, part),), lost)


def _counting(robots: Sequence[Robot], how: How) -> frozenset[str] | None:
    """The nodes that count, `robot.node`; None: all."""
    if how.only is None:
        return None
    return frozenset(
        f"{robot.name}.{node.name}"
        for robot in robots
        for node in robot.architecture.nodes
        if how.counts(Place(robot.architecture.name, node.name))
    )


def _place(architectures: dict[str, str], part: str) -> Place:
    robot, _, node = part.partition(".")
    return Place(architectures[robot], node)


def _architecture_of(book: LoadedBook, recorded: Architecture) -> Architecture | None:
    """The book's architecture of that name; else the one with most modules in common."""
    every = [architecture for architecture, _ in book.architectures]
    alike = [each for each in every if each.name == recorded.name]
    if alike:
        return alike[0]
    shared = {id(each): len(_parts(each) & _parts(recorded)) for each in every}
    best = max(every, key=lambda each: shared[id(each)])
    return best if shared[id(best)] else None


def _parts(architecture: Architecture) -> set[tuple[str, str]]:
    """Each node with the name of what it runs."""
    pieces = pieces_of(architecture)
    return {(p.place.node, p.spec.name) for p in pieces if p.spec is not None}


def _of_log(
    book: LoadedBook,
    trace: Path,
    how: How,
    tell: Callable[[str], None] | None,
    reading: Progress | None,
) -> Iterator[OfModules]:
    """A log of one behavior or arbiter: every module that runs that spec, and that counts."""
    found = claimed_spec(trace, how.spec, how.program_of) or spec_held(book, trace, _pieces(book))
    pieces = _pieces_running(book, found.program)
    if not pieces:
        raise _no_module(book, trace, [found.program.name])
    if len({_text_of(piece) for piece in pieces}) > 1:
        raise _several_specs(book, trace, pieces)
    pieces = [piece for piece in pieces if how.counts(piece.place)]
    if not pieces:
        return
    own = pieces[0].spec
    judged = _bound(own, found.program)
    verified = verify_by(
        trace,
        Path(),
        how.clock,
        lambda _: judged,
        strict=how.strict,
        depth=how.depth,
        progress=tell,
        reading=reading,
    )
    named = f"{found.how}; judged by the book {book.path}"
    made = replace(verified, found=replace(verified.found, how=named))
    yield OfModules(tuple(each.place for each in pieces), made)


def _pieces(book: LoadedBook) -> list[Piece]:
    return [piece for architecture, _ in book.architectures for piece in pieces_of(architecture)]


def _pieces_running(book: LoadedBook, spec: Program | Arbiter) -> list[Piece]:
    """The modules that run this spec; where none does to the letter, those of its name and kind."""
    alike = [
        piece
        for piece in _pieces(book)
        if type(piece.spec) is type(spec)
        and piece.spec is not None
        and piece.spec.name == spec.name
    ]
    same = [piece for piece in alike if _text_of(piece) == spec.source.sha256]
    return same or alike


def _text_of(piece: Piece) -> str:
    """What tells the spec of a module from all others."""
    assert piece.spec is not None, "code is judged by nobody"
    return piece.spec.source.sha256


def _several_specs(book: LoadedBook, trace: Path, pieces: Sequence[Piece]) -> SpecError:
    names = [f"{piece.place.architecture}.{piece.place.node}" for piece in pieces]
    assert pieces[0].spec is not None, "it has a name"
    message = f"the book has several specs '{pieces[0].spec.name}': of {listed(names)}"
    files = dict.fromkeys(str(book.path / p.spec.source.file) for p in pieces if p.spec is not None)
    remedy = f"name the one that is meant, as it stands there: --spec {' or '.join(files)}"
    return fault(SEVERAL, trace, message, remedy)


def _bound(own: Program | Arbiter | None, given: Program | Arbiter) -> Program | Arbiter:
    """The book's spec, with what the log's says of where in the log things stand."""
    bindings, condition = given.bindings, given.judge_when
    if isinstance(own, Arbiter):
        return replace(own, bindings=bindings, judge_when=condition)
    assert isinstance(own, Program), "code is judged by nobody"
    return replace(own, bindings=bindings, judge_when=condition)


def _no_module(book: LoadedBook, trace: Path, names: Sequence[str]) -> SpecError:
    there = sorted({piece.spec.name for piece in _pieces(book) if piece.spec is not None})
    message = f"this is a recording of '{names[0]}', which is no module of the book"
    return fault(NO_MODULE, trace, message, f"the book '{book.book.name}' has: {', '.join(there)}")
