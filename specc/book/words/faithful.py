"""What counts as faithful, and what is known of whether a robot can do it."""

from collections.abc import Iterator

from runtime.program import Program, State
from specc.book.chapters import Block, Bullets, Paragraph, Section, Table
from specc.book.trials import Trial
from specc.book.words.prose import prose
from specc.book.words.quantities import NOTHING, exact, span
from specc.book.words.source import words_above
from specc.figures.quantities import percent, seconds
from verifier.fidelity.switching.means import FEWEST

LEVELS = {
    "demonstrated": "a robot has done it",
    "plausible": "a robot could do it",
    "hypothetical": "nobody knows whether a robot can",
}


def faithful_section(program: Program, trial: Trial) -> Section:
    """Tolerances, region, changes of mode, and evidence."""
    blocks = (*_fidelity(program), *_changes(program, trial), *_feasibility(program))
    return Section("What counts as faithful", blocks)


def _fidelity(program: Program) -> list[Block]:
    of = program.fidelity
    if of is None:
        return [
            Paragraph(
                "The spec states no tolerances, so no recording can be judged by it: agree on them"
                " with its author before you build."
            )
        ]
    states = {state.name: state for state in program.states}
    rows = tuple(
        (
            f"`{name}`",
            exact(value, states[name].unit),
            exact(of.scatter[name], states[name].unit) if name in of.scatter else NOTHING,
            _region(states[name], of.region),
        )
        for name, value in of.tolerance.items()
    )
    titles = ("state", "tolerance", "scatter allowed beside", "recordings have to cover")
    blocks: list[Block] = [
        Paragraph(
            f"From any measured state the field predicts where the robot is {seconds(of.horizon)}"
            " later. It is faithful where, on average over like situations, it is there to within"
            " the tolerance: how situations are told apart says"
            " [how to check it](building). Single runs may scatter about that by chance, as much as"
            " is said beside; without a number, by no more than the noise of the sensors."
        ),
        Table(titles, rows),
        *map(Paragraph, words_above(program.source.text, "fidelity:")),
    ]
    if of.region:
        share = percent(of.coverage)
        blocks.append(
            Paragraph(
                f"Divided into cells, {share} of that region at least have to be gone through in"
                " recordings; with less, the verdict is INCONCLUSIVE."
            )
        )
    return blocks


def _changes(program: Program, trial: Trial) -> Iterator[Block]:
    """What is asked of changes of mode, which are judged apart."""
    if program.fidelity is None or not program.field.guards:
        return
    horizon = seconds(program.fidelity.horizon)
    first, *questions = prose("faithful_changes")
    yield Paragraph(first)
    yield Bullets(tuple(text.format(horizon=horizon, fewest=FEWEST) for text in questions))
    found = trial.procedure.rehearsal if trial.procedure is not None else None
    if found is not None and found.ways:
        rows = tuple(
            (f"`{way.source}` to `{way.target}`", seconds(way.allowed), way.basis)
            for way in found.ways
        )
        yield Table(("change", "may be late or early by", "because"), rows)


def _region(state: State, region: dict[str, tuple[float, float]]) -> str:
    if state.name not in region:
        return "any place"
    return span(*region[state.name], state.unit)


def _feasibility(program: Program) -> list[Block]:
    of = program.feasibility
    if of is None:
        return [Bullets(("Whether a robot can do this the spec does not say.",))]
    evidence = f" Evidence: {of.evidence}." if of.evidence else ""
    return [Bullets((f"Feasibility: {of.level} ({LEVELS.get(of.level, of.level)}).{evidence}",))]
