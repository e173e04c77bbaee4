"""What `specc learn --list` says of constants: all of them, and rightly which do nothing."""

import dataclasses
from typing import Any

import numpy as np
import pytest

from lcs.alcsr.config import GROWN, Config
from lcs.alcsr.learner import ALCSR
from lcs.problems.classes import multiplexer
from specc.cli import main
from specc.learning.learners import ALL
from specc.learning.meanings import CONSTANTS, idle
from specc.learning.settings import configured, listed

OTHERS = {
    "seeds_are": "just_able", "neighbors_are": "sub_species", "half_of": "those_there_are",
    "offspring_in": "pool", "generalization": "hull_and_beyond", "mutation_is": "always",
    "covered_is": "fed", "corpse_spans": "half_each", "corpses_learn": "halved",
    "readings.corpse_rate": "relative", "seeding_by": "sub_species", "damaged_by": "any",
    "error_of": "range", "corpses": "3", "corpse_neighbors": "2",
    "breeding_neighbors": "3",
}  # fmt: skip


def learnt_with(config: Config) -> list[bytes]:
    """The rules and the course after some cycles of a problem with noise."""
    problem = dataclasses.replace(multiplexer(2), flipped=0.1)
    x, rewards, _ = problem.drawn(800, np.random.default_rng(1))
    learner = ALCSR(problem.classes, problem.inputs, config, seed=0)
    course, rules = learner.run(x, rewards), learner.rules()
    kept: list[Any] = [getattr(course, each.name) for each in dataclasses.fields(course)]
    return [each.tobytes() for each in (*kept, rules.lower, rules.upper, rules.weight)]


@pytest.mark.parametrize("learner", ALL)
def test_each_constant_has_a_meaning_and_each_meaning_a_constant(learner: str) -> None:
    named = [name for name, _ in listed(ALL[learner].config)]

    assert sorted(named) == sorted(CONSTANTS[learner])
    assert {*idle(ALL[learner].config)} <= {*named}


def test_what_is_said_to_do_nothing_does_nothing() -> None:
    usual = learnt_with(GROWN)
    for name in idle(GROWN):
        other = configured(GROWN, {name: OTHERS.get(name, "0.07")}, "alcsr")
        assert other != GROWN, name
        assert learnt_with(other) == usual, name


@pytest.mark.parametrize(
    "name", ["seeding", "mature_level", "sprouts", "explore", "metabolism_cost"]
)
def test_what_does_something_is_not_said_to_do_nothing(name: str) -> None:
    assert name not in idle(GROWN)
    assert learnt_with(configured(GROWN, {name: "1"}, "alcsr")) != learnt_with(GROWN)


def test_the_list_says_so(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["learn", "--list"]) == 0
    assert "a bound of offspring mutates (does nothing while breeds=no)" in capsys.readouterr().out
    assert main(["learn", "--list", "--learner", "thesis"]) == 0
    assert "does nothing while breeds=no" not in capsys.readouterr().out
