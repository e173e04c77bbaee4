"""What rules decide, held against a plain loop and against the learner that they are from."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lcs.alcsr.learner import ALCSR
from lcs.faults import LearnerError
from lcs.problems.classes import checkerboard
from lcs.rules.deciding import decide, matches
from tests.lcs.rules.tables import drawn_inputs, drawn_table, holds

SEEDS = st.integers(0, 10_000)


@given(seed=SEEDS, grid=st.sampled_from([0, 4]))
def test_votes_are_those_of_a_plain_loop(seed: int, grid: int) -> None:
    table = drawn_table(seed, rules=12, actions=3, grid=grid)
    inputs = drawn_inputs(np.random.default_rng(seed + 1), 9, 2, grid)

    said = decide(table, inputs)

    held = matches(table, inputs)
    for t, x in enumerate(inputs):
        expected = []
        for action in range(3):
            voters = [r for r in range(12) if table.action[r] == action and holds(table, r, x)]
            assert voters == [r for r in np.flatnonzero(held[:, t]) if table.action[r] == action]
            assert said.voters[t, action] == len(voters)
            weight = sum(table.weight[r] for r in voters)
            votes = sum(table.weight[r] * table.prediction[r] for r in voters)
            expected.append(votes / weight if voters else np.nan)
        np.testing.assert_allclose(said.expected[t], expected, rtol=1e-12)  # order of sums
        is_known = not np.isnan(expected).any()
        assert said.best[t] == (np.argmax(said.expected[t]) if is_known else -1)


def test_blocks_of_inputs_make_no_difference() -> None:
    table = drawn_table(3, rules=30)
    inputs = drawn_inputs(np.random.default_rng(4), 9_000, 2, 0)

    whole, last = decide(table, inputs), decide(table, inputs[-500:])

    np.testing.assert_array_equal(whole.best[-500:], last.best)
    np.testing.assert_array_equal(whole.expected[-500:], last.expected)


def test_rules_decide_as_the_learner_that_found_them() -> None:
    problem, chance = checkerboard(3), np.random.default_rng(7)
    learner = ALCSR(2, 2, seed=7)
    inputs, rewards, _ = problem.drawn(3_000, chance)
    learner.run(inputs, rewards)
    asked = problem.drawn(2_000, chance)[0]

    best, expected = learner.decide(asked)
    said = decide(learner.rules(), asked)

    known = best >= 0
    assert 0.5 < known.mean() < 1.0  # both cases are there
    np.testing.assert_array_equal(said.best < 0, ~known)
    np.testing.assert_allclose(said.expected[known], expected[known], rtol=1e-9, atol=1e-6)
    is_tie = np.abs(expected[:, 0] - expected[:, 1]) < 1e-6
    np.testing.assert_array_equal(said.best[known & ~is_tie], best[known & ~is_tie])


@pytest.mark.parametrize("inputs", [[0.5, 0.5], [[0.5]], [[0.5, np.nan]]])
def test_inputs_of_another_size_or_without_a_value_are_refused(inputs: list[float]) -> None:
    with pytest.raises(LearnerError):
        decide(drawn_table(0, rules=3), inputs)
