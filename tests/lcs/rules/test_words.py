"""Sentences: what they say is so, and reads as one would say it."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lcs.inputs import Input
from lcs.rules.confidence import confidence
from lcs.rules.deciding import matches
from lcs.rules.digits import just_below, shortest_between, snapped
from lcs.rules.names import Names, plain_names
from lcs.rules.readable import readable
from lcs.rules.reasons import reason_for
from lcs.rules.table import RuleTable
from lcs.rules.words import conditions, in_words, outcome, shares
from tests.lcs.rules.tables import WALL, drawn_inputs, drawn_table, table_of, wall_rules

SEEDS = st.integers(0, 10_000)

BOUNDS = st.floats(-1e6, 1e6).filter(lambda value: value == 0.0 or abs(value) > 1e-9)


@given(seed=SEEDS, grid=st.sampled_from([0, 7]))
def test_rounded_bounds_hold_on_the_same_examples(seed: int, grid: int) -> None:
    table = drawn_table(seed, rules=10, grid=grid)
    inputs = drawn_inputs(np.random.default_rng(seed), 80, 2, grid)

    np.testing.assert_array_equal(matches(readable(table, inputs), inputs), matches(table, inputs))


@given(seed=SEEDS)
def test_without_examples_bounds_have_few_decimals(seed: int) -> None:
    table = drawn_table(seed, rules=10)

    short = readable(table)

    np.testing.assert_allclose(short.lower, table.lower, atol=0.5e-3)
    np.testing.assert_allclose(short.upper, table.upper, atol=0.5e-3)
    assert all(len(repr(value)) <= 5 for value in short.lower[short.lower != table.lower].tolist())


@given(seed=SEEDS, grid=st.sampled_from([0, 7]))
def test_a_sentence_holds_where_its_rule_does(seed: int, grid: int) -> None:
    table = drawn_table(seed, rules=6, grid=grid)
    inputs = drawn_inputs(np.random.default_rng(seed), 40, 2, grid)
    short, held = readable(table, inputs), matches(table, inputs)

    for rule in range(len(table)):
        stated = conditions(short, rule, plain_names(table))
        for t, (x1, x2) in enumerate(inputs.tolist()):
            is_so = all(eval(each, {}, {"x1": x1, "x2": x2}) for each in stated)  # noqa: S307
            assert is_so == held[rule, t], stated


@given(ends=st.tuples(BOUNDS, BOUNDS).filter(lambda pair: pair[0] < pair[1]), near=BOUNDS)
def test_the_shortest_number_lies_between(ends: tuple[float, float], near: float) -> None:
    low, high = ends

    found = shortest_between(low, high, near)
    bound = snapped(low, high, near)

    assert low <= found <= high
    assert low < bound <= high
    assert len(f"{abs(found):.17g}") <= 24
    digits = len(f"{found:.15e}".split("e")[0].replace(".", "").replace("-", "").rstrip("0"))
    for fewer in range(1, digits):  # no number of fewer digits lies there
        for value in (low, high):
            rounded = float(f"{value:.{fewer - 1}e}")
            assert not low <= rounded <= high or abs(found) <= abs(rounded) * 10


def test_thresholds_read_as_the_arbiter_has_them() -> None:
    said = [str(each) for each in in_words(wall_rules(), WALL)]

    assert said == [
        "when front > 0.9 m and 0.5 m <= left <= 0.9 m: forward (never tried)",
        "when front > 0.9 m and left < 0.5 m: slight right (never tried)",
        "when front <= 0.9 m: sharp right (never tried)",
        "when front > 0.9 m and left > 0.9 m: slight left (never tried)",
    ]


def colored(lower: float, upper: float, prediction: float = 1000.0) -> RuleTable:
    """One rule on an input with the values 0, 1 and 2."""
    other = -prediction if prediction in {1000.0, -1000.0} else 0.0
    table = table_of([(0, [lower], [upper], prediction), (1, [0.0], [2.0], other)], range_to=2.0)
    table.right[0], table.wrong[0] = 810, 2
    return table


@pytest.mark.parametrize(
    ("lower", "upper", "said"),
    [
        (0.0, 1.5, "when color is red or green: go (right in 810 of 812 cases)"),
        (1.0, 2.0, "when color is green or blue: go (right in 810 of 812 cases)"),
        (0.5, 1.5, "when color is green: go (right in 810 of 812 cases)"),
        (0.0, 2.0, "always: go (right in 810 of 812 cases)"),
        (1.1, 1.9, "when color is none of its values: go (right in 810 of 812 cases)"),
    ],
)
def test_discrete_inputs_are_named_by_their_values(lower: float, upper: float, said: str) -> None:
    names = Names(
        (Input("color", values=("red", "green", "blue"), is_ordered=True),), ("go", "stop")
    )

    assert said in [str(each) for each in in_words(colored(lower, upper), names)]


def test_an_input_of_yes_and_no_is_said_or_denied() -> None:
    names = Names((Input("color is red", values=("no", "yes"), is_ordered=True),), ("go", "stop"))
    table = table_of([(0, [0.5], [1.0], 1000.0), (1, [0.0], [0.5], 1000.0)], range_to=1.0)

    assert [each.when for each in in_words(table, names)] == [
        "when color is red",
        "when color is not red",
    ]


def test_the_lower_of_two_rewards_means_not() -> None:
    levels, names = np.array([-1000.0, 1000.0]), Names((Input("x"),), ("go", "stop"))
    table = colored(0.0, 1.0, prediction=-1000.0)

    assert outcome(table, 0, names, levels) == "not go"
    assert outcome(table, 0, names, np.array([-1000.0, 0.0, 1000.0])) == "go earns -1000"


def test_rules_stand_by_action_and_by_how_much_they_decide() -> None:
    table = table_of(
        [
            (1, [0.0], [1.0], -1000.0),
            (0, [0.0], [0.2], 1000.0),
            (0, [0.2], [1.0], 1000.0),
        ],
        range_to=1.0,
    )
    inputs = np.linspace(0.0, 0.99, 100)[:, None]

    assert [each.rule for each in in_words(table, plain_names(table), inputs)] == [2, 1, 0]
    np.testing.assert_allclose(shares(table, inputs), [0.0, 20.0, 80.0])


def test_a_reason_names_who_voted_with_what_share_and_what_came_next() -> None:
    table = table_of(
        [
            (0, [0.0, 0.0], [5.0, 0.5], 1000.0),
            (0, [0.0, 0.0], [1.0, 5.0], -1000.0),
            (1, [0.0, 0.0], [5.0, 5.0], -1000.0),
        ],
        range_to=5.0,
    )
    table.weight[:] = (3.0, 1.0, 1.0)
    table.right[0] = 328
    names = Names((Input("front", "m"), Input("left", "m")), ("slight left", "forward"))

    reason = reason_for(table, [0.5, 0.25], names)

    assert reason.agreed == pytest.approx(0.75)
    assert [voter.share for voter in reason.voters] == pytest.approx([0.75, 0.25])
    assert sum(voter.share for voter in reason.voters) == pytest.approx(1.0)
    assert str(reason) == (
        "slight left, with 75 % of its vote: 75 % when left < 0.5 m: slight left "
        "(right in all 328 cases, 95 % confidence: in 98.8 % or more); "
        "25 % when front < 1 m: not slight left (never tried); "
        "next: forward (-1000 expected, not 500)"
    )


def test_where_an_action_is_unknown_that_is_the_reason() -> None:
    assert str(reason_for(wall_rules(), [0.3, 0.3], WALL)) == (
        "no decision: no rule says what forward or slight right or slight left would earn here"
    )


def test_confidence_is_wilsons_interval_and_laplaces_share() -> None:
    # Newcombe (1998), table I, method 3: 81 of 263 give 0.2553 to 0.3662, 0 of 20 0 to 0.1611.
    some, none = confidence(81, 263 - 81), confidence(0, 20)

    assert (some.low, some.high) == pytest.approx((0.2553, 0.3662), abs=5e-5)
    assert (none.low, none.high) == pytest.approx((0.0, 0.1611), abs=5e-5)
    assert some.laplace == pytest.approx(82 / 265)
    assert confidence(0, 0).laplace == 0.5


def test_a_bound_right_above_a_short_number_is_known_as_such() -> None:
    assert just_below(float(np.nextafter(0.9, 1.0))) == 0.9
    assert just_below(0.9) is None
    assert just_below(1.0 / 3.0) is None


def test_bounds_at_one_number_read_alike_where_no_example_changes_sides() -> None:
    above = float(np.nextafter(0.9, 1.0))
    lower = np.array([[0.9, 0.0], [above, 0.0], [0.0, 0.0]])
    upper = np.array([[2.0, 0.5], [2.0, 2.0], [above, 2.0]])
    count = np.full(3, 2)
    table = RuleTable(
        2, np.array([0, 0, 1]), lower, upper, np.ones(3), np.ones(3), count, count,
        np.zeros(2), np.full(2, 2.0),
    )  # fmt: skip

    def said(*at_the_bound: float) -> list[str]:
        x = np.array([[0.9, y] for y in at_the_bound] + [[0.899, 0.1], [0.901, 0.1], [0.901, 1.0]])
        told = in_words(table, plain_names(table), x)
        return sorted(each.when.partition(" and ")[0] for each in told)

    # Of the examples at 0.9 the third rule holds one, so it needs "<= 0.9".
    assert said(1.0) == ["when x1 <= 0.9", "when x1 > 0.9", "when x1 > 0.9"]
    # Here the first rule holds it as well, and none can move.
    assert said(0.1) == ["when x1 <= 0.9", "when x1 > 0.9", "when x1 >= 0.9"]
