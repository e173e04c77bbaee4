"""The picture of what a learner of several steps does: its numbers, and that it draws."""

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg

from lcs.problems.steps import puddle_world
from lcs.steps.config import Config
from lcs.steps.learner import StepsLearner
from specc.figures.policy import draw_policy


def test_the_picture_shows_the_action_and_the_worth_that_the_learner_has() -> None:
    learner = StepsLearner(4, 2, Config(memories=4_000, families=2, first=500), seed=1)
    learner.run(puddle_world(), 20, np.random.default_rng(1))

    figure = draw_policy(learner, puddle_world(), np.random.default_rng(2))
    does, expects, bar = figure.axes

    centres = (np.arange(200) + 0.5) / 200  # rows of a picture are y
    places = np.array([(centres[30], centres[120]), (centres[150], centres[10])])
    actions, worth = learner.decide(places)
    shown = [np.asarray(axes.images[0].get_array()) for axes in (does, expects)]
    assert [shown[0][120, 30], shown[0][10, 150]] == actions.tolist()
    assert np.allclose([shown[1][120, 30], shown[1][10, 150]], worth.max(axis=1))
    assert len(expects.patches) == learner.bodies.first[1] + 3  # and two puddles, and the goal

    FigureCanvasAgg(figure).draw()  # type: ignore[no-untyped-call]  # matplotlib's own
    scale = [text.get_window_extent() for text in bar.get_yticklabels()]
    assert all(figure.bbox.x0 < box.x0 and box.x1 < figure.bbox.x1 for box in scale)
