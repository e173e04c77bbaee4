"""Scores of similarity: closed forms, a plain second implementation, and the published one."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from runtime.arrays import Array
from tests.verifier.fidelity.conftest import van_der_pol, van_der_pol_drive
from verifier.examination import examine
from verifier.fidelity.verify import judged
from verifier.report.report import Standing
from verifier.scores.iso18571 import iso_rating, warping
from verifier.scores.scores import scores_of

AT = np.linspace(0.0, 6.0, 301)
TEST = np.sin(2.0 * AT) + 0.1 * AT
PUBLISHED = {
    # objective-rating-metrics 1.3 (PyPI), the implementation by the standard's own authors.
    "late": (np.sin(2.0 * (AT - 0.2)) + 0.1 * (AT - 0.2), (0.781540, 0.536907, 0.833887, 1.0, 1.0)),
    "small": (0.8 * TEST, (0.876245, 0.812630, 1.0, 0.855966, 0.9)),
    "other": (
        np.sin(2.3 * AT) + 0.05 * AT,
        (0.561652, 0.333987, 0.634551, 0.779546, 0.726187),
    ),
}


@pytest.mark.parametrize("kind", PUBLISHED)
def test_the_iso_rating_is_that_of_another_implementation(kind: str) -> None:
    predicted, (overall, corridor, phase, magnitude, slope) = PUBLISHED[kind]

    found = iso_rating(TEST, predicted)

    assert found is not None
    assert found.overall == pytest.approx(overall, abs=2e-6)
    assert found.corridor == pytest.approx(corridor, abs=2e-6)
    assert found.phase == pytest.approx(phase, abs=2e-6)
    assert found.magnitude == pytest.approx(magnitude, abs=2e-6)
    assert found.slope == pytest.approx(slope, abs=2e-6)


def test_a_perfect_prediction_is_rated_one() -> None:
    found = iso_rating(TEST, TEST)

    assert found is not None
    assert found.overall == pytest.approx(1.0)


def test_a_curve_that_never_moves_and_a_short_one_are_not_rated() -> None:
    assert iso_rating(np.ones(100), TEST[:100]) is None
    assert iso_rating(TEST[:10], TEST[:10]) is None


@given(st.integers(3, 25), st.integers(1, 25), st.integers(0, 1000))
def test_the_warping_is_as_cheap_as_that_of_the_textbook(n: int, band: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    t, c = rng.standard_normal(n), rng.standard_normal(n)

    i, j = warping(t, c, band)

    assert (i[0], j[0], i[-1], j[-1]) == (0, 0, n - 1, n - 1)
    assert set(np.diff(i)) <= {0, 1}
    assert set(np.diff(j)) <= {0, 1}
    assert np.max(np.abs(i - j)) <= band
    assert np.sum((t[i] - c[j]) ** 2) == pytest.approx(_textbook(t, c, band))


def _textbook(t: Array, c: Array, band: int) -> float:
    """Sakoe and Chiba's recursion, cell by cell."""
    cost = np.full((len(t) + 1, len(t) + 1), math.inf)
    cost[0, 0] = 0.0
    for i in range(len(t)):
        for j in range(max(0, i - band), min(len(t), i + band + 1)):
            best = min(cost[i, j], cost[i, j + 1], cost[i + 1, j])
            cost[i + 1, j + 1] = best + (t[i] - c[j]) ** 2
    return float(cost[-1, -1])


def test_a_robot_that_is_plainly_wrong_still_scores_well_and_the_report_says_so() -> None:
    drive = van_der_pol_drive(seed=4, seconds=60.0, noise=0.01, mu=1.3)
    report, study = judged(van_der_pol(), drive)
    assert study is not None
    exceeded = [replace(each, standing=Standing.EXCEEDED) for each in report.variables]

    scores = scores_of(study, replace(report, variables=tuple(exceeded)))

    assert all(each.r_squared > 0.98 for each in scores.variables)
    assert all(each.iso is not None and each.iso.overall > 0.9 for each in scores.variables)
    assert "x exceeds its tolerance, and yet scores 0.9" in scores.sentences[1]


def test_r_squared_and_nrmse_are_what_noise_leaves_of_them() -> None:
    noise = 0.1
    trace = van_der_pol_drive(seed=5, seconds=60.0, noise=noise)

    examination = examine(van_der_pol(), trace)

    assert examination.scores is not None
    for each in examination.scores.variables:
        values = trace.series[each.name].values
        # The noise of the sample, and that of the fitted start, carried on.
        assert noise < each.nrmse * np.ptp(values) < 2.0 * noise
        assert 1.0 - each.r_squared == pytest.approx((noise / np.std(values)) ** 2, rel=2.0)


def test_only_the_verdict_means_only_the_verdict() -> None:
    trace = van_der_pol_drive(seed=4, seconds=20.0, noise=0.01)
    told: list[str] = []

    examination = examine(van_der_pol(), trace, depth="verdict", progress=told.append)

    assert examination.scores is None
    assert told == ["judging"]
