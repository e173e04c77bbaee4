"""Learning curves and populations as pictures."""

import numpy as np
from matplotlib.figure import Figure

from lcs.course import Course
from lcs.curves import Curve, curve_of
from specc.figures.learning import draw_learning
from specc.figures.learning_panels import Stated
from specc.figures.learning_population import draw_population
from specc.figures.style import rendered


def course(seed: int) -> tuple[Course, Curve]:
    """Of a learner that is right more and more often, with a rule more in each cycle."""
    chance = np.random.default_rng(seed)
    cycles = np.arange(4_000)
    kind = (chance.random(4_000) < 0.7).astype(np.int64)
    wrong = (chance.random(4_000) > cycles / 4_000).astype(np.int64)
    run = Course(kind, wrong, np.where(kind == 0, 300.0, np.nan), cycles, 2 * cycles, cycles)
    return run, curve_of(run, np.zeros(4_000, np.int64))


def said(figure: Figure) -> str:
    """All texts in the panels."""
    return "\n".join(text.get_text() for axes in figure.axes for text in axes.texts)


def test_several_runs_are_their_mean_and_what_others_state_is_marked_where_it_is_shown() -> None:
    runs = [course(seed)[1] for seed in range(3)]
    stated = [
        Stated("95 % at 1,500", (1500.0, 1500.0), (0.95, 0.95)),
        Stated("far away", (90_000.0, 90_000.0), (0.98, 0.98)),
    ]

    figure = draw_learning(runs, "three runs", stated=stated, window=50)

    assert said(figure) == "95 % at 1,500"
    performance = figure.axes[0].lines[0]
    end = [np.mean(run.right[-50:]) for run in runs]
    shortest = np.argmin([run.tries[-1] for run in runs])
    assert abs(np.asarray(performance.get_ydata())[-1] - np.mean(end)) < 1e-9
    assert np.asarray(performance.get_xdata())[-1] >= runs[shortest].tries[-1]
    assert rendered(figure, "svg").startswith(b"<?xml")


def test_births_less_deaths_are_the_rules_that_are_drawn() -> None:
    figure = draw_population([course(1)[0]], "one run")

    rules = np.asarray(figure.axes[0].lines[0].get_ydata())
    births, deaths = (np.asarray(line.get_ydata()) for line in figure.axes[1].lines)
    assert np.array_equal(rules, births - deaths)
    assert rules[-1] == 3_999.0
