"""Noise of a behavior run alone, against the laws of what it is: diffusion and its balance."""

import math
from dataclasses import replace

import numpy as np
import pytest

from runtime.artifact import from_bytes, to_bytes
from runtime.code import Code
from runtime.program import Noise, Program
from runtime.rollout import Ending
from runtime.simulate import simulate
from tests.runtime.behaviors import NOWHERE, control, formula_program, state
from tests.runtime.hybrids import thermostat

RUNS = 2000
SURE = 4.0
"""Standard errors that an estimate may be off: one in 16,000."""


def with_noise(program: Program, **sizes: str) -> Program:
    noise = tuple(Noise(name, Code(text), NOWHERE) for name, text in sizes.items())
    return replace(program, noise=noise)


def diffusing(wild: float = 0.5) -> Program:
    """x' = 0.3 and noise: it drifts, and spreads with the root of time."""
    walk = formula_program(
        (state("x", -100.0, 100.0), state("y", -100.0, 100.0)),
        {"x": "0.3", "y": "0"},
        (control("wild", 0.0, 10.0, wild),),
    )
    return with_noise(walk, x="wild")


def spread(values: np.ndarray) -> tuple[float, float]:
    """The mean, and the standard deviation."""
    return float(np.mean(values)), float(np.std(values))


def test_a_size_is_what_one_second_adds_and_grows_with_the_root_of_time() -> None:
    rollout = simulate(diffusing(), {"x": np.zeros(RUNS)}, 4.0, every=0.5)

    for sample, time in ((2, 1.0), (8, 4.0)):
        mean, deviation = spread(rollout.states[:, sample, 0])
        sigma = 0.5 * math.sqrt(time)
        assert mean == pytest.approx(0.3 * time, abs=SURE * sigma / math.sqrt(RUNS))
        assert deviation == pytest.approx(sigma, abs=SURE * sigma / math.sqrt(2 * RUNS))
    assert not rollout.states[:, :, 1].any()  # what has no noise stays


def test_drift_and_noise_come_to_the_balance_of_ornstein_and_uhlenbeck() -> None:
    home = formula_program((state("x", -50.0, 50.0),), {"x": "x 2 mul neg"})

    rollout = simulate(with_noise(home, x="0.6"), {"x": np.zeros(RUNS)}, 3.0, every=0.1)

    # Variance 0.6**2 / (2 * 2); kicks 25 ms apart are worth 0.025 * 2 of it at most.
    sigma = 0.6 / 2.0
    mean, deviation = spread(rollout.states[:, -1, 0])
    assert mean == pytest.approx(0.0, abs=SURE * sigma / math.sqrt(RUNS))
    assert deviation == pytest.approx(sigma, rel=0.05 + SURE / math.sqrt(2 * RUNS))


def test_a_step_map_is_kicked_once_a_step() -> None:
    walk = formula_program((state("x", -50.0, 50.0),), {"x": "x"}, every=0.25)

    rollout = simulate(with_noise(walk, x="0.2"), {"x": np.zeros(RUNS)}, 4.0)

    sigma = 0.2 * math.sqrt(16)
    deviation = spread(rollout.states[:, -1, 0])[1]
    assert deviation == pytest.approx(sigma, rel=SURE / math.sqrt(2 * RUNS))


def test_the_same_seed_is_the_same_run_and_another_is_another() -> None:
    start = {"x": np.zeros(3)}
    first, again, other = (simulate(diffusing(), start, 1.0, seed=seed) for seed in (7, 7, 8))

    assert first.states.tobytes() == again.states.tobytes()
    assert not np.array_equal(first.states, other.states)
    assert len(np.unique(first.states[:, -1, 0])) == 3


def test_a_run_does_not_depend_on_how_many_run_beside_it() -> None:
    alone, beside = (simulate(diffusing(), {"x": np.zeros(n)}, 1.0) for n in (1, 5))

    assert alone.states[0].tobytes() == beside.states[0].tobytes()


def test_who_is_kicked_out_of_the_domain_ends_there() -> None:
    narrow = formula_program((state("x", -1.0, 1.0),), {"x": "0"})

    rollout = simulate(with_noise(narrow, x="2"), {"x": np.zeros(50)}, 5.0)

    assert set(rollout.endings) == {Ending.LEFT_DOMAIN}
    assert all("x went" in detail for detail in rollout.details)
    assert (np.abs(rollout.ended_in) <= 1.0).all()
    assert np.isnan(rollout.states[:, -1]).all()


def test_modes_switch_where_noise_carries_the_state_over_a_guard() -> None:
    rollout = simulate(with_noise(thermostat(), T="0.5"), {"T": 21.0}, 10.0)

    switches = rollout.switches
    assert len(switches) > 3
    assert set(np.diff(switches.times) > 0.0) == {True}
    heating = rollout.states[:, 1] == 0.0
    assert (rollout.states[heating, 0] < 22.0 + 1.0).all()


def test_noise_is_in_the_artifact() -> None:
    program = diffusing()

    assert from_bytes(to_bytes(program)).noise == program.noise
