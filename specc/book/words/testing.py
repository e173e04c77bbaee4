"""The test procedure of a module, on its page."""

from collections.abc import Iterator

from specc.book.chapters import Block, Bullets, Paragraph, Section, Table
from specc.book.contents import Shown
from verifier.procedure.bench_model import BenchTest
from verifier.procedure.bench_wording import how_sentence
from verifier.procedure.bench_wording import rehearsal_sentences as bench_rehearsal
from verifier.procedure.model import Procedure
from verifier.procedure.wording import (
    drive_phrase,
    log_sentence,
    rehearsal_sentences,
)
from verifier.report.wording import exact, number, seconds

TITLE = "Test procedure"


def procedure_section(shown: Shown) -> Section:
    """Which runs to drive, what to log, and what a rehearsal of them showed."""
    procedure = shown.trial.procedure
    return Section(TITLE, tuple(_procedure(procedure)) if procedure else _without(shown))


def bench_section(shown: Shown) -> Section:
    """Which readings to show an arbiter, and what it is to choose."""
    test = shown.trial.bench
    return Section(TITLE, tuple(_bench(test)) if test else _without(shown))


def _without(shown: Shown) -> tuple[Block, ...]:
    return (Paragraph(f"There is none: {shown.trial.without}."),)


def _procedure(procedure: Procedure) -> Iterator[Block]:
    if not procedure.drives:
        yield Paragraph(f"There is none: {procedure.remarks[0]}.")
        return
    found, count = procedure.rehearsal, len(procedure.drives)
    runs = "this run" if count == 1 else f"these {count} runs"
    decides = found is not None and found.decides
    worth = "the verifier can decide by them" if decides else "but see below what they leave open"
    yield Paragraph(
        f"Record {runs}, {seconds(procedure.seconds)} in all: {worth}. A starting place need not be"
        " met exactly, since what was measured counts; where the surroundings do not allow one,"
        " take the nearest that they do. Each run may be a recording of its own."
    )
    yield Bullets(
        tuple(_sentence(drive_phrase(procedure, drive)) for drive in procedure.drives),
        is_ordered=True,
    )
    yield Paragraph(_sentence(log_sentence(procedure)))
    yield Bullets(tuple(map(_sentence, rehearsal_sentences(procedure))))
    if procedure.excited:
        yield from _excited(procedure)
    if procedure.remarks:
        yield Bullets(tuple(map(_sentence, procedure.remarks)))


def _excited(procedure: Procedure) -> Iterator[Block]:
    """By how much each input shows in these runs."""
    units = {each.name: each.unit for each in procedure.signals}
    rows = tuple(
        (
            f"`{each.name}`",
            exact(each.low, units[each.name]),
            exact(each.high, units[each.name]),
            number(each.effect),
        )
        for each in procedure.excited
    )
    yield Paragraph(
        "What is set or sensed has to show in what is judged. By how many tolerances it moves that"
        " within the horizon, from one end of what these runs hold it at to the other:",
        is_small=True,
    )
    yield Table(("input", "from", "to", "tolerances"), rows, numbers=(1, 2, 3))


def _bench(test: BenchTest) -> Iterator[Block]:
    yield Paragraph(
        f"{_sentence(how_sentence(test))} They stand on either side of each change of choice; its"
        " controls keep their defaults. Choices that it remembers depend on what was shown before."
    )
    titles = ("", *(f"`{each.name}`" for each in test.readings), "it chooses")
    rows = tuple(
        (
            str(place),
            *(
                r.values[round(each.values[r.name])]
                if r.values
                else exact(each.values[r.name], r.unit)
                for r in test.readings
            ),
            f"`{each.chosen}`",
        )
        for place, each in enumerate(test.shown, 1)
    )
    yield Table(titles, rows)
    yield Bullets(tuple(map(_sentence, bench_rehearsal(test))))


def _sentence(text: str) -> str:
    """A phrase with a capital and a full stop."""
    return f"{text[0].upper()}{text[1:]}."
