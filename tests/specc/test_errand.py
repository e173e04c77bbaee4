"""The errand: robots differ in nothing but who decides, and the study judges as is required."""

import math

import pytest
import yaml

from runtime.scenario import Scenario
from specc.scenarios.simulating import simulate_scenario
from tests.study.errand import SCENARIOS, Outcome, outcome, scenario_at, summary
from verifier.report.requirement_results import Outcome as Says

OTHERS = ("random", "learned")


def scenario(way: str) -> Scenario:
    """The errand, by that way to decide."""
    return scenario_at(SCENARIOS / f"errand_{way}.yaml")


@pytest.mark.parametrize("way", OTHERS)
@pytest.mark.parametrize("folder", ["architectures", "scenarios"])
def test_they_differ_in_nothing_but_the_arbiter(folder: str, way: str) -> None:
    texts = [
        (SCENARIOS.parent / folder / f"errand_{each}.yaml").read_text(encoding="utf-8")
        for each in ("rules", way)
    ]
    first, other = (yaml.safe_load(text.replace(f"errand_{way}", "errand_rules")) for text in texts)
    for each in (first, other):
        del each["about"]
        each.pop("train", None)

    assert other == first


@pytest.mark.parametrize("way", OTHERS)
def test_arbiters_read_and_choose_the_same(way: str) -> None:
    first, other = (
        yaml.safe_load((SCENARIOS.parent / "arbiters" / f"errand_{each}.yaml").read_text("utf-8"))
        for each in ("rules", way)
    )

    assert other["choices"] == first["choices"]
    assert other["reads"] == first["reads"]


@pytest.mark.parametrize(
    ("way", "seed", "ending"),
    [("rules", 49, "reached"), ("random", 47, "touched")],
)
def test_what_the_study_says_of_a_world_its_sentences_say_as_well(
    way: str, seed: int, ending: str
) -> None:
    errand = scenario(way)
    meant = Says.SATISFIED if ending == "reached" else Says.VIOLATED

    found = outcome(errand, seed)

    assert found.ending == ending
    after, before = (
        simulate_scenario(errand, seed=seed, duration=found.time + more).outcome
        for more in (0.15, -0.15)
    )
    assert after is meant
    assert before is not meant


def test_a_summary_counts_each_ending_once_and_times_only_what_reached_the_lamp() -> None:
    found = [
        Outcome(1, "reached", 20.0, charged=True),
        Outcome(2, "reached", 40.0, charged=False),
        Outcome(3, "touched", 3.0, charged=False),
        Outcome(4, "late", 120.0, charged=False),
    ]

    of = summary(found)

    assert (of.success, of.touched, of.flat, of.late) == (0.5, 0.25, 0.0, 0.25)
    assert (of.time, of.charged) == (30.0, 0.25)
    assert math.isnan(summary(found[2:]).time)
