"""Problems by name: what they draw, how rows are kept apart, and whose data they are."""

import csv
from collections import Counter
from pathlib import Path

import numpy as np
import pytest

from lcs.faults import LearnerError
from lcs.problems.classes import multiplexer
from lcs.problems.registry import MEANINGS, PROBLEMS, made
from lcs.problems.rewards import RIGHT, WRONG
from lcs.problems.scitos import scitos
from lcs.problems.table import Table, at_random, in_folds

ROOT = Path(__file__).parents[2]
COPY = ROOT / "specs" / "recordings" / "scitos" / "wall_following.csv"


@pytest.mark.parametrize("name", PROBLEMS)
def test_a_problem_draws_inputs_of_its_size_and_rewards_the_right_class(name: str) -> None:
    problem = made(PROBLEMS[name], {})

    x, rewards, right = problem.drawn(50, np.random.default_rng(1))

    assert x.shape == (50, problem.inputs)
    assert len(problem.described) == problem.inputs
    assert len(problem.labels) == problem.classes
    assert (rewards[np.arange(50), right] == RIGHT).all()
    assert (rewards == WRONG).sum() == 50 * (problem.classes - 1)
    fresh, classes = problem.fresh(20, np.random.default_rng(1))
    assert (fresh.shape, classes.shape) == ((20, problem.inputs), (20,))


def test_every_name_that_a_problem_is_made_with_is_explained() -> None:
    used = {name for offer in PROBLEMS.values() for name in offer.defaults}

    assert used <= MEANINGS.keys()


@pytest.mark.parametrize("share", [0.1, 0.2])
def test_a_share_of_rewards_is_flipped_and_no_test(share: float) -> None:
    problem = made(PROBLEMS["multiplexer_6"], {"flipped": share})
    x, rewards, right = problem.drawn(40_000, np.random.default_rng(1))
    wrong = rewards[np.arange(len(x)), right] == WRONG

    # Three standard deviations of a share of 40,000.
    assert wrong.mean() == pytest.approx(share, abs=3.0 * (share / 40_000) ** 0.5)
    fresh, classes = problem.fresh(1_000, np.random.default_rng(2))
    assert (classes == multiplexer(2).label(fresh)).all()


@pytest.mark.parametrize(
    ("name", "given", "said"),
    [
        ("multiplexer_6", {"flipped": 1.5}, "flipped = 1.5"),
        ("checkerboard_3x3", {"divisions": 0}, "divisions = 0"),
        ("scitos_2", {"folds": 1}, "folds = 1: write 2 parts"),
        ("scitos_2", {"tested": 5}, "tested is 1 to 4"),
        ("scitos_2", {"shuffled": 1.0}, "leaves none"),
    ],
)
def test_what_can_not_be_made_is_told(name: str, given: dict[str, float], said: str) -> None:
    with pytest.raises(LearnerError, match=said):
        made(PROBLEMS[name], given)


def test_the_arcs_of_the_robot_are_those_of_the_recording_of_four_ranges() -> None:
    with COPY.open() as file:
        rows = list(csv.DictReader(file))
    four = scitos(4)

    for i, one in enumerate(four.described):
        assert four.x[:, i].tolist() == [float(row[one.name]) for row in rows]
    assert [four.labels[i] for i in four.right] == [row["action"] for row in rows]
    assert Counter(four.right.tolist()) == {0: 2205, 1: 2097, 2: 328, 3: 826}
    assert scitos(2).x.tolist() == four.x[:, :2].tolist()


def test_three_thresholds_explain_every_row_of_the_robot() -> None:
    front, left = scitos(2).x.T
    chosen = np.where(front <= 0.9, 1, np.where(left > 0.9, 2, np.where(left < 0.4945, 3, 0)))

    assert (chosen == scitos(2).right).all()


def test_folds_are_parts_in_the_order_of_rows_and_never_learnt_from() -> None:
    table = scitos(2)
    tested = []
    for fold in (1, 2, 3, 4):
        cut = in_folds(table, 4, fold)
        assert not set(cut.learnt) & set(cut.tested)
        assert (np.diff(cut.tested) == 1).all()
        tested += cut.tested.tolist()
        x, _, right = cut.drawn(500, np.random.default_rng(0))
        assert row_set(x, right) <= row_set(table.x[cut.learnt], table.right[cut.learnt])

    assert tested == list(range(len(table.x)))
    assert in_folds(table, 4, 4).tested[0] == 4_092


def test_rows_at_random_keep_the_share_that_was_asked_for() -> None:
    cut = at_random(scitos(2), 0.25)

    assert sorted([*cut.learnt, *cut.tested]) == list(range(5_456))
    assert len(cut.tested) == 1_364
    assert (np.diff(cut.tested) > 1).any()


def row_set(x: np.ndarray, right: np.ndarray) -> set[tuple[float, ...]]:
    """The rows as a set."""
    return {(*values, label) for values, label in zip(x.tolist(), right.tolist(), strict=True)}


def test_as_many_test_rows_as_there_are_or_fewer() -> None:
    cut: Table = in_folds(scitos(2), 4, 4)

    assert len(cut.fresh(10**6, np.random.default_rng(0))[0]) == 1_364
    some, _ = cut.fresh(100, np.random.default_rng(0))
    assert len(some) == 100
