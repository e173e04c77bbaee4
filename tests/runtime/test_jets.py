"""Bounds of code over boxes: every value and every slope between two points lies within them."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from runtime.arrays import Array
from runtime.code import ARITY, Code
from runtime.intervals import Interval, exactly
from runtime.jet_machine import OPERATIONS, run_over_boxes
from runtime.jets import SURE, Jet
from runtime.machine import evaluate

NAMES = ("x", "y", "z")
ROUNDING = 1e-12  # of the machine, beside the size of what it computes

LARGE = 1e150  # the machine overflows beyond, real numbers do not

places = st.floats(-4.0, 4.0) | st.integers(-4, 4).map(float)
sizes = st.sampled_from([0.0, 1e-12, 1e-3, 0.1, 1.0, 3.0])


def box_jets(low: Array, high: Array) -> dict[str, Jet]:
    """One box (n,) of the first n names."""
    n = len(low)
    return {
        name: Jet(
            Interval(low[j : j + 1], high[j : j + 1]),
            exactly(np.eye(n)[:, j : j + 1]),
            SURE,
        )
        for j, name in enumerate(NAMES[:n])
    }


def bounds(text: str, low: Array, high: Array) -> Jet:
    (jet,) = run_over_boxes([Code(text)], box_jets(low, high))
    return jet


def inside(low: Array, high: Array, rng: np.random.Generator) -> Array:
    """Points of the box (k, n), its corners among them."""
    n = len(low)
    corners = np.stack(np.meshgrid(*[[0.0, 1.0]] * n, indexing="ij"), axis=-1).reshape(-1, n)
    share = np.concatenate([corners, rng.random((40, n))])
    return np.clip(low + share * (high - low), low, high)


def check(text: str, low: Array, high: Array, rng: np.random.Generator) -> None:
    jet = bounds(text, low, high)
    points = inside(low, high, rng)
    values = evaluate([Code(text)], NAMES[: len(low)], points)[..., 0]
    known = np.abs(values) < LARGE
    first, last = float(np.ravel(jet.value.low)[0]), float(np.ravel(jet.value.high)[0])
    slack = ROUNDING * (1.0 + np.abs(values[known]))
    assert not np.isnan(first) or not known.any()
    assert np.all(values[known] >= first - slack)
    assert np.all(values[known] <= last + slack)
    if np.all(jet.sure) and jet.slopes is not None:
        check_slopes(jet.slopes, points[known], values[known])


def check_slopes(slopes: Interval, points: Array, values: Array) -> None:
    """The mean value theorem between every two points."""
    low, high = (
        np.broadcast_to(end, (points.shape[1], 1))[:, 0] for end in (slopes.low, slopes.high)
    )
    assert not np.any(np.isnan(low) | np.isnan(high))
    step = points[:, None] - points
    with np.errstate(invalid="ignore"):
        ends = np.where(step == 0.0, 0.0, low * step), np.where(step == 0.0, 0.0, high * step)
    rise = values[:, None] - values
    slack = ROUNDING * (1.0 + np.abs(values[:, None]) + np.abs(values))
    assert np.all(rise >= np.minimum(*ends).sum(axis=-1) - slack)
    assert np.all(rise <= np.maximum(*ends).sum(axis=-1) + slack)


@pytest.mark.parametrize("operation", sorted(ARITY))
@given(data=st.data())
@settings(max_examples=30, deadline=None)
def test_every_operation_is_bounded(operation: str, data: st.DataObject) -> None:
    n = ARITY[operation]
    low = np.array(data.draw(st.tuples(*[places] * n)))
    high = low + np.array(data.draw(st.tuples(*[sizes] * n)))

    check(" ".join([*NAMES[:n], operation]), low, high, np.random.default_rng(1))


TREES = st.recursive(
    st.sampled_from(["x", "y", "0.5", "2", "-1.25"]),
    lambda part: st.one_of(
        st.tuples(part, st.sampled_from(sorted(o for o in ARITY if ARITY[o] == 1))).map(" ".join),
        st.tuples(part, part, st.sampled_from(sorted(o for o in ARITY if ARITY[o] == 2))).map(
            " ".join
        ),
        st.tuples(part, part, part, st.sampled_from(["where", "clip"])).map(" ".join),
    ),
    max_leaves=6,
)


@given(text=TREES, at=st.tuples(places, places), size=st.tuples(sizes, sizes))
@settings(max_examples=300, deadline=None)
def test_operations_inside_one_another_are_bounded(
    text: str, at: tuple[float, float], size: tuple[float, float]
) -> None:
    low = np.array(at)
    with np.errstate(all="ignore"):
        check(text, low, low + np.array(size), np.random.default_rng(2))


def test_every_operation_of_the_machine_has_its_bounds() -> None:
    assert set(OPERATIONS) == set(ARITY)


def test_a_sum_that_is_no_double_lies_strictly_within_its_bounds() -> None:
    # 0.1 + 0.2, of the doubles nearest to them, is no double.
    jet = bounds("x y add", np.array([0.1, 0.2]), np.array([0.1, 0.2]))

    assert jet.value.low[0] < 0.1 + 0.2 <= jet.value.high[0]


def test_nothing_times_anything_is_nothing() -> None:
    jet = bounds("0 1 x div mul", np.array([-1.0]), np.array([1.0]))

    assert (float(jet.value.low[0]), float(jet.value.high[0])) == (0.0, 0.0)


def test_bounds_of_a_small_box_are_close() -> None:
    jet = bounds("x sin x mul x exp add", np.array([0.7]), np.array([0.7 + 1e-8]))

    assert jet.value.high[0] - jet.value.low[0] < 1e-7
    slope = math.sin(0.7) + 0.7 * math.cos(0.7) + math.exp(0.7)
    assert jet.slopes is not None
    assert jet.slopes.low[0, 0] == pytest.approx(slope, abs=1e-6)
    assert jet.slopes.high[0, 0] == pytest.approx(slope, abs=1e-6)


def test_a_jump_has_any_slope_and_a_kink_those_of_both_sides() -> None:
    jump = bounds("x sign", np.array([-1.0]), np.array([1.0]))
    kink = bounds("x abs", np.array([-1.0]), np.array([2.0]))

    assert jump.slopes is not None
    assert kink.slopes is not None
    assert (jump.slopes.low[0, 0], jump.slopes.high[0, 0]) == (-math.inf, math.inf)
    assert (kink.slopes.low[0, 0], kink.slopes.high[0, 0]) == pytest.approx((-1.0, 1.0))


def test_a_root_of_what_is_negative_is_nowhere() -> None:
    assert np.isnan(bounds("x sqrt", np.array([-2.0]), np.array([-1.0])).value.low[0])
    assert not np.all(bounds("x sqrt", np.array([-2.0]), np.array([1.0])).sure)
