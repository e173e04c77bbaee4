"""Parts, the mean errors in them, and what is shown to be no chance: against simulated truths."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats

from verifier.fidelity.judging.conditional_mean import conditional_means
from verifier.fidelity.judging.part_means import part_means
from verifier.fidelity.judging.parts import DEEPEST, LEAST, Condition, parts_of
from verifier.fidelity.judging.structure import shown_structure
from verifier.fidelity.shooting.shooting import Errors
from verifier.report.report import Standing

CHANCE = 0.025


def errors(mean: np.ndarray, moved: np.ndarray | None = None) -> Errors:
    nothing = np.zeros(len(mean))
    went = nothing if moved is None else moved
    return Errors(mean, mean, nothing, nothing, nothing, went, nothing)


@given(st.integers(0, 10_000), st.integers(16, 300), st.integers(1, 4))
@settings(max_examples=40, deadline=None)
def test_parts_are_disjoint_large_enough_and_hold_what_they_say(
    seed: int, windows: int, axes: int
) -> None:
    rng = np.random.default_rng(seed)
    conditions = tuple(
        Condition(f"q{k}", rng.normal(size=windows) ** 3, is_discrete=False) for k in range(axes)
    )
    clusters = np.arange(windows) // 2

    parts = parts_of(conditions, clusters)

    assert np.sum([part.members for part in parts], axis=0).tolist() == [1] * windows
    assert len(parts) <= 2**DEEPEST
    for part in parts:
        assert len(parts) == 1 or len(np.unique(clusters[part.members])) >= LEAST
        for name, (low, high) in part.bounds.items():
            values = next(c.values for c in conditions if c.name == name)[part.members]
            assert low <= values.min() <= values.max() <= high


def test_a_value_that_was_seen_twice_is_in_no_part() -> None:
    mode = np.repeat([0.0, 1.0, 2.0], [40, 40, 2])

    parts = parts_of((Condition("mode", mode, is_discrete=True),), np.arange(82))

    assert [part.bounds["mode"] for part in parts] == [(0.0, 0.0), (1.0, 1.0)]
    assert sum(int(part.members.sum()) for part in parts) == 80


def test_the_mean_of_independent_errors_has_students_interval() -> None:
    values = np.random.default_rng(1).standard_normal(12)
    found = conditional_means(values, np.ones((12, 1)), np.arange(12), np.ones((1, 1)))

    low, high = found.bounds(CHANCE)

    # The jackknife of a mean is the textbook's standard error.
    expected = stats.t.interval(0.95, 11, values.mean(), stats.sem(values))
    assert (low[0], high[0]) == pytest.approx(expected)


@pytest.mark.parametrize("clusters", [8, 20])
def test_the_ends_of_a_slope_are_missed_as_rarely_as_claimed(clusters: int) -> None:
    rng = np.random.default_rng(clusters)
    sizes = rng.integers(1, 5, clusters)
    place = np.repeat(np.arange(clusters), sizes)
    x = rng.normal(size=len(place)) + rng.normal(size=clusters)[place]
    design = np.column_stack([np.ones(len(x)), x])
    at = np.array([[1.0, -1.0], [1.0, 1.0]])
    missed = 0
    for _ in range(500):
        noise = rng.normal(size=clusters)[place] + 0.5 * rng.normal(size=len(x))
        low, high = conditional_means(1.0 + 0.5 * x + noise, design, place, at).bounds(CHANCE)
        missed += int(np.sum((low > at @ [1.0, 0.5]) | (high < at @ [1.0, 0.5])))

    # 5 % of 1,000; the standard error of 1,000 half-dependent trials is 1 %.
    assert missed / 1000 < 0.08


def test_a_departure_in_one_part_is_found_there_with_its_sign() -> None:
    rng = np.random.default_rng(3)
    x = rng.uniform(0.0, 4.0, 400)
    mean = 0.01 * rng.standard_normal(400) - np.where(x > 3.0, 0.2, 0.0)

    found = part_means(errors(mean), (Condition("x", x, is_discrete=False),), 0.1, CHANCE)

    beyond = [each for each in found.means if each.standing is Standing.EXCEEDED]
    assert beyond
    assert all(each.part.bounds["x"][0] > 2.5 and each.mean < -0.1 for each in beyond)
    assert found.shown > 0.1


def test_a_wrong_gain_shows_in_a_single_part() -> None:
    rng = np.random.default_rng(4)
    moved = rng.choice([-1.0, 1.0], 40)

    found = part_means(errors(0.2 * moved + 0.02 * rng.normal(size=40), moved), (), 0.1, CHANCE)

    # The mean of all is zero; the means of either way are not.
    assert found.shown > 0.15


def test_parts_of_pure_noise_exceed_nothing() -> None:
    rng = np.random.default_rng(5)
    wrong = 0
    for _ in range(200):
        conditions = tuple(
            Condition(name, rng.uniform(0.0, 1.0, 240), is_discrete=False) for name in "xy"
        )
        # The tolerance is what the mean truly is, in every part.
        found = part_means(errors(rng.standard_normal(240) + 2.0), conditions, 2.0, CHANCE)
        wrong += found.shown > 2.0

    # Family-wise 2.5 %; 200 runs have a standard error of 1.1 %.
    assert wrong / 200 < 0.06


def overlapping(rng: np.random.Generator, windows: int) -> np.ndarray:
    """Unrest in windows that overlap by half, of variance 1."""
    steps = rng.standard_normal(windows + 1)
    return (steps[1:] + steps[:-1]) / np.sqrt(2.0)


@pytest.mark.parametrize("windows", [40, 120])
def test_unrest_foretells_nothing(windows: int) -> None:
    rng = np.random.default_rng(windows)
    clusters = np.arange(windows) // 3
    shown = []
    for _ in range(200):
        # The situation changes slowly, as unrest does: neighbours in time are alike.
        place = np.cumsum(rng.normal(size=(windows, 2)), axis=0)
        shown.append(shown_structure(overlapping(rng, windows), place, clusters, CHANCE))

    assert np.mean(np.array(shown) > 0.1) < 0.05


def test_what_comes_back_on_every_lap_is_shown_with_its_size() -> None:
    rng = np.random.default_rng(7)
    phase = 0.7 * np.arange(120)
    place = np.column_stack([np.cos(phase), np.sin(phase)])
    structure = np.cos(2.0 * phase)

    shown = [
        shown_structure(structure + overlapping(rng, 120), place, np.arange(120) // 3, CHANCE)
        for _ in range(40)
    ]

    # Its root mean square is 0.71, that of the unrest 1: seldom is more shown, and much of it is.
    assert np.mean(np.array(shown) > np.sqrt(0.5)) < 0.1
    assert np.median(shown) > 0.25
