"""Curves of a training show what was tried and what exploring got, and mark the best."""

import numpy as np
from matplotlib.collections import LineCollection

from specc.figures.training import Improving, draw_training

ONE = Improving(
    episodes=np.array([40, 80, 120]),
    explored=np.array([-5.0, 1.0, 2.0]),
    tried=np.array([1.0, 6.0, 4.0]),
    explored_success=np.array([0.1, 0.3, 0.4]),
    tried_success=np.array([0.4, 0.9, 0.7]),
    low=np.array([0.25, 0.76, 0.53]),
    high=np.array([0.57, 0.97, 0.83]),
    best=1,
    final=(5.0, 0.8),
    worlds=40,
)


def test_both_panels_mark_the_best_and_tell_trials_from_exploring() -> None:
    figure = draw_training(ONE, "pen")
    rewards, successes = figure.axes

    for axes, explored, tried, final in (
        (rewards, ONE.explored, ONE.tried, 5.0),
        (successes, ONE.explored_success, ONE.tried_success, 0.8),
    ):
        lines = [np.asarray(line.get_xydata()) for line in axes.lines]
        assert [len(line) for line in lines] == [3, 3, 1]
        assert (lines[0] == np.stack([ONE.episodes, explored], axis=1)).all()
        assert (lines[1] == np.stack([ONE.episodes, tried], axis=1)).all()
        assert lines[2].tolist() == [[80.0, final]]


def test_success_has_its_interval() -> None:
    _, successes = draw_training(ONE, "pen").axes
    (bars,) = (each for each in successes.collections if isinstance(each, LineCollection))

    ends = np.array(bars.get_segments())[:, :, 1]
    assert (ends == np.stack([ONE.low, ONE.high], axis=1)).all()
