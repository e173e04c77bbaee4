"""What decided at each moment, and how near it was to deciding otherwise."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from runtime.arbiter import Paradigm, Rule
from runtime.arbitration.build import arbiter_of
from runtime.arbitration.protocol import Arbiter as Deciding
from runtime.user_code import Callee
from tests.verifier.deciding.arbiter_scenes import arbiter, rule, rule_lists
from verifier.arbitration.decisions import Decisions
from verifier.deciding.margins import Margins, margins_of
from verifier.deciding.moments import Moments, moments_of

PERIOD = 0.1
READINGS = st.lists(
    st.tuples(st.floats(0, 1), st.floats(0, 1), st.floats(0, 1), st.integers(0, 2).map(float)),
    min_size=2,
    max_size=12,
)


def no_code(text: str) -> Callee:
    """Nothing that is tried here runs code."""
    raise AssertionError(text)


def choice_of(made: Deciding, reads: np.ndarray, time: float) -> int:
    """The strongest choice, -1 for none."""
    numbers = made.decide(reads, time)
    return int(np.argmax(numbers)) if numbers.max() > 0.0 else -1


def choices_after(rules: list[Rule], reads: np.ndarray) -> list[int]:
    """What the runtime's own arbiter chooses, reading one row after the other."""
    made = arbiter_of(arbiter(rules), "tried", PERIOD, no_code)
    made.reset(0)
    return [choice_of(made, row, k * PERIOD) for k, row in enumerate(reads)]


def moments(rules: list[Rule], reads: np.ndarray) -> Moments:
    made = arbiter(rules)
    times = PERIOD * np.arange(len(reads))
    chosen = np.array(choices_after(rules, reads))
    everywhere = np.ones(len(reads), dtype=np.bool_)
    return moments_of(made, Decisions(times, reads, chosen, everywhere, ()), None)


@settings(max_examples=80, deadline=None)
@given(rule_lists(latching=True), READINGS)
def test_the_choice_that_is_explained_is_what_the_arbiter_chose(
    rules: list[Rule], readings: list[tuple[float, ...]]
) -> None:
    found = moments(rules, np.array(readings))

    assert found.expected.tolist() == found.decisions.chosen.tolist()
    assert found.agrees.all()
    for place, choice in zip(found.places.tolist(), found.expected.tolist(), strict=True):
        assert choice == (-1 if place < 0 else rules[place].choice)


@settings(max_examples=30, deadline=None)
@given(rule_lists(latching=True), READINGS)
def test_the_margin_is_the_least_change_of_one_read_that_changes_the_choice(
    rules: list[Rule], readings: list[tuple[float, ...]]
) -> None:
    """Checked with the runtime's arbiter: nothing nearer changes it, a hair beyond it does."""
    reads = np.array(readings)
    found = moments(rules, reads)
    at = np.arange(len(reads))
    margins = margins_of(found, at)

    def choice_if(moment: int, place: int, value: float) -> int:
        changed = reads[: moment + 1].copy()
        changed[moment, place] = value
        return choices_after(rules, changed)[-1]

    for moment in (0, len(reads) - 1):
        for place in range(3):
            value, change = reads[moment, place], margins.change[moment, place]
            now = int(found.expected[moment])
            reach = 1.0 if np.isnan(change) else abs(change)
            for share in np.linspace(-0.999, 0.999, 9):
                inside = value + share * reach
                if 0.0 <= inside <= 1.0 and abs(share * reach) < reach - 1e-9:
                    assert choice_if(moment, place, inside) == now
            if not np.isnan(change):
                beyond = value + change + np.sign(change or 1.0) * 1e-9
                other = value + change - 1e-9
                after = {choice_if(moment, place, v) for v in (beyond, other)} - {now}
                assert margins.becomes[moment, place] in after


def bisected(choose: "object", low: float, high: float) -> float:
    """Where a choice changes between two values at which it differs."""
    assert callable(choose)
    first = choose(low)
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if choose(middle) == first else (low, middle)
    return high


def of_one(rules: list[Rule], *reads: float) -> tuple[Moments, Margins]:
    found = moments(rules, np.array([reads]))
    return found, margins_of(found, np.array([0]))


def test_a_bent_boundary_is_found_where_bisection_finds_it() -> None:
    rules = [rule(0, "ahead left hypot 0.4 lt ahead exp 2.2 gt or"), rule(1)]
    _, margins = of_one(rules, 0.6, 0.1, 0.5, 0.0)

    def choose(ahead: float) -> int:
        return choices_after(rules, np.array([[ahead, 0.1, 0.5, 0.0]]))[0]

    assert margins.change[0, 0] == pytest.approx(bisected(choose, 0.6, 1.0) - 0.6, abs=1e-12)
    assert margins.becomes[0, 0] == 0
    assert np.isnan(margins.change[0, 2])


def test_a_rule_that_goes_on_is_as_far_from_ending_as_its_until() -> None:
    rules = [rule(0, "ahead 0.2 lt", "ahead 0.5 gt"), rule(1)]
    found = moments(rules, np.array([[0.1, 0, 0, 0], [0.3, 0, 0, 0], [0.6, 0, 0, 0]]))
    margins = margins_of(found, np.arange(3))

    assert found.places.tolist() == [0, 0, 1]
    assert margins.change[:, 0] == pytest.approx([0.1, 0.2, -0.1])
    assert margins.becomes[:, 0].tolist() == [1, 1, 0]


def test_what_lasts_can_be_changed_by_nothing_that_is_read() -> None:
    rules = [rule(0, "ahead 0.2 lt", lasts=0.25), rule(1)]
    found = moments(rules, np.array([[0.1, 0, 0, 0]] + 4 * [[0.9, 0, 0, 0]]))
    margins = margins_of(found, np.arange(5))

    assert found.expected.tolist() == [0, 0, 0, 1, 1]
    assert np.isnan(margins.change[1:3, 0]).all()
    assert margins.change[3, 0] == pytest.approx(-0.7)


def test_of_a_discrete_read_the_value_is_told_that_would_change_the_choice() -> None:
    _, margins = of_one([rule(0, "lamp 2 eq"), rule(1)], 0.5, 0.5, 0.5, 0.0)

    assert margins.change[0, 3] == 2.0
    assert margins.becomes[0, 3] == 0
    assert np.isinf(margins.share[0]).all()


def test_of_weights_the_margin_is_where_another_is_as_great() -> None:
    made = arbiter([], Paradigm.WEIGHTS, ("ahead", "left", "0.2"))
    reads = np.array([[0.5, 0.3, 0.0, 0.0]])
    found = moments_of(
        made, Decisions(np.zeros(1), reads, np.array([0]), np.array([True]), ()), None
    )
    margins = margins_of(found, np.array([0]))

    assert found.expected.tolist() == [0]
    assert margins.change[0, :2] == pytest.approx([-0.2, 0.2])
