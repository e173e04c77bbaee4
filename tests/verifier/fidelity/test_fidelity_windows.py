from types import ModuleType

import numpy as np
import pytest

from verifier.fidelity.shooting.grid import flow_grid
from verifier.fidelity.shooting.samples import nearest, samples_of, turned
from verifier.fidelity.shooting.windows import chosen_samples, windows_of
from verifier.fidelity.stretches.needs import needs_of
from verifier.fidelity.stretches.spans import spans_of


def test_windows_stay_in_their_stretch_and_start_every_half_horizon(scenes: ModuleType) -> None:
    needs = needs_of(scenes.van_der_pol(), scenes.van_der_pol_drive(1, 60.0, 0.0))
    grid = flow_grid(needs, 0.1)
    samples = samples_of(needs, grid, 0.0)
    spans = spans_of([(3.0, 5.0), (10.0, 21.3), (40.0, 41.9)])

    windows = windows_of(samples, needs.base, spans, 2.0)

    assert np.all(windows.times >= windows.stretch[:, 0] - 1e-9)
    assert np.all(windows.times + 2.0 <= windows.stretch[:, 1] + 1e-9)
    assert windows.times[0] == pytest.approx(3.0)
    assert np.diff(windows.times[1:]) == pytest.approx(np.ones(len(windows.times) - 2))
    for each in samples:
        for after in (0.0, 2.0):
            chosen = chosen_samples(each, windows, after)
            times = each.times[chosen.index]
            inside = (times >= windows.stretch[:, :1] - 1e-6) & (
                times <= windows.stretch[:, 1:] + 1e-6
            )
            assert np.all(inside[chosen.used])
            # A twentieth of the horizon to either side, five samples at 20 Hz.
            assert np.max(chosen.used.sum(axis=1)) == 5
            assert np.all(np.abs(times - windows.times[:, None] - after)[chosen.used] < 0.1 + 1e-6)


def test_a_difference_of_angles_is_the_shorter_way_round() -> None:
    found = turned(np.array([6.2, -6.2, 0.1, 12.6]), 2.0 * np.pi)

    assert found == pytest.approx(
        np.array([6.2, -6.2, 0.1, 12.6]) - 2.0 * np.pi * np.array([1, -1, 0, 2])
    )


def test_the_nearest_sample_is_the_one_with_the_least_distance() -> None:
    rng = np.random.default_rng(1)
    times, to = np.sort(rng.uniform(0.0, 10.0, 40)), rng.uniform(-1.0, 11.0, 200)

    found = np.abs(times[nearest(times, to)] - to)

    assert found == pytest.approx(np.min(np.abs(times - to[:, None]), axis=1))


def test_the_grid_has_every_switch_and_no_long_step(scenes: ModuleType) -> None:
    drive = scenes.unicycle_drive(1, 20.0, 0.0, late=0.033)
    needs = needs_of(scenes.unicycle(), drive)

    grid = flow_grid(needs, 0.03)

    assert np.max(np.diff(grid.times)) <= 0.03 + 1e-9
    for name in ("x", "speed", "turn"):
        assert np.all(np.isin(drive.series[name].times, grid.times))
    column = [each.name for each in needs.inputs].index("turn")
    late = np.searchsorted(grid.times, 0.033 + 7.0)
    turn = drive.series["turn"].values
    assert grid.inputs[late - 1, column] == turn[9]
    assert grid.inputs[late, column] == turn[10]
