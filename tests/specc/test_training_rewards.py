"""What decisions are worth: measures between them, in closed form."""

import numpy as np
import pytest

from runtime.code import Code
from runtime.training import How, Measure, Training
from specc.training.rewards import ended_at, measured, rewards_of

VALUES = np.array([3.0, 5.0, 4.0, 1.0, 7.0, 2.0])
DECIDED = np.array([0, 2, 5])


@pytest.mark.parametrize(
    ("how", "expected"),
    [
        (How.RISE, [1.0, -2.0]),
        (How.FALL, [-1.0, 2.0]),
        (How.LAST, [4.0, 2.0]),
        (How.MOST, [5.0, 7.0]),
        (How.LEAST, [4.0, 1.0]),
        (How.MEAN, [4.5, 10.0 / 3.0]),
    ],
)
def test_a_measure_is_of_what_came_after_a_decision_up_to_the_next(
    how: How, expected: list[float]
) -> None:
    assert measured(how, VALUES, DECIDED) == pytest.approx(expected)


def training(ends_when: Code | None = None) -> Training:
    """Worth what x rises by, minus ten times the most of y."""
    measures = (
        Measure("progress", How.RISE, Code("x"), None, ""),
        Measure("contact", How.MOST, Code("y"), None, ""),
    )
    reward = Code("progress 10.0 contact mul sub")
    return Training("r", "choose", reward, measures, ("x", "y"), ends_when, 0.9, "")


def test_a_reward_is_an_expression_of_the_measures_of_its_decision() -> None:
    rows = np.stack([VALUES, [9.0, 0.0, 0.0, 0.0, 1.0, 0.0]], axis=1)

    assert rewards_of(training(), rows, DECIDED, {}).tolist() == [1.0, -12.0]


def test_rises_add_up_to_the_whole_whatever_was_decided_when() -> None:
    chance = np.random.default_rng(0)
    values = chance.normal(size=100)
    for count in range(2, 40):
        decided = np.sort(chance.choice(100, count, replace=False))
        rises = measured(How.RISE, values, decided)
        assert rises.sum() == pytest.approx(values[decided[-1]] - values[decided[0]])


def test_an_episode_is_over_where_its_end_first_holds() -> None:
    rows = np.stack([VALUES, VALUES], axis=1)

    assert ended_at(training(Code("x 5.0 sub")), rows) == 1
    assert ended_at(training(Code("x 8.0 sub")), rows) == -1
    assert ended_at(training(), rows) == -1
