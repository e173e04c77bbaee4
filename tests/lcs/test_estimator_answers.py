"""What the classifier answers: held against the rules read one by one, with gaps and far out."""

from typing import Any

import numpy as np
import pytest

from lcs.arrays import Array
from lcs.estimator import ALCSRClassifier
from lcs.faults import LearnerError
from lcs.inputs import Input
from lcs.problems.classes import checkerboard
from lcs.rules.belief import believe
from lcs.rules.table import RuleTable

METRES = np.array([1.0, 37.3])
"""The second input is of another size, which is no power of two."""


def learnt(count: int = 500, **settings: Any) -> tuple[ALCSRClassifier, Array, Any]:
    x, _, right = checkerboard(3).drawn(count, np.random.default_rng(1))
    found = ALCSRClassifier(**{"examples": 2_000, "random_state": 3, **settings})
    return found.fit(x * METRES, right), x * METRES, right


@pytest.mark.parametrize(
    ("settings", "said"),
    [
        ({"uncovered": "nearst"}, "uncovered is 'nearst'; did you mean 'nearest'. Choices are"),
        ({"uncovered": "Refuse "}, "did you mean 'refuse'"),
        ({"missing": "ani"}, "missing is 'ani': known are 'refuse', 'any'"),
        ({"out_of_range": "clipp"}, "out_of_range is 'clipp': known are 'clip', 'refuse'"),
        ({"examples": "many"}, "examples is a whole number of 1 or more, and 'many' is none"),
        ({"inputs": ["front", "left"]}, "inputs are a list of specc.Input, and 'front' is none"),
        ({"config": 0.5}, "and 0.5 is none"),
    ],
)
def test_misspelt_choices_and_parameters_of_another_type_are_refused(
    settings: dict[str, Any], said: str
) -> None:
    with pytest.raises(LearnerError, match=said):
        learnt(**settings)


@pytest.mark.parametrize("answer", ["unknown", "nobody", "refused by hand", -1, None])
def test_an_answer_is_no_misspelt_choice(answer: object) -> None:
    learnt(20, examples=20, uncovered=answer)


def by_hand(table: RuleTable, x: Array) -> tuple[list[float], list[bool]]:
    """The probabilities of one row, read from the rules in plain Python."""
    belief: list[float] = []
    covered: list[bool] = []
    nearness: list[float] = []
    for a in range(table.actions):
        weights, shares, nearest = [], [], np.inf
        for k in np.flatnonzero(table.action == a):
            inside, squared = True, 0.0
            for i, at in enumerate(x):
                low, up = table.lower[k, i], table.upper[k, i]
                if np.isnan(at):
                    continue
                inside &= low <= at and (at < up or at == up == table.high[i])
                squared += (max(low - at, at - up, 0.0) / (table.high[i] - table.low[i])) ** 2
            share = (table.right[k] + 2) / (table.right[k] + table.wrong[k] + 3)
            is_for = table.prediction[k] > 0
            if inside:
                weights.append(table.weight[k])
                shares.append(share if is_for else 1 - share)
            if is_for:
                nearest = min(nearest, squared)
        covered.append(bool(weights))
        belief.append(float(np.average(shares, weights=weights)) if weights else 0.0)
        nearness.append(0.0 if weights else 1.0 / (np.sqrt(nearest) + 1e-12))
    left = max(1.0 - sum(belief), 0.0)
    whole = [
        b + left * n / max(sum(nearness), 1e-12) for b, n in zip(belief, nearness, strict=True)
    ]
    return [each / sum(whole) for each in whole], covered


def asked() -> Array:
    """Rows inside, at the ends and beside them, with gaps."""
    x = np.random.default_rng(5).random((120, 2)) * METRES
    x[:20, 0] = np.nan
    x[10:30, 1] = np.nan
    return x


def test_probabilities_are_those_that_the_rules_give_one_by_one() -> None:
    found, x, _ = learnt(60, missing="any", examples=120)
    rows = np.clip(asked(), x.min(axis=0), x.max(axis=0))
    table = found.rules_

    belief = believe(table, rows)
    for t, row in enumerate(rows):
        expected, covered = by_hand(table, row)
        assert belief.is_covered[t].tolist() == covered
        assert belief.probability[t] == pytest.approx(expected, rel=1e-9, abs=1e-12)
        assert found.predict_proba(rows[t : t + 1])[0] == pytest.approx(expected, rel=1e-9)
    assert 0.1 < belief.is_covered.mean() < 1.0  # both kinds of rows were there


def test_rules_in_the_numbers_of_the_user_hold_exactly_where_the_learners_do() -> None:
    found, x, _ = learnt()
    table, inner = found.rules_, found.learner_.rules()
    on_bounds = np.concatenate([table.lower, table.upper, x])
    scaled = on_bounds * (inner.high / table.high)

    covered = believe(inner, scaled).is_covered[:, found._action_of]
    assert np.array_equal(believe(table, on_bounds).is_covered, covered)
    assert np.array_equal(table.high, x.max(axis=0))


def test_the_answer_is_the_most_probable_class() -> None:
    found, x, right = learnt()

    assert np.array_equal(found.predict(x), found.predict_proba(x).argmax(axis=1))
    assert found.score(x, right) > 0.95


def test_probabilities_tell_how_often_the_answer_is_right() -> None:
    """Labels that are wrong in a fifth of rows: the classes believed are near four fifths."""
    chance = np.random.default_rng(2)
    x = chance.random((4_000, 1))
    label = (x[:, 0] > 0.5) ^ (chance.random(4_000) < 0.2)
    found = ALCSRClassifier(examples=4_000, random_state=0).fit(x, label)

    probability = found.predict_proba(chance.random((500, 1)))
    assert 0.6 < probability.max(axis=1).mean() < 0.95


def test_a_row_that_no_rule_holds_for_gets_what_was_configured() -> None:
    _, x, _ = learnt()
    far = np.array([[-5.0, 3.0], [0.5, 1e6]])
    nearest = learnt(out_of_range="as it is")[0].predict(far)
    assert set(nearest) <= {0, 1}
    assert learnt(out_of_range="as it is", uncovered=-1)[0].predict(far).tolist() == [-1, -1]
    with pytest.raises(LearnerError, match="row 0: no rule"):
        learnt(out_of_range="as it is", uncovered="refuse")[0].predict(far)
    inside = learnt(out_of_range="as it is", uncovered=-1)[0].predict(x)
    assert np.mean(inside == -1) < 0.05


def test_a_word_for_the_unknown_may_be_longer_than_the_classes_names() -> None:
    x = np.random.default_rng(0).random((50, 1))
    found = ALCSRClassifier(examples=50, uncovered="nobody knows", out_of_range="as it is")
    found.fit(x, np.where(x[:, 0] > 0.5, "hi", "lo"))

    assert found.predict([[9.0]]).tolist() == ["nobody knows"]


def test_what_is_out_of_range_is_clipped_refused_or_taken_as_it_is() -> None:
    found, x, _ = learnt()
    beyond, at_end = np.array([[0.5, 99.0]]), np.array([[0.5, x[:, 1].max()]])
    assert np.array_equal(found.predict_proba(beyond), found.predict_proba(at_end))

    with pytest.raises(LearnerError, match=r"row 0, 'x1' is 99, out of the range from 0\.\d+ to 3"):
        learnt(out_of_range="refuse")[0].predict(beyond)
    assert learnt(out_of_range="refuse")[0].predict(at_end).size == 1
    assert not learnt(out_of_range="as it is")[0]._believed(beyond).is_covered.any()


def test_a_declared_range_is_the_range() -> None:
    inputs = (Input("east", low=-1.0, high=2.0), Input("north", low=0.0, high=40.0))
    found, x, right = learnt(out_of_range="refuse", inputs=inputs)
    found.predict([[1.9, 39.0]])  # never learnt there, yet declared
    with pytest.raises(LearnerError, match=r"row 0, 'east' is 2.5, out of the range from -1 to 2"):
        found.predict([[2.5, 39.0]])
    with pytest.raises(LearnerError, match=r"row 3, 'north' is 41"):
        found.partial_fit(np.vstack([x[:3], [[0.0, 41.0]]]), right[:4])


def test_a_gap_is_refused_with_its_place_or_passed_over() -> None:
    found, x, right = learnt()
    gaps = x.copy()
    gaps[7, 1] = np.nan
    with pytest.raises(LearnerError, match=r"row 7, 'x1' is NaN.*missing='any'"):
        found.predict(gaps)
    with pytest.raises(LearnerError, match=r"row 7, 'x1' is NaN"):
        found.fit(gaps, right)
    with pytest.raises(LearnerError, match=r"row 2, 'x0' is infinite"):
        learnt(missing="any")[0].predict([[1.0, 1.0], [1.0, 1.0], [np.inf, 1.0]])


def test_rows_with_gaps_are_learnt_from() -> None:
    """The class is told by the first input; the second has gaps and means nothing."""
    chance = np.random.default_rng(4)
    x = chance.random((600, 2))
    label = x[:, 0] > 0.6
    x[chance.random(600) < 0.4, 1] = np.nan
    found = ALCSRClassifier(missing="any", examples=6_000, random_state=0).fit(x, label)

    fresh = chance.random((500, 2))
    fresh[:250, 1] = np.nan
    assert found.score(fresh, fresh[:, 0] > 0.6) > 0.95
    assert np.isfinite(found.rules_.lower).all()


def test_a_column_of_gaps_alone_tells_nothing_and_is_refused() -> None:
    with pytest.raises(LearnerError, match="column 1 is NaN in all rows"):
        ALCSRClassifier(missing="any").fit([[0.0, np.nan], [1.0, np.nan]], [0, 1])


def test_a_choice_that_is_none_is_refused_by_its_name() -> None:
    with pytest.raises(LearnerError, match=r"missing is 'maybe': known are 'refuse', 'any'"):
        learnt(missing="maybe")
    with pytest.raises(LearnerError, match=r"out_of_range is 'crop': known are 'clip', 'refuse'"):
        learnt(out_of_range="crop")
    with pytest.raises(LearnerError, match="the range of 'x', from 2 to 1, is empty"):
        ALCSRClassifier(inputs=[Input("x", low=2.0, high=1.0)]).fit([[1.0]], [0])
