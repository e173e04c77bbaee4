"""Base behaviors by themselves on a body: each does what its name says."""

from pathlib import Path

import pytest

from specc.scenarios.simulating import simulate_scenario
from verifier.report.requirement_results import Outcome

ALONE = sorted((Path(__file__).parents[2] / "specs" / "scenarios" / "alone").glob("*.yaml"))


@pytest.mark.parametrize("scenario", ALONE, ids=lambda path: path.stem)
def test_a_behavior_alone_does_what_its_name_says(scenario: Path) -> None:
    assert simulate_scenario(scenario).outcome is Outcome.SATISFIED
