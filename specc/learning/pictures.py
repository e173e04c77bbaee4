"""The figures of an experiment: how it learnt, how its population fared, and the rules."""

from collections.abc import Iterator

from lcs.arrays import Array
from lcs.curves import curve_of
from lcs.problems.steps import Plane
from lcs.rules.compaction import Compacted
from lcs.steps.learner import LONGEST
from specc.figures.episodes import Walk, draw_episodes
from specc.figures.learning import draw_learning
from specc.figures.learning_population import draw_population
from specc.figures.palettes import PALETTES
from specc.figures.policy import draw_policy
from specc.figures.rules_plane import DOTS, draw_rules, slice_through
from specc.figures.rules_sheet import draw_rule_sheet
from specc.figures.style import Picture, rendered
from specc.figures.style_names import Style
from specc.learning.drawing import followed, fresh
from specc.learning.experiment import usual
from specc.learning.folder import CURVES, POPULATION, run_name
from specc.learning.learners import called
from specc.learning.learning import AnyRun, Learnt
from specc.learning.thinning import names_of


def pictures(learnt: Learnt, style: Style) -> Iterator[tuple[str, bytes]]:
    """The name and the bytes of each figure."""
    for name, drawn in _drawn(learnt, style):
        yield name, rendered(drawn, "svg", PALETTES[style])


def count_of(learnt: Learnt) -> int:
    """How many figures there are, at most."""
    if isinstance(learnt.problem, Plane):
        return 1 + 2 * len(learnt.runs)
    return 2 + len(learnt.runs) * (2 if learnt.problem.inputs == 2 else 1)


def _drawn(learnt: Learnt, style: Style) -> Iterator[tuple[str, Picture]]:
    if isinstance(learnt.problem, Plane):
        yield from _of_world(learnt, learnt.problem, style)
    else:
        yield from _of_courses(learnt, style)
    for run, outcome in zip(learnt.runs, learnt.outcomes, strict=True):
        if len(outcome.compacted.table):
            yield from _of_rules(learnt, run, outcome.seen.inputs, outcome.compacted, style)


def _of_courses(learnt: Learnt, style: Style) -> Iterator[tuple[str, Picture]]:
    """How well it answered, and how its population fared."""
    title, about = learnt.problem.name, [_about(learnt)]
    answered = [run.so_far() for run in learnt.runs]
    curves = [curve_of(each.course, each.right) for each in answered]
    if all(len(curve.tries) for curve in curves):
        yield CURVES, draw_learning(curves, title, about=about, style=style)
    population = [each.course for each in answered]
    yield POPULATION, draw_population(population, title, about=about, style=style)


def _of_world(learnt: Learnt, world: Plane, style: Style) -> Iterator[tuple[str, Picture]]:
    """How its best actions fared beside the optimum, and what they are."""
    walks = []
    for run, outcome in zip(learnt.runs, learnt.outcomes, strict=True):
        walked, came = run.so_far(), outcome.summary
        best = walked.best_steps, walked.best_returns
        tried = walked.steps, walked.returns, walked.boxes
        walks.append(Walk(*best, *tried, came.optimal_steps, came.optimal_returns))
    tested = (
        f"The best actions are followed from {learnt.experiment.tests:,} starts, the same each "
        f"time, for {LONGEST} steps at most; nothing is learnt by that."
    )
    yield CURVES, draw_episodes(walks, world.name, about=[_about(learnt), tested], style=style)
    for run in learnt.runs:
        picture = draw_policy(run.learner, world, followed(run.seed), style=style)
        yield f"{run_name(run.seed)}/policy.svg", picture


def _of_rules(
    learnt: Learnt, run: AnyRun, inputs: Array, compacted: Compacted, style: Style
) -> Iterator[tuple[str, Picture]]:
    """The rules of a run: as a sheet, and where there are two inputs, as areas."""
    problem, table, names = learnt.problem, compacted.table, names_of(learnt.problem)
    folder, title = run_name(run.seed), f"{problem.name}, rules"
    became = f"{compacted.rules_before:,} rules became {len(table):,} by compaction"
    about = [f"{_about(learnt)[:-1]}, seed {run.seed}: {became}."]
    sheet = draw_rule_sheet(table, names, title, about=about, examples=inputs, style=style)
    yield f"{folder}/rules.svg", sheet
    if isinstance(problem, Plane):  # which has a picture of its own
        return
    if problem.inputs == 2 and bool((table.low < table.high).all()):
        x, y = (each.name for each in problem.described)
        plane, dots = slice_through(table, names, x, y, {}), fresh(problem, run.seed, DOTS)
        areas = draw_rules(table, names, plane, title, about=about, examples=dots, style=style)
        yield f"{folder}/areas.svg", areas


def _about(learnt: Learnt) -> str:
    experiment = learnt.experiment
    runs = "one run" if len(learnt.runs) == 1 else f"{len(learnt.runs)} runs"
    given = {**experiment.given, **experiment.settings}
    told = "".join(f", {name} = {value}" for name, value in given.items())
    unit = usual(experiment.problem).unit
    return f"By {called(experiment.learner)}, {runs} of {experiment.cycles:,} {unit}s{told}."
