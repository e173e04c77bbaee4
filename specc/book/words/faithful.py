"""What counts as faithful, and what is known of whether a robot can do it."""

from runtime.program import Program, State
from specc.book.chapters import Block, Bullets, Paragraph, Section, Table
from specc.book.words.quantities import NOTHING, exact, span
from specc.figures.quantities import percent, seconds

LEVELS = {
    "demonstrated": "a robot has done it",
    "plausible": "a robot could do it",
    "hypothetical": "nobody knows whether a robot can",
}


def faithful_section(program: Program) -> Section:
    """Tolerances, region, and evidence."""
    return Section("What counts as faithful", (*_fidelity(program), *_feasibility(program)))


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
    titles = ("state", "tolerance", "scatter allowed beside", "to be seen in")
    blocks: list[Block] = [
        Paragraph(
            f"From any measured state the field predicts where the robot is {seconds(of.horizon)}"
            " later. It is faithful where, on average over like situations, it is there to within"
            " the tolerance. Single runs may scatter about that by chance, as much as is said"
            " beside; without a number, by no more than the noise of the sensors."
        ),
        Table(titles, rows),
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


def _region(state: State, region: dict[str, tuple[float, float]]) -> str:
    if state.name not in region:
        return "wherever it goes"
    return span(*region[state.name], state.unit)


def _feasibility(program: Program) -> list[Block]:
    of = program.feasibility
    if of is None:
        return [Bullets(("Whether a robot can do this the spec does not say.",))]
    evidence = f" Evidence: {of.evidence}." if of.evidence else ""
    return [Bullets((f"Feasibility: {of.level} ({LEVELS.get(of.level, of.level)}).{evidence}",))]
