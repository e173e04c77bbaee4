"""The runs of a procedure as a table of legs, and as rows for programs."""

import csv
import io
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Final, final

from specc.book.chapters import Table
from verifier.procedure.model import Drive, Procedure, Signal
from verifier.report.wording import exact, seconds

GOES_ON: Final = "…"
"""What a behavior moves goes where it goes."""


@final
@dataclass(frozen=True, slots=True)
class Leg:
    """A part of a run, from `begin` to `end` (s): what stands at either, by name (SI)."""

    begin: float
    end: float
    before: dict[str, float]
    after: dict[str, float]


def legs_of(procedure: Procedure, drive: Drive) -> tuple[Leg, ...]:
    """The legs of a run; where nothing is changed, one goes on."""
    moved = {each.name for each in procedure.signals if each.is_moved}
    now, time, found = dict(drive.start), 0.0, list[Leg]()
    for stage in drive.stages:
        begins = now | {n: v for n, v in stage.held.items() if n not in moved}
        ends = begins | stage.held
        end = time + stage.seconds
        last = found[-1] if found else None
        if last is not None and last.before == last.after == begins == ends:
            found[-1] = Leg(last.begin, end, begins, ends)
        else:
            found.append(Leg(time, end, begins, ends))
        now, time = ends, end
    return tuple(found)


def arranged(procedure: Procedure) -> tuple[Signal, ...]:
    """What somebody has to set or to bring about in some run, at its start at least."""
    names = {n for d in procedure.drives for n in d.start} | given(procedure)
    return tuple(each for each in procedure.signals if each.name in names)


def given(procedure: Procedure) -> set[str]:
    """What is set, or brought to values, while runs go on."""
    return {n for drive in procedure.drives for stage in drive.stages for n in stage.held}


def constant(procedure: Procedure) -> dict[str, float]:
    """The controls that have one value in all runs."""
    seen: dict[str, set[float]] = {}
    for drive in procedure.drives:
        for stage in drive.stages:
            for name, value in stage.held.items():
                seen.setdefault(name, set()).add(value)
    is_set = {each.name for each in procedure.signals if each.is_set}
    return {n: min(v) for n, v in seen.items() if len(v) == 1 and n in is_set}


def legs_table(procedure: Procedure) -> Table:
    """A row for each leg: when, and what is set, brought somewhere, or begun with."""
    still = constant(procedure)
    columns = [each for each in arranged(procedure) if each.name not in still]
    changing = given(procedure)
    rows = []
    for place, drive in enumerate(procedure.drives, 1):
        for k, leg in enumerate(legs_of(procedure, drive)):
            cells = (_cell(each, leg, k == 0, each.name in changing) for each in columns)
            rows.append((str(place) if k == 0 else "", _when(leg), *cells))
    titles = ("run", "time", *(f"`{each.name}`" for each in columns))
    return Table(titles, tuple(rows))


def _when(leg: Leg) -> str:
    return f"{leg.begin:.4g} to {seconds(leg.end)}"


def _cell(signal: Signal, leg: Leg, is_first: bool, is_given: bool) -> str:  # noqa: FBT001  a cell
    name = signal.name
    if name not in leg.before:
        return GOES_ON
    if not is_given:
        return f"starts {_value(signal, leg.before[name])}" if is_first else GOES_ON
    before, after = (_value(signal, values[name]) for values in (leg.before, leg.after))
    return after if before == after else f"{before} → {after}"


def _value(signal: Signal, value: float) -> str:
    return signal.values[round(value)] if signal.values else exact(value, signal.unit)


def as_rows(procedure: Procedure) -> bytes:
    """The same as CSV, in SI: a row where a leg begins, and one where the run ends."""
    columns = arranged(procedure)
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["run", "repeats", "time", *(each.name for each in columns)])
    for place, drive in enumerate(procedure.drives, 1):
        for time, values in _points(procedure, drive):
            told = [_plain(each, values) for each in columns]
            writer.writerow([place, drive.repeats, f"{time:.9g}", *told])
    return text.getvalue().encode()


def _points(procedure: Procedure, drive: Drive) -> Iterator[tuple[float, dict[str, float]]]:
    """Times, and what stands from each on; what is only begun with stands at the first alone."""
    legs, changing = legs_of(procedure, drive), given(procedure)
    yield 0.0, legs[0].before
    for leg, later in pairwise(legs):
        yield later.begin, {n: v for n, v in (leg.after | later.before).items() if n in changing}
    yield legs[-1].end, {n: v for n, v in legs[-1].after.items() if n in changing}


def _plain(signal: Signal, values: dict[str, float]) -> str:
    if signal.name not in values:
        return ""
    value = values[signal.name]
    return signal.values[round(value)] if signal.values else f"{value:.9g}"
