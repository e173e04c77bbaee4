"""Which module of a book a log is of, where nobody says: the one whose names it holds."""

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final, final

from runtime.arbiter import Arbiter
from runtime.program import Program
from spec_schema.diagnostics import SpecError
from specc.book.loading import LoadedBook
from specc.faults import fault
from specc.verifying.book_modules import Piece
from specc.verifying.spec_finding import Found, project_text
from verifier.arbitration.reader import reader_of
from verifier.report.wording import listed
from verifier.traces.bindings import resolve, wanted_by
from verifier.traces.faults import nearest_help
from verifier.traces.files.log import LogFile, Sheet, Wanted
from verifier.traces.files.open_log import open_log

NOT_HELD: Final = "V442"
"""The code of a log that holds no module's names."""
SEVERAL: Final = "V443"
"""The code of a log that may be of several modules."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Fit:
    """How a log fits a module's spec: which of its names stand there, and which do not.

    lacking: states, readings and the choice, without which nothing can be judged.
    """

    piece: Piece
    spec: Program | Arbiter
    held: frozenset[str]
    lacking: tuple[str, ...]


def spec_held(book: LoadedBook, trace: Path, pieces: Sequence[Piece]) -> Found[Program | Arbiter]:
    """The spec all of whose states, or readings and choice, stand in a log under their own names.

    Of several that one counts after which the log is called, else the one whose names, those of
    controls too, hold all of the others'.

    Raises:
        SpecError: none does (V442), or several do alike (V443); or the log can't be read.
    """
    specs = {piece.spec.source.sha256: piece for piece in pieces if piece.spec is not None}
    log = open_log(trace, _names_only(list(specs.values())))
    fits = [_fit(piece, log) for piece in specs.values()]
    whole = [fit for fit in fits if not fit.lacking]
    if not whole:
        raise _held_by_none(book, trace, fits, log)
    chosen = whole if len(whole) == 1 else _called(trace, whole) or _largest(whole)
    if len(chosen) > 1:
        raise _held_by_several(book, trace, chosen)
    fit = chosen[0]
    where = "columns" if isinstance(log, Sheet) else "topics"
    return Found(
        fit.spec, f"its {where} are those of {fit.spec.name}: {', '.join(sorted(fit.held))}"
    )


def _names_only(pieces: Sequence[Piece]) -> Wanted:
    """What has to be looked at to see which names a log holds."""
    programs = [_program(piece.spec) for piece in pieces if piece.spec is not None]
    paths = {
        topic: found
        for program in programs
        for topic, found in (wanted_by(program).paths or {}).items()
    }
    return Wanted(paths, frozenset(), 0)


def _program(spec: Program | Arbiter) -> Program:
    return reader_of(spec) if isinstance(spec, Arbiter) else spec


def _fit(piece: Piece, log: LogFile) -> _Fit:
    """By where the spec says that things stand, if it says so and they do; else by its names."""
    spec = piece.spec
    assert spec is not None, "code is judged by nobody"
    stated = _held(spec, log)
    if stated is None and spec.bindings:
        spec = _by_names(spec)
        stated = _held(spec, log)
    wanted = tuple(state.name for state in _program(spec).states)
    if stated is None:
        stated = {name for name in wanted if isinstance(log, Sheet) and name in log.columns}
    return _Fit(piece, spec, frozenset(stated), tuple(n for n in wanted if n not in stated))


def _held(spec: Program | Arbiter, log: LogFile) -> set[str] | None:
    """The names that a log holds; None where it lacks what the spec says stands there."""
    program = _program(spec)
    try:
        names = {bound.binding.name for bound in resolve(program, log)}
    except SpecError:
        return None
    return names | {each.name for each in program.bindings if each.constant is not None}


def _by_names(spec: Program | Arbiter) -> Program | Arbiter:
    """The spec without what it says of another log: `judge_when` stays if it reads no signal."""
    signals = {binding.name for binding in spec.bindings} - set(spec.register)
    reads_signals = spec.judge_when is not None and bool(signals & set(spec.judge_when.tokens))
    condition = None if reads_signals else spec.judge_when
    if isinstance(spec, Arbiter):
        return replace(spec, bindings=(), judge_when=condition)
    return replace(spec, bindings=(), judge_when=condition)


def _called(trace: Path, fits: Sequence[_Fit]) -> list[_Fit]:
    """Those whose name, or whose module's, is a word of the file's name; the longest such name."""

    def length(fit: _Fit) -> int:
        names = (fit.spec.name, fit.piece.place.node)
        return max((len(name) for name in names if _is_in(name, trace.stem)), default=0)

    longest = max(map(length, fits))
    return [fit for fit in fits if longest and length(fit) == longest]


def _is_in(name: str, text: str) -> bool:
    return re.search(rf"(?<![a-z]){re.escape(name)}(?![a-z])", text.lower()) is not None


def _largest(fits: Sequence[_Fit]) -> list[_Fit]:
    """The one whose names hold those of all others; else all."""
    return [
        fit for fit in fits if all(fit.held > other.held for other in fits if other is not fit)
    ] or list(fits)


def _held_by_none(book: LoadedBook, trace: Path, fits: Sequence[_Fit], log: LogFile) -> SpecError:
    nearest = min(fits, key=lambda fit: len(fit.lacking) / (len(fit.lacking) + len(fit.held)))
    is_sheet = isinstance(log, Sheet)
    there = tuple(log.columns) if isinstance(log, Sheet) else log.topics
    entries = ", ".join(
        f"{name}: {'COLUMN' if is_sheet else '/TOPIC.FIELD'}" for name in nearest.lacking
    )
    spec = book.path / nearest.spec.source.file
    message = (
        f"no spec is attached to this log, no specc.yaml names one, and it holds the names of no"
        f" module of the book; of {nearest.spec.name}, the nearest, {listed(list(nearest.lacking))}"
        f" {'is' if len(nearest.lacking) == 1 else 'are'} missing"
    )
    remedy = (
        f"call its {'columns' if is_sheet else 'topics and fields'} as the book's page on building"
        f" says; or copy {spec}, add `trace: {{{entries}}}` to it, and name it with --spec\n"
        f"{nearest_help('', there, 'columns' if is_sheet else 'topics')}"
    )
    return fault(NOT_HELD, trace, message, remedy)


def _held_by_several(book: LoadedBook, trace: Path, fits: Sequence[_Fit]) -> SpecError:
    names = [fit.spec.name for fit in fits]
    told = [f"{fit.spec.name} ({fit.spec.source.file})" for fit in fits]
    files = [str(book.path / fit.spec.source.file) for fit in fits]
    message = (
        f"this log may be of several modules of the book: it holds the names of {listed(told)}"
    )
    remedy = (
        f"put the module's name into the file's, as in {names[0]}_1{trace.suffix}; name its spec"
        f" with --spec; or write a specc.yaml in this folder, with the spec that is meant:\n"
        f"{project_text(trace, files, files[0])}"
    )
    return fault(SEVERAL, trace, message, remedy)
