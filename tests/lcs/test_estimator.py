"""The classifier keeps scikit-learn's conventions, and laws of its own."""

import pickle
import subprocess
import sys
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sklearn.base import clone
from sklearn.datasets import load_iris
from sklearn.model_selection import StratifiedKFold, cross_val_score
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler
from sklearn.utils.estimator_checks import check_estimator

import specc
from lcs.alcsr.config import Config
from lcs.arrays import Array
from lcs.estimator import ALCSRClassifier
from lcs.faults import LearnerError
from lcs.inputs import Input
from lcs.problems.classes import checkerboard
from lcs.rules.table import RuleTable

BOARD = checkerboard(3)
UNIT = (Input("east", "m", low=0.0, high=1.0), Input("north", "m", low=0.0, high=1.0))


def board(count: int = 400, seed: int = 1) -> tuple[Array, Any]:
    x, _, right = BOARD.drawn(count, np.random.default_rng(seed))
    return x, right


def small(**settings: Any) -> ALCSRClassifier:
    return ALCSRClassifier(**{"examples": 2_000, "random_state": 3, **settings})


def assert_same_rules(one: RuleTable, other: RuleTable) -> None:
    for name in RuleTable.__slots__:
        assert np.array_equal(getattr(one, name), getattr(other, name)), name


def test_scikit_learn_finds_nothing_to_complain_about() -> None:
    found = check_estimator(ALCSRClassifier(examples=300), on_skip=None, on_fail=None)

    assert len(found) > 50
    assert not [each["check_name"] for each in found if each["status"] == "failed"]
    for each in found:  # what isn't there for the checks themselves
        if each["status"] == "skipped":
            assert any(word in str(each["exception"]) for word in ("pandas", "ARRAY_API"))


def test_flowers_that_were_not_shown_are_named() -> None:
    x, y = load_iris(return_X_y=True)
    folds = StratifiedKFold(5, shuffle=True, random_state=0)

    # A pruned tree has 0.93 to 0.95; 3 of 150 flowers lie among another species.
    scores = cross_val_score(ALCSRClassifier(examples=3_000, random_state=0), x, y, cv=folds)

    assert scores.mean() > 0.9


def test_a_checkerboard_is_learnt_from_labels() -> None:
    fresh, right = board(2_000, seed=9)
    found = ALCSRClassifier(random_state=0).fit(*board(5_000))

    assert found.score(fresh, right) > 0.97


@settings(max_examples=8, deadline=None)
@given(names=st.permutations(["anna", "bert", "carl"]))
def test_what_classes_are_called_changes_nothing(names: list[str]) -> None:
    x, _ = board(150)
    label = (3 * x[:, 0]).astype(int)
    plain = small(examples=450).fit(x, label)
    named = small(examples=450).fit(x, np.array(names)[label])

    assert named.predict(x).tolist() == np.array(names)[plain.predict(x)].tolist()
    columns = np.searchsorted(named.classes_, names)
    assert np.array_equal(named.predict_proba(x)[:, columns], plain.predict_proba(x))
    assert np.array_equal(named.rules_.lower, plain.rules_.lower)
    assert np.array_equal(named.rules_.action, columns[plain.rules_.action])


def test_a_clone_with_the_same_random_state_has_the_same_bits() -> None:
    x, y = board()
    one = small(config=Config(mutate=0.2), inputs=UNIT)
    other = clone(one).fit(x, y)

    assert_same_rules(one.fit(x, y).rules_, other.rules_)
    assert_same_rules(one.fit(x, y).rules_, other.rules_)  # nothing is left of the first time
    others = small(random_state=4).fit(x, y).rules_
    assert len(others) != len(other.rules_) or np.any(others.lower != other.rules_.lower)


def test_two_classifiers_in_one_process_do_not_disturb_each_other() -> None:
    x, y = board()
    alone = small().partial_fit(x, y, classes=[0, 1])
    one, other = small(), small(random_state=8)
    for rows in np.array_split(np.arange(len(x)), 7):
        one.partial_fit(x[rows], y[rows], classes=[0, 1])
        other.fit(x[rows], y[rows])
        one.predict(x)

    # The ranges of the first piece scale the inputs by the same powers of two here.
    assert_same_rules(one.rules_, alone.rules_)


@settings(max_examples=8, deadline=None)
@given(cuts=st.lists(st.integers(1, 299), max_size=5, unique=True))
def test_rows_in_pieces_are_rows_in_one_where_ranges_are_declared(cuts: list[int]) -> None:
    x, y = board(300)
    whole = small(inputs=UNIT).partial_fit(x, y, classes=[0, 1])
    pieces = small(inputs=UNIT)
    for rows in np.split(np.arange(300), sorted(cuts)):
        pieces.partial_fit(x[rows], y[rows], classes=[1, 0])
        pieces = pickle.loads(pickle.dumps(pieces))  # noqa: S301  our own

    assert_same_rules(pieces.rules_, whole.rules_)
    assert np.array_equal(pieces.predict_proba(x), whole.predict_proba(x))


@pytest.mark.parametrize("power", [-40, -3, 9, 200])
def test_units_change_nothing_but_the_bounds(power: int) -> None:
    x, y = board()
    factor = np.array([1.0, 2.0**power])
    plain, scaled = small().fit(x, y), small().fit(x * factor, y)

    assert np.array_equal(plain.predict_proba(x), scaled.predict_proba(x * factor))
    assert np.array_equal(plain.rules_.upper * factor, scaled.rules_.upper)


def test_a_pipeline_and_text_labels_go_through() -> None:
    x, y = board()
    names = np.array(["black", "white"])[y]
    found = make_pipeline(StandardScaler(), small()).fit(x, names)

    assert set(found.predict(x)) == {"black", "white"}
    assert np.allclose(found.predict_proba(x).sum(axis=1), 1.0)


def test_a_class_that_no_row_of_a_piece_has_may_come_later() -> None:
    x, y = board()
    found = small(inputs=UNIT).partial_fit(x[y == 1], y[y == 1], classes=[0, 1])
    assert set(found.predict(x)) == {1}

    found.partial_fit(x[y == 0], y[y == 0]).partial_fit(x, y)
    assert set(found.predict(x)) == {0, 1}


def test_what_classes_may_be_is_said_first_and_once() -> None:
    x, y = board()
    with pytest.raises(LearnerError, match="needs classes="):
        small().partial_fit(x, y)
    begun = small().partial_fit(x, y, classes=[0, 1])
    with pytest.raises(LearnerError, match=r"classes are \[0, 1\] since"):
        begun.partial_fit(x, y, classes=[0, 1, 2])
    with pytest.raises(LearnerError, match="row 2: class 7 is unknown"):
        begun.partial_fit(x[:3], [0, 1, 7])


def test_the_classifier_is_a_name_of_the_house_that_says_what_it_needs() -> None:
    assert specc.ALCSRClassifier is ALCSRClassifier
    program = "import sys; sys.modules['sklearn'] = None; import specc; specc.ALCSRClassifier"
    ended = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=False
    )

    assert "specc.ALCSRClassifier needs scikit-learn: pip install 'specc[sklearn]'" in ended.stderr
