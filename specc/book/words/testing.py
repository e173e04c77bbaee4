"""The test procedure of a module, on its page."""

from collections.abc import Iterator

from runtime.program import Program
from specc.book.chapters import Block, Bullets, Paragraph, Section, Table
from specc.book.formulas import plain, written
from specc.book.trials import Trial
from specc.book.words.legs import GOES_ON, constant, given, legs_table
from specc.book.words.source import conditions_of
from verifier.procedure.bench_model import BenchTest
from verifier.procedure.bench_wording import how_sentence
from verifier.procedure.bench_wording import rehearsal_sentences as bench_rehearsal
from verifier.procedure.model import Procedure
from verifier.procedure.wording import log_sentence, rehearsal_sentences
from verifier.report.wording import exact, listed, number, often, seconds

TITLE = "Test procedure"
WORTH = "a faithful robot passes by them, and one that is off by two tolerances fails"
"""Smaller faults may stay open: then the verifier asks for more of the same."""


def procedure_section(program: Program, trial: Trial, file: str) -> Section:
    """Which runs to drive, what to log, and what a rehearsal of them showed."""
    procedure = trial.procedure
    blocks = _procedure(program, procedure, file) if procedure else _without(trial)
    return Section(TITLE, tuple(blocks))


def bench_section(trial: Trial) -> Section:
    """Which readings to show an arbiter, and what it is to choose."""
    test = trial.bench
    return Section(TITLE, tuple(_bench(test)) if test else _without(trial))


def _without(trial: Trial) -> tuple[Block, ...]:
    return (Paragraph(f"There is none: {trial.without}."),)


def _procedure(program: Program, procedure: Procedure, file: str) -> Iterator[Block]:
    if not procedure.drives:
        yield Paragraph(f"There is none: {procedure.remarks[0]}.")
        return
    found = procedure.rehearsal
    decides = found is not None and found.decides
    worth = WORTH if decides else "but see below what they leave open"
    yield Paragraph(f"{_how_often(procedure)}: {worth}. {_held(procedure)}")
    yield legs_table(procedure)
    of_rows = "a value holds from its row on, and the last row of a run is its end"
    yield Paragraph(f"For programs: [{file}]({file}), in SI; {of_rows}.", is_small=True)
    yield Bullets(tuple(_how_to(program, procedure)))
    yield Paragraph(_sentence(log_sentence(procedure)))
    yield Bullets(tuple(map(_sentence, (*rehearsal_sentences(procedure), *procedure.remarks))))
    if procedure.excited:
        yield from _excited(procedure)


def _how_often(procedure: Procedure) -> str:
    """How many recordings, of how long."""
    count, repeats = len(procedure.drives), procedure.drives[0].repeats
    runs = "this run" if count == 1 else f"each of these {count} runs"
    many = count * repeats
    recordings = "1 recording" if many == 1 else f"{many} recordings"
    return f"Drive {runs} {often(repeats)}: {recordings}, {seconds(procedure.seconds)} in all"


def _held(procedure: Procedure) -> str:
    """How a run goes, and what is the same in all of them."""
    units = {each.name: each.unit for each in procedure.signals}
    still = [f"`{n}` at {exact(v, units[n])}" for n, v in constant(procedure).items()]
    told = "A run is one motion through all its legs, without a stop."
    return f"{told} Hold {listed(still)} throughout." if still else told


def _how_to(program: Program, procedure: Procedure) -> Iterator[str]:
    """How a run is brought about: where it starts, what may be fed in, how a mode is entered."""
    changing = given(procedure)
    told = any(GOES_ON in row for row in legs_table(procedure).rows)
    goes_on = f" In the table {GOES_ON} is: as the behavior moves it." if told else ""
    yield (
        "A start need not be met exactly, since what was measured counts: where the surroundings"
        " do not allow it, take the nearest that they do. Begin to log once the robot moves: what"
        f" it waits for its first command counts as late.{goes_on}"
    )
    moved = [f"`{s.name}`" for s in procedure.signals if s.is_moved and s.name in changing]
    if moved:
        yield (
            f"{listed(moved)}: readings may be fed to the behavior in place of its sensors'; log"
            " what it was given. An arrow: brought there evenly."
        )
    other = [s.name for s in procedure.signals if s.is_moved and s.name not in changing]
    if other:
        yield (
            f"{listed([f'`{n}`' for n in other])}: as it comes about while the robot moves; it"
            " may be fed in, too."
        )
    real = [f"`{name}`" for name in program.field.driven if name != program.field.mode]
    yield (
        f"{listed(real)}: never fed in, but measured, since this is what is judged. A simulator"
        " may stand in for the robot, if it is as late."
    )
    mode = next((s for s in program.states if s.name == program.field.mode), None)
    if mode is not None:
        yield (
            f"`{mode.name}` is a mode: set it before the run begins, or feed in readings by which"
            f" it is entered: {listed(_entries(program, mode.values))}. Log it at each tick as it"
            " is then; what the behavior does follows its response time later."
        )


def _entries(program: Program, values: tuple[str, ...]) -> list[str]:
    """By what each mode is entered, way by way."""
    found = []
    for guard in program.field.guards:
        own = conditions_of(program, values[guard.mode])
        ways = [each for each in program.field.guards if each.mode == guard.mode]
        place = ways.index(guard)
        when = plain(own[place]) if place < len(own) else f"{written(guard.condition)} ≥ 0"
        found.append(f"`{values[guard.target]}` from `{values[guard.mode]}` by `{when}`")
    return found


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
        "What these runs tell of each input: by how many tolerances it moves what is judged within"
        " the horizon, from the lowest to the highest value that they give it. Below 1 a fault"
        " in it does not show.",
        is_small=True,
    )
    yield Table(("input", "from", "to", "tolerances"), rows, numbers=(1, 2, 3))


def _bench(test: BenchTest) -> Iterator[Block]:
    yield Paragraph(
        f"{_sentence(how_sentence(test))} They stand on either side of changes of choice, and where"
        " single rules matter; its controls keep their defaults. Choices that it remembers depend"
        " on what was shown before."
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
