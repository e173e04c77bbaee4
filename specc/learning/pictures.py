"""The figures of an experiment: how it learnt, and how its population fared."""

from collections.abc import Iterator

from lcs.curves import curve_of
from specc.figures.learning import draw_learning
from specc.figures.learning_population import draw_population
from specc.figures.palettes import PALETTES
from specc.figures.style import rendered
from specc.figures.style_names import Style
from specc.learning.learning import Learnt


def pictures(learnt: Learnt, style: Style) -> Iterator[tuple[str, bytes]]:
    """The name and the bytes of each figure."""
    title, about = _title(learnt)
    courses = [run.so_far() for run in learnt.runs]
    curves = [curve_of(*each) for each in courses]
    if all(len(curve.tries) for curve in curves):
        drawn = draw_learning(curves, title, about=about, style=style)
        yield "learning.svg", rendered(drawn, "svg", PALETTES[style])
    population = [course for course, _ in courses]
    drawn = draw_population(population, title, about=about, style=style)
    yield "population.svg", rendered(drawn, "svg", PALETTES[style])


def _title(learnt: Learnt) -> tuple[str, list[str]]:
    experiment = learnt.experiment
    runs = "one run" if len(learnt.runs) == 1 else f"{len(learnt.runs)} runs"
    given = {**experiment.given, **experiment.settings}
    told = "".join(f", {name} = {value}" for name, value in given.items())
    about = f"Learner {experiment.learner}, {runs} of {experiment.cycles:,} cycles{told}."
    return learnt.problem.name, [about]
