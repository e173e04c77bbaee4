"""Three tasks by three paradigms: the same behaviors, and robots that do what is asked of them."""

import dataclasses
import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
import pytest

from runtime.arrays import Array
from runtime.program import Kind, Unit
from runtime.recording.tracks import Quantity
from specc.scenarios.simulating import simulate_scenario
from tests.study.paradigms import (
    PARADIGMS,
    POSTS,
    SELDOM,
    TASKS,
    Patrol,
    hashes_of,
    outcome,
    scenario_of,
)
from verifier.architectures.required import results_on
from verifier.report.requirement_results import Outcome

WAYS = [paradigm for paradigm in PARADIGMS if paradigm != "random"]


@pytest.mark.parametrize("task", TASKS)
def test_all_paradigms_have_the_same_behaviors_to_the_last_byte(task: str) -> None:
    first, *others = (hashes_of(task, paradigm) for paradigm in PARADIGMS)

    assert len(first) >= 3
    assert all(other == first for other in others)


@pytest.mark.parametrize("task", TASKS)
def test_all_paradigms_are_asked_the_same(task: str) -> None:
    first, *others = (
        [required.text for required in scenario_of(task, paradigm).requirements]
        for paradigm in PARADIGMS
    )

    assert all(other == first for other in others)


def says(task: str, paradigm: str, seed: int, duration: float) -> Outcome:
    """What the sentences of `require:` say of the same run, worked out by the verifier."""
    scenario = scenario_of(task, paradigm)
    return simulate_scenario(scenario, seed=seed, duration=duration).outcome


@pytest.mark.parametrize("paradigm", WAYS)
def test_each_paradigm_finds_the_light(paradigm: str) -> None:
    found = outcome("light", paradigm, 2011, duration=15.0)

    assert found.succeeded
    assert found.contacts == 0


def test_where_the_light_is_found_the_sentence_says_so_as_well() -> None:
    found = outcome("light", "subsumption", 2011, duration=10.0)

    assert found.succeeded
    assert says("light", "subsumption", 2011, found.time + 0.1) is Outcome.SATISFIED
    assert says("light", "subsumption", 2011, found.time - 0.1) is not Outcome.SATISFIED


def test_a_touch_is_a_failure_and_the_sentence_says_so_as_well() -> None:
    assert not outcome("light", "random", 2001, duration=15.0).succeeded
    assert says("light", "random", 2001, 15.0) is Outcome.VIOLATED


@pytest.mark.slow
@pytest.mark.parametrize("paradigm", WAYS)
def test_each_paradigm_goes_from_post_to_post(paradigm: str) -> None:
    found = outcome("patrol", paradigm, 1002, duration=45.0)

    assert found.succeeded
    assert found.time < 35.0  # from one post to the other, 5 m away at 0.25 m/s


@pytest.mark.slow
def test_where_all_crates_are_at_walls_the_sentence_says_so_as_well() -> None:
    found = outcome("tidy", "hierarchy", 1001)

    assert found.succeeded
    assert says("tidy", "hierarchy", 1001, found.time + 0.1) is Outcome.SATISFIED


class Round(NamedTuple):
    """A patrol that is made up: where it is, what is used, how near something is, each (T,)."""

    times: Array
    x: Array
    y: Array
    used: Array
    clearance: Array

    def quantities(self) -> Mapping[str, Quantity]:
        """What the sentences read."""
        named = {
            "r.x": (self.x, "m"),
            "r.y": (self.y, "m"),
            "r.battery.used": (self.used, "1"),
            "r.clearance": (self.clearance, "m"),
        }
        rest = (Kind.CONTINUOUS, (), -math.inf, math.inf)
        return {
            name: Quantity(name, Unit(unit, 1.0), *rest, is_held=True, times=self.times, values=of)
            for name, (of, unit) in named.items()
        }


@dataclasses.dataclass
class Told:
    """A world that is as a round has it at one of its instants."""

    round: Round
    now: int = 0

    def poses(self) -> Array:
        return np.array([[self.round.x[self.now], self.round.y[self.now], 0.0]])

    def clearance(self, robot: int) -> float:  # noqa: ARG002  there is one
        return float(self.round.clearance[self.now])

    def sample(self, robot: int, sensor: int) -> Array:
        raise NotImplementedError


def made_up(rng: np.random.Generator) -> Round:
    """From post to post, mostly in time; it touches, or its battery gets flat, or neither.

    No time between two visits of a post is so near to the 100 s that the step decides.
    """
    times = np.arange(0.0, 200.25, 0.5)
    x, y = np.full(len(times), 3.0), np.full(len(times), 2.0)
    at, visits = 0, ([0.0], [0.0])
    first = int(rng.integers(2))
    while (at := at + int(rng.integers(30, 125))) < len(times):
        post = (first + sum(map(len, visits))) % 2
        x[at], y[at] = POSTS[post]
        visits[post].append(times[at])
    gaps = np.concatenate([np.diff([*many, 200.0]) for many in visits])
    if np.any(np.abs(gaps - SELDOM) < 1.5):
        return made_up(rng)
    used, clearance = np.full(len(times), 0.5), np.full(len(times), 0.2)
    if rng.random() < 0.2:
        used[rng.integers(len(times)) :] = 0.995
    if rng.random() < 0.2:
        clearance[rng.integers(len(times))] = -0.001
    return Round(times, x, y, used, clearance)


def decided(told: Round, patrol: Patrol) -> tuple[bool, float]:
    """What the study makes of a round, and when."""
    world = Told(told)
    for now, time in enumerate(told.times.tolist()):
        world.now = now
        verdict = patrol.decided(world, time, float(told.used[now]))
        if verdict is not None:
            return verdict, time
    pytest.fail("a round of the whole duration is decided")


def worst(told: Round, duration: float) -> Outcome:
    """What the sentences say of the first seconds of a round: violated, open or satisfied."""
    required = scenario_of("patrol", "subsumption").requirements
    found = {each.outcome for each in results_on(required, told.quantities(), duration)}
    order = (Outcome.VIOLATED, Outcome.OPEN, Outcome.SATISFIED)
    return next(each for each in order if each in found)


def test_a_patrol_is_left_when_its_sentences_are_violated_and_not_before() -> None:
    rng, scenario = np.random.default_rng(1), scenario_of("patrol", "subsumption")
    good = 0
    for told in (made_up(rng) for _ in range(24)):
        succeeded, when = decided(told, Patrol(scenario))
        good += succeeded
        if succeeded:
            assert when == scenario.duration
            assert worst(told, when) is Outcome.SATISFIED
        else:
            assert worst(told, when) is Outcome.VIOLATED
            assert worst(told, when - 1.0) is not Outcome.VIOLATED

    assert 6 <= good <= 18


def test_a_patrol_that_made_no_way_has_no_time_for_it() -> None:
    assert math.isnan(Patrol(scenario_of("patrol", "subsumption")).time(50.0))
