"""Three tasks by three paradigms: the same behaviors, and robots that do what is asked of them."""

import pytest

from specc.simulating import simulate_scenario
from tests.study.paradigms import PARADIGMS, TASKS, hashes_of, outcome, scenario_of
from verifier.report.requirement_results import Outcome

WAYS = [paradigm for paradigm in PARADIGMS if paradigm != "random"]


@pytest.mark.parametrize("task", TASKS)
def test_all_paradigms_have_the_same_behaviors_to_the_last_byte(task: str) -> None:
    first, *others = (hashes_of(task, paradigm) for paradigm in PARADIGMS)

    assert len(first) >= 3
    assert all(other == first for other in others)


def says(task: str, paradigm: str, seed: int, duration: float) -> Outcome:
    """What the sentences of `require:` say of the same run, worked out by the verifier."""
    scenario = scenario_of(task, paradigm)
    return simulate_scenario(scenario, seed=seed, duration=duration).outcome


@pytest.mark.parametrize("paradigm", WAYS)
def test_each_paradigm_finds_the_light_and_the_sentence_says_so_as_well(paradigm: str) -> None:
    found = outcome("light", paradigm, 2000, duration=30.0)

    assert found.succeeded
    assert found.contacts == 0
    assert says("light", paradigm, 2000, found.time + 0.1) is Outcome.SATISFIED


@pytest.mark.slow
@pytest.mark.parametrize("paradigm", WAYS)
def test_each_paradigm_goes_from_post_to_post_and_recharges(paradigm: str) -> None:
    found = outcome("patrol", paradigm, 1002, duration=70.0)

    assert found.succeeded
    assert found.time < 35.0  # from one post to the other, 5 m away at 0.25 m/s


@pytest.mark.slow
@pytest.mark.parametrize("paradigm", WAYS)
def test_each_paradigm_pushes_all_crates_to_walls_and_the_sentence_says_so(paradigm: str) -> None:
    found = outcome("tidy", paradigm, 1001)

    assert found.succeeded
    assert says("tidy", paradigm, 1001, found.time + 0.1) is Outcome.SATISFIED


def test_a_touch_is_a_failure_and_the_sentence_says_so_as_well() -> None:
    assert not outcome("light", "random", 2001, duration=30.0).succeeded
    assert says("light", "random", 2001, 30.0) is Outcome.VIOLATED
