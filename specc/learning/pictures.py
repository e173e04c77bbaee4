"""The figures of an experiment: how it learnt, how its population fared, and the rules."""

from collections.abc import Iterator

from lcs.arrays import Array
from lcs.curves import curve_of
from lcs.rules.compaction import Compacted
from specc.figures.learning import draw_learning
from specc.figures.learning_population import draw_population
from specc.figures.palettes import PALETTES
from specc.figures.rules_plane import DOTS, draw_rules, slice_through
from specc.figures.rules_sheet import draw_rule_sheet
from specc.figures.style import Picture, rendered
from specc.figures.style_names import Style
from specc.learning.folder import CURVES, POPULATION, run_name
from specc.learning.learning import Learnt
from specc.learning.running import Run, fresh
from specc.learning.thinning import names_of


def pictures(learnt: Learnt, style: Style) -> Iterator[tuple[str, bytes]]:
    """The name and the bytes of each figure."""
    for name, drawn in _drawn(learnt, style):
        yield name, rendered(drawn, "svg", PALETTES[style])


def count_of(learnt: Learnt) -> int:
    """How many figures there are, at most."""
    return 2 + len(learnt.runs) * (2 if learnt.problem.inputs == 2 else 1)


def _drawn(learnt: Learnt, style: Style) -> Iterator[tuple[str, Picture]]:
    title, about = learnt.problem.name, [_about(learnt)]
    courses = [run.so_far() for run in learnt.runs]
    curves = [curve_of(*each) for each in courses]
    if all(len(curve.tries) for curve in curves):
        yield CURVES, draw_learning(curves, title, about=about, style=style)
    population = [course for course, _ in courses]
    yield POPULATION, draw_population(population, title, about=about, style=style)
    for run, seen, compacted in zip(learnt.runs, learnt.seen, learnt.compacted, strict=True):
        if len(compacted.table):
            yield from _of_rules(learnt, run, seen.inputs, compacted, style)


def _of_rules(
    learnt: Learnt, run: Run, inputs: Array, compacted: Compacted, style: Style
) -> Iterator[tuple[str, Picture]]:
    """The rules of a run: as a sheet, and where there are two inputs, as areas."""
    problem, table, names = learnt.problem, compacted.table, names_of(learnt.problem)
    folder, title = run_name(run.seed), f"{problem.name}, rules"
    became = f"{compacted.rules_before:,} rules became {len(table):,} by compaction"
    about = [f"{_about(learnt)[:-1]}, seed {run.seed}: {became}."]
    sheet = draw_rule_sheet(table, names, title, about=about, examples=inputs, style=style)
    yield f"{folder}/rules.svg", sheet
    is_plane = problem.inputs == 2 and bool((table.low < table.high).all())
    if is_plane:
        x, y = (each.name for each in problem.described)
        plane, dots = slice_through(table, names, x, y, {}), fresh(problem, run.seed, DOTS)
        areas = draw_rules(table, names, plane, title, about=about, examples=dots, style=style)
        yield f"{folder}/areas.svg", areas


def _about(learnt: Learnt) -> str:
    experiment = learnt.experiment
    runs = "one run" if len(learnt.runs) == 1 else f"{len(learnt.runs)} runs"
    given = {**experiment.given, **experiment.settings}
    told = "".join(f", {name} = {value}" for name, value in given.items())
    return f"By {experiment.learner}, {runs} of {experiment.cycles:,} cycles{told}."
