from dataclasses import replace
from types import ModuleType

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from verifier.fidelity.shooting.noise import averaged, plain_noise, quantum_of
from verifier.fidelity.verify import verify
from verifier.report.report import Noise

TIMES = np.arange(0.0, 60.0, 0.05)


def wave(seed: int) -> np.ndarray:
    rng = np.random.default_rng(seed)
    return np.sin(0.7 * TIMES + rng.uniform(0.0, 6.0)) + 0.1 * TIMES


@pytest.mark.parametrize("sigma", [0.003, 0.03])
@pytest.mark.parametrize("seed", range(3))
def test_white_noise_is_found_to_fifteen_per_cent(seed: int, sigma: float) -> None:
    rng = np.random.default_rng(seed)

    noise = plain_noise(TIMES, wave(seed) + sigma * rng.standard_normal(len(TIMES)), 0.0)

    assert noise.sigma == pytest.approx(sigma, rel=0.15)
    assert abs(noise.correlation) < 0.35


def test_uneven_sampling_does_not_change_the_noise() -> None:
    rng = np.random.default_rng(4)
    times = np.cumsum(rng.uniform(0.02, 0.08, 1200))
    values = np.sin(0.7 * times) + 0.01 * rng.standard_normal(1200)

    assert plain_noise(times, values, 0.0).sigma == pytest.approx(0.01, rel=0.15)


def test_a_few_outliers_hardly_count() -> None:
    rng = np.random.default_rng(4)
    values = wave(4) + 0.01 * rng.standard_normal(len(TIMES))
    values[::200] += 3.0

    assert plain_noise(TIMES, values, 0.0).sigma == pytest.approx(0.01, rel=0.3)


def test_a_wrong_spec_does_not_count_as_noise(scenes: ModuleType) -> None:
    report = verify(scenes.van_der_pol("1.3"), scenes.van_der_pol_drive(2, 60.0, 0.01))

    assert [v.noise.sigma for v in report.variables] == pytest.approx([0.01, 0.01], rel=0.2)


def test_noise_is_found_where_the_samples_are_too_sparse_for_differences(
    scenes: ModuleType,
) -> None:
    # Two samples a second of a motion with a period of 6.7 s: only the model explains its curve.
    drive = scenes.van_der_pol_drive(5, 600.0, 0.01)
    sparse = {
        n: replace(s, times=s.times[::10], values=s.values[::10]) for n, s in drive.series.items()
    }
    x = sparse["x"]

    report = verify(scenes.van_der_pol(), replace(drive, series=sparse))

    assert plain_noise(x.times, x.values, 0.0).sigma > 0.03
    # The noise of v leaks into the predicted x: variance 1 + 0.5^2 / 2 / 1.5, that is 4 % more.
    assert report.variables[0].noise.sigma == pytest.approx(0.0104, rel=0.1)


@given(st.floats(1e-4, 1e3), st.floats(-1e3, 1e3))
@settings(max_examples=20, deadline=None)
def test_noise_has_the_unit_of_its_variable(scale: float, offset: float) -> None:
    rng = np.random.default_rng(1)
    values = wave(1) + 0.02 * rng.standard_normal(len(TIMES))

    plain = plain_noise(TIMES, values, 0.0).sigma
    scaled = plain_noise(TIMES, scale * values + offset, 0.0).sigma

    assert scaled == pytest.approx(scale * plain, rel=1e-4)


@pytest.mark.parametrize("quantum", [0.01, 0.2])
def test_a_quantised_sensor_has_at_least_the_noise_of_its_rounding(quantum: float) -> None:
    values = quantum * np.round(np.sin(0.2 * TIMES) / quantum)

    noise = plain_noise(TIMES, values, 0.0)

    assert noise.quantum == pytest.approx(quantum)
    assert noise.sigma >= quantum / np.sqrt(12.0)


def test_values_that_are_all_different_are_not_quantised() -> None:
    assert quantum_of(wave(1)) == 0.0
    assert quantum_of(np.zeros(50)) == 0.0


def test_noise_that_alternates_is_not_taken_for_white() -> None:
    rng = np.random.default_rng(2)
    drive, p = rng.standard_normal(len(TIMES) + 50), -0.6
    noise = np.zeros(len(drive))
    for k in range(1, len(drive)):
        noise[k] = p * noise[k - 1] + 0.01 * drive[k]
    truth = 0.01 / np.sqrt(1.0 - p**2)
    # Third differences blow alternating noise up; a model is not needed to see it.
    found = plain_noise(TIMES, 0.1 * TIMES + noise[50:], 0.0)

    assert found.sigma < 2.0 * truth


@pytest.mark.parametrize("p", [-0.8, -0.3, 0.0])
def test_averaged_noise_follows_the_sum_over_its_covariance(p: float) -> None:
    noise = Noise(2.0, 10**12, p, 0.0, "")
    lags = np.abs(np.subtract.outer(np.arange(5), np.arange(5)))

    assert averaged(noise, np.array([5])) == pytest.approx(4.0 * np.mean(p**lags), rel=1e-4)


def test_positive_correlation_is_not_used_to_remove_more() -> None:
    noise = Noise(2.0, 1000, 0.9, 0.0, "")

    assert averaged(noise, np.array([4.0])) == pytest.approx([1.0])


def test_the_noise_removed_is_the_noise_that_is_there(scenes: ModuleType) -> None:
    # Under the right spec all of the error is noise.
    ratios = []
    for seed in range(12):
        report = verify(scenes.unicycle(), scenes.unicycle_drive(seed, 60.0, 0.01))
        ratios += [v.declared.departure / v.declared.rmse for v in report.variables]

    # Removed, what remains is scattered about zero: half of it is floored.
    assert np.median(ratios) < 0.35
    assert np.mean(np.array(ratios) == 0.0) > 0.2


def test_the_noise_of_a_spec_with_less_data_is_said(scenes: ModuleType) -> None:
    drive = scenes.van_der_pol_drive(1, 60.0, 0.01)
    few = {n: replace(s, times=s.times[:8], values=s.values[:8]) for n, s in drive.series.items()}
    spec = scenes.van_der_pol()
    short = replace(spec, fidelity=replace(spec.fidelity, horizon=0.1))

    report = verify(short, replace(drive, series=few))

    assert report.variables[0].noise.method == "too few samples to tell"
