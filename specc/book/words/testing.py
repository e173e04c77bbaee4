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
    excited_sentences,
    log_sentence,
    rehearsal_sentences,
)
from verifier.report.wording import exact, seconds

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
    yield Paragraph(
        f"Record these {len(procedure.drives)} runs, {seconds(procedure.seconds)} in all: the"
        " verifier can decide about them. A starting place need not be met exactly, since what was"
        " measured counts; where the surroundings allow one not at all, take the nearest that they"
        " do. Each run may be a recording of its own."
    )
    yield Bullets(
        tuple(_sentence(drive_phrase(procedure, drive)) for drive in procedure.drives),
        is_ordered=True,
    )
    yield Paragraph(_sentence(log_sentence(procedure)))
    yield Bullets(tuple(map(_sentence, rehearsal_sentences(procedure))))
    told = (*excited_sentences(procedure), *procedure.remarks)
    if told:
        yield Bullets(tuple(map(_sentence, told)))


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
