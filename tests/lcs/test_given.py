"""What learners are given is refused in one sentence where it is of another type or shape."""

from typing import Any

import numpy as np
import pytest

from lcs.alcsr.config import Beyond, Config, Readings
from lcs.alcsr.learner import ALCSR
from lcs.faults import LearnerError
from lcs.steps import config as steps
from lcs.steps.learner import StepsLearner
from lcs.xcsr import config as xcsr
from lcs.xcsr.learner import XCSR

LEARNERS: dict[str, tuple[Any, Any]] = {
    "ALCSR": (ALCSR, Config),
    "XCSR": (XCSR, xcsr.Config),
    "StepsLearner": (StepsLearner, steps.Config),
}
BOTH = ["ALCSR", "XCSR"]


@pytest.mark.parametrize("name", LEARNERS)
def test_a_learner_of_nothing_is_refused(name: str) -> None:
    kind, config = LEARNERS[name]
    for given, said in (
        ({"actions": "2"}, "actions is a whole number of 1 or more, and '2' is none"),
        ({"actions": True}, "actions is a whole number"),
        ({"inputs": 2.5}, "inputs is a whole number of 1 or more, and 2.5 is none"),
        ({"inputs": 0}, "inputs is a whole number of 1 or more, and 0 is none"),
        ({"seed": "one"}, "seed is a whole number of 0 or more, and 'one' is none"),
        ({"seed": -1}, "seed is a whole number of 0 or more, and -1 is none"),
        ({"config": 0.5}, "Config, and 0.5 is none"),
        ({"config": config(explore="0.5")}, "explore is a number, and '0.5' is none"),
    ):
        with pytest.raises(LearnerError, match=said):
            kind(**{"actions": 2, "inputs": 2, **given})
    kind(np.int64(2), np.int64(2), config(explore=np.float32(0.5)))


@pytest.mark.parametrize(
    ("config", "said"),
    [
        (Config(readings=5), "readings is a Readings, and 5 is none"),  # type: ignore[arg-type]
        (
            Config(readings=Readings(error_of="range")),  # type: ignore[arg-type]
            "error_of is one of ErrorOf.REWARD, ErrorOf.RANGE, and 'range' is none",
        ),
        (Config(corpses=2.5), "corpses is a whole number, and 2.5 is none"),  # type: ignore[arg-type]
        (
            Config(beyond=Beyond(remembers=9, grows="yes")),  # type: ignore[arg-type]
            "grows is True or False, and 'yes' is none",
        ),
    ],
)
def test_constants_of_another_type_are_refused(config: Config, said: str) -> None:
    with pytest.raises(LearnerError, match=said):
        ALCSR(2, 2, config)


@pytest.mark.parametrize("name", LEARNERS)
@pytest.mark.parametrize(
    ("given", "said"),
    [
        ("ab", "an input is 2 numbers; got 'ab'"),
        (["0.1", "0.2"], "an input is 2 numbers; got"),
        (np.array(["0.1", 0.2], object), "an input is 2 numbers; got"),
        ([0.1, [2.0]], "an input is 2 numbers; got"),
        ([{}, 0.2], "an input is 2 numbers; got"),
        ([0.1], r"an input is 2 numbers, and not of shape \(1,\)"),
        ([[0.1, 0.2]], r"an input is 2 numbers, and not of shape \(1, 2\)"),
        (None, r"an input is 2 numbers, and not of shape \(\)"),
        ([0.1, None], "not finite"),
        ([0.1, 1j], "an input is 2 numbers; got"),
    ],
)
def test_what_is_no_input_is_refused(name: str, given: Any, said: str) -> None:
    learner = LEARNERS[name][0](2, 2)
    with pytest.raises(LearnerError, match=said):
        learner.act(given)


@pytest.mark.parametrize("name", LEARNERS)
@pytest.mark.parametrize("given", ["ab", [0.1, 0.2], [["a", "b"]], [[0.1], [0.2, 0.3]], [[{}, 1]]])
def test_what_are_no_inputs_is_refused(name: str, given: Any) -> None:
    learner = LEARNERS[name][0](2, 2)
    with pytest.raises(LearnerError, match="inputs are rows of 2 numbers"):
        learner.decide(given)


@pytest.mark.parametrize("name", BOTH)
@pytest.mark.parametrize("given", ["ab", [["1", "2"]], [[1.0, 2.0, 3.0]], [1.0, 2.0], [[1.0], []]])
def test_what_are_no_rewards_is_refused(name: str, given: Any) -> None:
    learner = LEARNERS[name][0](2, 2)
    with pytest.raises(LearnerError, match="rewards are"):
        learner.run([[0.1, 0.2]], given)


@pytest.mark.parametrize("explore", [0.0, 1.0])
@pytest.mark.parametrize("name", BOTH)
def test_a_reward_is_for_an_action_and_for_one_alone(name: str, explore: float) -> None:
    kind, config = LEARNERS[name]
    learner = kind(2, 2, config(explore=explore))
    with pytest.raises(LearnerError, match=r"no action waits for its reward: call act\(x\) first"):
        learner.learn(1.0)
    for _ in range(4):  # where nothing is known, it tries
        learner.act([0.1, 0.2])
        again = kind.from_state(learner.state())
        learner.learn(1.0)
        again.learn(1.0)
        for each in (learner, again, kind.from_state(learner.state())):
            with pytest.raises(LearnerError, match="no action waits"):
                each.learn(1.0)


@pytest.mark.parametrize("name", BOTH)
@pytest.mark.parametrize("given", ["1", None, [1.0], 1j, float("nan")])
def test_what_is_no_reward_is_refused(name: str, given: Any) -> None:
    learner = LEARNERS[name][0](2, 2)
    learner.act([0.1, 0.2])
    with pytest.raises(LearnerError, match="a reward is a finite number"):
        learner.learn(given)
    learner.learn(np.float32(1.0))
