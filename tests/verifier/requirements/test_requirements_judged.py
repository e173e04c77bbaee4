"""Requirements on runs: closed forms, laws, what a short run leaves open, and what decides."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import ArrayLike

from runtime.program import Unit
from runtime.requirement import Formula, Operator, Requirement
from tests.verifier.requirements.test_robustness_laws import (
    FORMULAS,
    LENGTH,
    SAMPLES,
    bounds,
    predicate,
    sampled,
    windowed,
)
from verifier.report.requirement_results import Outcome, RequirementResult
from verifier.requirements.judge import judge_requirements
from verifier.requirements.signals import Signal
from verifier.requirements.sliding import clamped_backwards, range_maxima

ALWAYS, EVENTUALLY, UNTIL = Operator.ALWAYS, Operator.EVENTUALLY, Operator.UNTIL
NOT = Formula(Operator.NOT, None, 0.0, None)


def judged(
    formula: tuple[Formula, ...],
    signals: dict[str, Signal],
    unit: str = "m",
    scale: float = 1.0,
) -> RequirementResult:
    """One requirement on a run."""
    requirement = Requirement("as written", formula, tuple(signals), unit, scale, "spec.yaml:1:1")
    units = {name: Unit(unit, scale) for name in signals}
    return judge_requirements([requirement], signals, None, units)[0]


def one(times: ArrayLike, values: ArrayLike, **how: float) -> dict[str, Signal]:
    """A run of one quantity."""
    return {"x": Signal("x", np.array(times, float), np.array(values, float), **how)}


def test_always_in_a_window_is_the_least_margin_in_it() -> None:
    times = np.arange(0.0, 10.0, 0.1)
    found = judged((predicate("x"), windowed(ALWAYS, 0, 5)), one(times, np.sin(times)))

    assert found.outcome is Outcome.VIOLATED
    assert found.robustness == pytest.approx(np.sin(4.7))
    assert found.witness.time == pytest.approx(4.7)
    assert found.witness.values["x"] == pytest.approx(np.sin(4.7))


def test_a_window_that_ends_between_samples_takes_the_value_there() -> None:
    found = judged((predicate("x"), windowed(EVENTUALLY, 0, 2.5)), one([0, 1, 2, 3], [0, 0, 0, 4]))

    assert found.robustness == pytest.approx(2.0)
    assert found.witness.time == pytest.approx(2.5)


def test_a_response_that_always_comes_within_its_time_is_found_between_samples() -> None:
    # Donze, Maler (2010): the robustness of a nested window is least at no sample, but where the
    # falling and the rising edge of the course are in balance.
    x = one([0, 2, 4, 6], [3, 0, 4, 4])
    found = judged((predicate("x"), windowed(EVENTUALLY, 0, 1), windowed(ALWAYS, 0, 4)), x)

    # y(t) = max(x(t), x(t + 1)): 3 - 1.5 t meets 2 (t + 1 - 2) at t = 5 / 3.5.
    assert found.robustness == pytest.approx(3 - 1.5 * 5 / 3.5)


def test_a_magnitude_that_passes_zero_between_samples_is_seen() -> None:
    x = one([0, 1], [-1, 2])
    found = judged((predicate("0.1 x abs sub"), windowed(EVENTUALLY, 0, None)), x)

    assert found.robustness == pytest.approx(0.1)
    assert found.witness.time == pytest.approx(1 / 3)


def test_until_may_be_reached_at_the_very_jump_that_ends_what_was_held() -> None:
    # rtamt 0.4.10 says -0.5 here (its issue 210).
    x = one([0, 0.5, 2], [0, 1, 1], is_held=True)
    formula = (predicate("0.5 x sub"), predicate("x 0.5 sub"), windowed(UNTIL, 0, 1))

    assert judged(formula, x).robustness == pytest.approx(0.5)


def test_quantities_keep_their_own_times() -> None:
    signals = one([0, 1, 2], [1, 1, 1]) | {
        "y": Signal("y", np.array([0.0, 0.25, 2.0]), np.array([0.0, -3.0, 0.0]))
    }
    found = judged((predicate("x y add"), windowed(ALWAYS, 0, 1)), signals)

    assert found.robustness == pytest.approx(-2.0)
    assert found.witness.values == pytest.approx({"x": 1.0, "y": -3.0})


def test_robustness_and_sentence_are_in_the_users_unit() -> None:
    x = one([0, 1, 2], [0.05, 0.02, 0.05])
    found = judged((predicate("x 0.03 sub"), windowed(ALWAYS, 0, None)), x, unit="cm", scale=0.01)

    assert found.sentence == "violated by 1 cm at 1 s, where x is 2 cm"


def test_a_run_that_is_too_short_leaves_open_what_its_windows_would_have_shown() -> None:
    x = one(np.arange(0.0, 11.0), np.full(11, 0.2))
    found = judged((predicate("x 1 sub"), windowed(EVENTUALLY, 0, 60)), x)

    assert found.outcome is Outcome.OPEN
    assert (found.low, found.high) == (pytest.approx(-0.8), math.inf)
    assert "windows reach 60 s ahead" in found.sentence


def test_what_is_decided_early_needs_no_whole_window() -> None:
    x = one([0, 1, 2], [0, -1, 2])

    assert judged((predicate("x"), windowed(ALWAYS, 0, 60)), x).outcome is Outcome.VIOLATED
    assert judged((predicate("x"), windowed(EVENTUALLY, 0, 60)), x).outcome is Outcome.SATISFIED


def test_a_response_is_not_demanded_where_its_window_leaves_the_run() -> None:
    x = one(np.arange(0.0, 11.0), [0, 1, 0, 1, 0, 1, 0, 1, 0, 0, 0])
    within = windowed(EVENTUALLY, 0, 3)
    found = judged((predicate("x 1 sub"), within, windowed(ALWAYS, 0, None)), x)

    assert found.outcome is Outcome.SATISFIED


def test_a_gap_in_a_recording_is_not_bridged() -> None:
    times = np.concatenate([np.arange(0.0, 5.0, 0.1), np.arange(50.0, 55.0, 0.1)])
    found = judged((predicate("x"), windowed(ALWAYS, 0, None)), one(times, np.ones(times.size)))

    assert found.outcome is Outcome.OPEN
    assert "was not measured" in found.sentence


def test_a_quantity_that_wraps_does_not_pass_through_all_values() -> None:
    heading = one([0, 1, 2], [3.0, -3.0, -2.9], period=2 * math.pi, low=-math.pi)
    found = judged((predicate("x abs 2 sub"), windowed(ALWAYS, 0, None)), heading)

    assert found.outcome is Outcome.SATISFIED


@settings(max_examples=30, deadline=None)
@given(FORMULAS, SAMPLES, SAMPLES, st.booleans(), st.integers(0, 3), st.integers(0, 4))
def test_what_is_not_eventually_is_always_not(
    formula: tuple[Formula, ...],
    x: list[int],
    y: list[int],
    is_held: bool,  # noqa: FBT001  drawn
    first: int,
    more: int,
) -> None:
    signals = sampled(x, y, is_held=is_held)
    for last in (first + more, None):
        never = bounds((*formula, windowed(EVENTUALLY, first, last), NOT), signals, LENGTH)
        always_not = bounds((*formula, NOT, windowed(ALWAYS, first, last)), signals, LENGTH)

        assert never == pytest.approx(always_not)


@settings(max_examples=40, deadline=None)
@given(FORMULAS, SAMPLES, SAMPLES, st.integers(0, 2))
def test_bounds_hold_what_a_longer_run_shows(
    formula: tuple[Formula, ...], x: list[int], y: list[int], cut: int
) -> None:
    """Where no part speaks of the rest of the run, which is another thing in a longer run."""
    if any(part.last is None and part.operator in (ALWAYS, EVENTUALLY, UNTIL) for part in formula):
        return
    long = sampled(x, y, is_held=False)
    short = {
        n: Signal(n, s.times[: LENGTH + 1 - cut], s.values[: LENGTH + 1 - cut])
        for n, s in long.items()
    }
    low, high = bounds(formula, short, LENGTH - cut)
    later_low, later_high = bounds(formula, long, LENGTH)

    assert low <= later_low + 1e-9
    assert later_high <= high + 1e-9


@settings(max_examples=40, deadline=None)
@given(SAMPLES, SAMPLES, st.integers(0, 2), st.integers(0, 3), st.integers(1, 3))
def test_more_room_makes_eventually_no_less_and_always_no_more(
    x: list[int], y: list[int], first: int, width: int, more: int
) -> None:
    signals = sampled(x, y, is_held=False)

    def robust(operator: Operator, last: float) -> float:
        return bounds((predicate("x"), windowed(operator, first, last)), signals, LENGTH + 10)[0]

    assert robust(EVENTUALLY, first + width) <= robust(EVENTUALLY, first + width + more) + 1e-12
    assert robust(ALWAYS, first + width) >= robust(ALWAYS, first + width + more) - 1e-12


@settings(max_examples=80, deadline=None)
@given(FORMULAS, SAMPLES, SAMPLES, st.booleans())
def test_the_instant_that_decides_has_the_margin_that_the_formula_has(
    formula: tuple[Formula, ...],
    x: list[int],
    y: list[int],
    is_held: bool,  # noqa: FBT001  drawn
) -> None:
    found = judged(formula, sampled(x, y, is_held=is_held))
    decides = found.high if found.outcome is not Outcome.SATISFIED else found.low
    if found.witness is None or is_held or math.isinf(decides):
        return  # a held one may decide just before it jumps
    margins = {abs(v) for v in found.witness.values.values()}
    near = {abs(1 - v) for v in found.witness.values.values()}
    far = {abs(v - 2) for v in found.witness.values.values()}

    assert min(abs(abs(decides) - m) for m in margins | near | far) < 1e-6


@given(st.lists(st.floats(-9, 9), min_size=1, max_size=40), st.data())
def test_maxima_of_ranges_are_those_of_slices(values: list[float], data: st.DataObject) -> None:
    n = len(values)
    first = data.draw(st.lists(st.integers(0, n), min_size=1, max_size=9))
    stop = [data.draw(st.integers(0, n)) for _ in first]
    expected = [max(values[a:b], default=-99.0) for a, b in zip(first, stop, strict=True)]

    found = range_maxima(np.array(values), np.array(first), np.array(stop), -99.0)

    assert found.tolist() == expected


@given(st.lists(st.tuples(st.floats(-9, 9), st.floats(0, 9)), max_size=30), st.floats(-9, 9))
def test_clamps_compose_backwards(clamps: list[tuple[float, float]], last: float) -> None:
    low = np.array([a for a, _ in clamps])
    high = np.array([a + b for a, b in clamps])
    expected = [last]
    for a, b in zip(low[::-1], high[::-1], strict=True):
        expected.insert(0, max(a, min(b, expected[0])))

    assert clamped_backwards(low, high, last) == pytest.approx(expected)
