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
from specc.book.loading import LoadedBook
from specc.faults import fault
from specc.verifying.architecture import NotJudged
from specc.verifying.book_modules import Piece, Place, pieces_of
from specc.verifying.recording import verify_standard
from specc.verifying.runs import Unusable, distinct
from specc.verifying.spec_finding import find_spec
from specc.verifying.standard import Carried, Standard, carried_by
from specc.verifying.trace import Clock, Verification, verify_by
from verifier.report.examination import Depth
from verifier.report.report import SpecIdentity
from verifier.traces.files.log import Progress

NO_MODULE = "V440"
"""The code of a recording of nothing that is in the book."""


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
    None: what a log carries, else what the project names.
    """

    program_of: Callable[[Path], Program | Arbiter]
    spec: Path | None = None
    clock: Clock = "auto"
    allow_code: bool = False
    strict: bool = False
    depth: Depth = "reasons"


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
                yield _of_log(book, trace, how, tell, reading)
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
    standard = Standard(
        robots=robots,
        requirements=(),
        only=None,
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
) -> OfModules:
    """A log of one behavior or arbiter: every module that runs that spec."""
    found = find_spec(trace, how.spec, how.program_of)
    pieces = _pieces_named(book, found.program)
    if not pieces:
        raise _no_module(book, trace, [found.program.name])
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
    named = f"the book {book.path}; where things stand in the log: {found.how}"
    made = replace(verified, found=replace(verified.found, how=named))
    return OfModules(tuple(each.place for each in pieces), made)


def _pieces_named(book: LoadedBook, spec: Program | Arbiter) -> list[Piece]:
    """The modules that run a spec of that name and kind."""
    every = [piece for architecture, _ in book.architectures for piece in pieces_of(architecture)]
    return [
        piece
        for piece in every
        if type(piece.spec) is type(spec)
        and piece.spec is not None
        and piece.spec.name == spec.name
    ]


def _bound(own: Program | Arbiter | None, given: Program | Arbiter) -> Program | Arbiter:
    """The book's spec, with what the log's says of where in the log things stand."""
    bindings, condition = given.bindings, given.judge_when
    if isinstance(own, Arbiter):
        return replace(own, bindings=bindings, judge_when=condition)
    assert isinstance(own, Program), "code is judged by nobody"
    return replace(own, bindings=bindings, judge_when=condition)


def _no_module(book: LoadedBook, trace: Path, names: Sequence[str]) -> SpecError:
    every = [piece for architecture, _ in book.architectures for piece in pieces_of(architecture)]
    there = sorted({piece.spec.name for piece in every if piece.spec is not None})
    message = f"this is a recording of '{names[0]}', which is no module of the book"
    return fault(NO_MODULE, trace, message, f"the book '{book.book.name}' has: {', '.join(there)}")
