"""When sensors say what they sampled, and how well."""

import math

import numpy as np
import pytest
from scipy import stats

from runtime.arrays import Array
from runtime.program import Kind, Unit
from runtime.scheduler.environment import Sensors
from runtime.scheduler.sensors import SensorBank
from runtime.world.model import Body, Pose, Reading, Sensor, SensorKind
from tests.runtime.world.worlds import body

STEP = 0.01


class Steady:
    """A world in which every sensor's truth is what a function of its number of samples says."""

    def __init__(self, *truth: float) -> None:
        self.truth = truth
        self.asked: list[tuple[int, int]] = []

    def sample(self, robot: int, sensor: int) -> Array:
        self.asked.append((robot, sensor))
        return np.array(self.truth)


def reading(
    noise: float = 0.0,
    step: float = 0.0,
    kind: Kind = Kind.CONTINUOUS,
    ends: tuple[float, float] = (-1e6, 1e6),
) -> Reading:
    return Reading("reading", Unit("1", 1.0), *ends, kind, noise, step)


def sensor(
    *readings: Reading,
    every: float = STEP,
    latency: float = 0.0,
    kind: SensorKind = SensorKind.LIGHT,
    name: str = "eye",
) -> Sensor:
    rest = (Pose(0.0, 0.0, 0.0), math.tau, 1.0, 1, 0.0, (), 0.0, every, latency, readings, "")
    return Sensor(name, kind, *rest)


def bank(world: Steady, *sensors: Sensor, seed: int = 1, robots: int = 1) -> SensorBank:
    fitted: Body = body()
    fitted = Body(*(getattr(fitted, f) for f in fitted.__slots__[:-2]), sensors, fitted.source)
    return SensorBank([(f"r{k}", fitted) for k in range(robots)], world, STEP, seed)


def series(said: SensorBank, count: int) -> Array:
    """The readings of one sensor that samples at each step."""
    found = [delivery.readings for k in range(count) for delivery in said.due(k)]
    return np.array(found)


def test_a_bank_is_what_the_scheduler_asks_for() -> None:
    asked: Sensors = bank(Steady(1.0), sensor(reading()))

    assert asked.next_due == 0


def test_rate_and_latency_hold_to_the_step() -> None:
    world = Steady(1.0)
    said = bank(world, sensor(reading(), every=0.05, latency=0.12))
    samples, deliveries = [], []
    for instant in range(40):
        before = len(world.asked)
        if said.next_due == instant:
            deliveries += [instant] * len(said.due(instant))
        samples += [instant] * (len(world.asked) - before)
        assert said.next_due > instant

    assert samples == list(range(0, 40, 5))
    # At the beginning it says what it has been saying; what was sampled at 5 comes at 17.
    assert deliveries == [0, *(k + 12 for k in range(5, 28, 5))]


def test_the_readings_that_come_late_are_those_that_were_sampled() -> None:
    world = Steady(0.0)
    said = bank(world, sensor(reading(), every=0.02, latency=0.05))
    found = {}
    for instant in range(12):
        world.truth = (float(instant),)
        for delivery in said.due(instant):
            found[instant] = float(delivery.readings[0])

    assert found == {0: 0.0, 7: 2.0, 9: 4.0, 11: 6.0}


def test_deliveries_come_by_robot_and_sensor() -> None:
    sensors = sensor(reading(), name="a", latency=0.01), sensor(reading(), name="b", every=0.02)
    said = bank(Steady(1.0), *sensors, robots=2)

    assert [(d.robot, d.sensor) for d in said.due(0)] == [(0, 0), (0, 1), (1, 0), (1, 1)]
    assert [(d.robot, d.sensor) for d in said.due(1)] == []
    assert [(d.robot, d.sensor) for d in said.due(2)] == [(0, 0), (0, 1), (1, 0), (1, 1)]


def test_where_nothing_senses_nothing_is_due() -> None:
    said = bank(Steady())

    assert said.next_due == 0
    assert said.due(0) == []
    assert said.next_due > 10**15


def test_noise_has_its_standard_deviation_is_normal_and_white() -> None:
    said = series(bank(Steady(5.0, 1.0), sensor(reading(noise=0.3), reading())), 20_000)

    noise = (said[:, 0] - 5.0) / 0.3
    assert abs(noise.mean()) < 4.0 / math.sqrt(20_000)
    # (n - 1) s^2 is chi-square: the bounds hold but for one seed in ten thousand.
    low, high = stats.chi2.ppf([5e-5, 1 - 5e-5], 19_999) / 19_999
    assert low < noise.var(ddof=1) < high
    assert stats.kstest(noise, "norm").pvalue > 1e-4
    lags = [float(np.mean(noise[lag:] * noise[:-lag])) for lag in range(1, 30)]
    assert max(map(abs, lags)) < 4.5 / math.sqrt(20_000)
    assert (said[:, 1] == 1.0).all()


def test_each_sensor_has_numbers_of_its_own_whoever_else_there_is() -> None:
    eye, ear = (sensor(reading(noise=1.0), name=name) for name in ("eye", "ear"))

    alone = series(bank(Steady(0.0), eye), 50)
    both = series(bank(Steady(0.0), ear, eye), 50)
    other_seed = series(bank(Steady(0.0), eye, seed=2), 50)

    assert (both[1::2] == alone).all()
    assert abs(np.corrcoef(both[::2, 0], alone[:, 0])[0, 1]) < 0.6
    assert (other_seed != alone).all()


@pytest.mark.parametrize(("true", "said"), [(0.234, 0.2), (0.251, 0.3), (0.99, 1.0), (1.7, 1.0)])
def test_readings_have_their_resolution_and_stay_on_their_scale(true: float, said: float) -> None:
    fitted = sensor(reading(step=0.1, ends=(0.0, 1.0)))

    assert series(bank(Steady(true), fitted), 1)[0, 0] == pytest.approx(said)


def test_angles_are_wrapped_and_not_cut_off() -> None:
    fitted = sensor(reading(0.1, kind=Kind.PERIODIC, ends=(-math.pi, math.pi)))

    found = series(bank(Steady(math.pi), fitted), 200)[:, 0]

    assert (np.abs(found) <= math.pi).all()
    assert (found < -3.0).any()
    assert (found > 3.0).any()
    assert np.abs(found).min() > math.pi - 0.5


def test_yes_and_no_stay_yes_and_no() -> None:
    fitted = sensor(reading(0.4, kind=Kind.DISCRETE, ends=(0.0, 1.0)))

    assert set(series(bank(Steady(1.0), fitted), 200)[:, 0].tolist()) == {0.0, 1.0}


def test_a_range_that_hits_nothing_says_its_reach_without_noise() -> None:
    fitted = sensor(reading(0.1, ends=(0.0, 2.0)), kind=SensorKind.RANGE)

    assert (series(bank(Steady(2.0), fitted), 100) == 2.0).all()
    assert (series(bank(Steady(1.5), fitted), 100) != 1.5).all()


def test_what_has_nothing_new_to_say_says_what_it_said_last() -> None:
    world = Steady(math.nan, math.nan)
    bearing = reading(0.1, kind=Kind.PERIODIC, ends=(-math.pi, math.pi))
    said = bank(world, sensor(bearing, reading(0.1, ends=(0.0, 6.0)), kind=SensorKind.SIGHT))

    assert said.due(0)[0].readings.tolist() == [0.0, 6.0]
    world.truth = (0.5, 2.0)
    seen = said.due(1)[0].readings.tolist()
    world.truth = (math.nan, math.nan)
    assert said.due(2)[0].readings.tolist() == seen != [0.5, 2.0]


def test_what_waits_and_what_was_said_last_is_part_of_the_state() -> None:
    world = Steady(1.0)
    said = bank(world, sensor(reading(), latency=0.03))
    said.due(0)
    before = said.state()
    world.truth = (2.0,)
    said.due(1)

    assert said.state().tolist() == [2.0, 2.0] != before.tolist()


def test_a_latency_that_is_no_whole_number_of_steps_is_refused() -> None:
    with pytest.raises(ValueError, match="no multiple of the step"):
        bank(Steady(1.0), sensor(reading(), latency=0.015))
