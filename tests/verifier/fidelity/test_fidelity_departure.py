import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from verifier.fidelity.judging.departure import (
    blocks_of,
    correlation_time,
    departure_of,
    mean_of,
    standing_of,
)
from verifier.report.report import Interval, Standing

errors = hnp.arrays(float, st.integers(8, 60), elements=st.floats(-10.0, 10.0))


def overlapping(rng: np.random.Generator, windows: int) -> np.ndarray:
    """Errors of windows that overlap by half, of variance 1."""
    steps = rng.standard_normal(windows + 1)
    return (steps[1:] + steps[:-1]) / np.sqrt(2.0)


@pytest.mark.parametrize("windows", [12, 24, 60])
def test_the_interval_holds_the_truth(windows: int) -> None:
    rng = np.random.default_rng(windows)
    below = above = 0
    for _ in range(400):
        e = overlapping(rng, windows)
        found = departure_of(e, e, np.zeros(windows), 0.0).interval
        below += found.high < 1.0
        above += found.low > 1.0

    # Nominally 2.5 % on either side; few blocks of skew squares cost some of it, and 400 runs have
    # a standard error of 1 %. Percentiles of resampled blocks would miss in 15 to 25 %.
    assert below / 400 < 0.085
    assert above / 400 < 0.05


def test_the_noise_share_is_removed() -> None:
    rng = np.random.default_rng(1)
    e = 0.3 * np.sin(np.arange(400)) + 0.5 * rng.standard_normal(400)

    found = departure_of(e, e, np.full(400, 0.25), 0.02)

    assert found.rmse == pytest.approx(np.sqrt(0.045 + 0.25), rel=0.1)
    assert found.interval.low < np.sqrt(0.045) < found.interval.high
    assert found.departure < 0.6 * found.rmse


def test_doubt_about_the_noise_widens_the_interval() -> None:
    e = overlapping(np.random.default_rng(2), 100)

    sure = departure_of(e, e, np.full(100, 0.5), 0.0).interval
    unsure = departure_of(e, e, np.full(100, 0.5), 0.3).interval

    assert unsure.low < sure.low
    assert unsure.high > sure.high


@given(errors, st.floats(1e-3, 1e3))
def test_departures_have_the_unit_of_their_variable(e: np.ndarray, scale: float) -> None:
    one = departure_of(e, e, np.full(len(e), 0.01), 0.1)
    other = departure_of(scale * e, scale * e, np.full(len(e), 0.01 * scale**2), 0.1)

    assert other.departure == pytest.approx(scale * one.departure, rel=1e-6, abs=1e-9 * scale)
    assert other.interval.high == pytest.approx(scale * one.interval.high, rel=1e-6)


@given(errors)
def test_the_interval_holds_the_departure(e: np.ndarray) -> None:
    found = departure_of(e, e, np.full(len(e), 0.01), 0.1)

    assert 0.0 <= found.interval.low <= found.departure <= found.interval.high


def test_one_block_of_windows_decides_nothing() -> None:
    e = np.zeros(5)

    found = departure_of(e, e, np.zeros(5), 0.0)

    assert standing_of(found.interval, 1.0) is Standing.UNDECIDED


def test_slowly_varying_errors_make_long_blocks() -> None:
    slow = np.sin(np.arange(200) / 15.0) ** 2

    assert correlation_time(slow) > 10.0
    assert blocks_of(slow)[-1] < blocks_of(np.random.default_rng(1).standard_normal(200))[-1]


@given(errors)
def test_blocks_are_runs_of_at_least_two_horizons(e: np.ndarray) -> None:
    blocks = blocks_of(e**2)

    sizes = np.bincount(blocks)
    assert np.all(np.diff(blocks) >= 0)
    assert np.all(sizes >= 4)


def test_a_mean_has_the_error_of_its_blocks() -> None:
    blocks = np.repeat(np.arange(5), 4)
    values = np.repeat([1.0, 2.0, 3.0, 4.0, 5.0], 4)

    mean, interval = mean_of(values, blocks)

    # Five independent values: 3 +- t(4) * 1.58 / sqrt(5), Student's t(4) at 97.5 % is 2.776.
    assert mean == 3.0
    assert interval.high - mean == pytest.approx(2.776 * np.sqrt(2.5 / 5.0), rel=1e-3)


def test_standings() -> None:
    assert standing_of(Interval(0.1, 0.2), 0.2) is Standing.WITHIN
    assert standing_of(Interval(0.1, 0.2), 0.15) is Standing.UNDECIDED
    assert standing_of(Interval(0.1, 0.2), 0.05) is Standing.EXCEEDED
