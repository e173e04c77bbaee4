"""A learner in the place of an arbiter keeps what the arbiter's kind promises."""

import numpy as np
import pytest

from runtime.arbiter import Paradigm
from runtime.architecture import Way
from runtime.arrays import Array
from runtime.scheduler.nodes import Learner
from runtime.scheduler.observer import What
from runtime.scheduler.scheduler import Scheduler
from tests.runtime.scheduler.plane import N, Noted, Plain, Plane, architecture, scenario
from tests.runtime.scheduler.test_acting import arbiter, by_rules
from tests.runtime.scheduler.test_channels import node


class Both:
    """Says that both choices hold."""

    def reset(self, seed: int) -> None:
        """Forget nothing."""

    def decide(self, reads: Array, time: float) -> Array:  # noqa: ARG002  # it is always so
        """The second more than the first."""
        return np.array([0.5, 0.75])

    def learn(self, reward: float) -> None:
        """Learn nothing."""


@pytest.mark.parametrize("paradigm", [Paradigm.RULES, Paradigm.SUBSUMPTION])
def test_in_the_place_of_rules_only_its_largest_number_counts(paradigm: Paradigm) -> None:
    made = by_rules(("x", "y"), ("x", None), ("y", None))
    made = arbiter(("x", "y"), paradigm, rules=made.rules)
    choices = {"x": ("one",), "y": ("two",)}
    chooser = N("choose", made, inputs={"x": "pos.x"}, choices=choices, level=1)
    wired = architecture([node("one", 1.0), node("two", 2.0), chooser], ways={"x": Way.EXCLUSIVE})
    noted, plane = Noted(), Plane()
    learners = {"r.choose": Learner(Both(), lambda: 0.0)}

    scheduler = Scheduler(scenario(wired), plane, Plain(plane), observer=noted, learners=learners)
    scheduler.run(3)

    conflicts = [event for _, event in noted.events if event.what is What.CONFLICT]
    assert bool(conflicts) is (paradigm is Paradigm.SUBSUMPTION)
    if not conflicts:
        assert scheduler.agents[0].acting.does == [False, True, True]
