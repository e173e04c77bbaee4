"""How a scenario trains an arbiter: measures, reward and end in SI; kept in its artifact."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from compiler.check import check
from compiler.world.scenario import compile_scenario
from runtime.code import Code
from runtime.container import ArtifactError
from runtime.machine import evaluate
from runtime.requirement import TIE
from runtime.scenario import Scenario
from runtime.scenario_artifact import from_bytes, to_bytes
from runtime.training import How, Measure, Training
from spec_schema.diagnostics import SpecError

PARTS = Path(__file__).parents[2] / "golden" / "bad" / "parts"
TRAIN = """train:
  arbiter: r.choose
  reward: progress - 10 * contact + safe
  measures:
    progress: {fall: "hypot(r.x - 5 m, r.y - 300 cm)"}
    contact: {most: r.contacts}
    safe: {robustness: always r.clearance > 5 cm}
  ends_when: hypot(r.x - 5 m, r.y - 3 m) < 0.4 m
  discount: 0.9
"""


def silent(_what: str, _done: int, _of: int) -> None:
    """Nobody watches."""


def spec(tmp_path: Path, train: str = TRAIN) -> Path:
    path = tmp_path / "tried.yaml"
    path.write_text(
        f"specc: 1\nkind: scenario\nname: tried\nworld: {PARTS}/office.yaml\n"
        f"robots: {{r: {{architecture: {PARTS}/learn_light.yaml}}}}\nduration: 5 s\n{train}",
        encoding="utf-8",
    )
    return path


def trained(scenario: Scenario) -> Training:
    assert scenario.training is not None
    return scenario.training


def value(code: Code | None, **at: float) -> float:
    """Of code where each name (with _ for its dots) has a value."""
    assert code is not None
    names = tuple(name.replace("_", ".") for name in at)
    return float(evaluate([code], names, np.array([*at.values()]))[0])


@pytest.fixture(scope="module")
def scenario(tmp_path_factory: pytest.TempPathFactory) -> Scenario:
    return compile_scenario(spec(tmp_path_factory.mktemp("spec")), silent).scenario


def test_measures_are_expressions_of_the_run_in_si(scenario: Scenario) -> None:
    training = trained(scenario)
    progress, contact, safe = training.measures

    assert training.arbiter == "r.choose"
    assert training.register == ("progress", "contact", "safe")
    assert [one.how for one in training.measures] == [How.FALL, How.MOST, How.ROBUSTNESS]
    assert value(progress.code, r_x=2.0, r_y=-1.0) == pytest.approx(5.0)
    assert value(contact.code, r_contacts=2.0) == 2.0
    assert safe.code is None
    assert safe.requirement is not None
    assert safe.requirement.quantities == ("r.clearance",)
    assert training.quantities == ("r.x", "r.y", "r.contacts")
    assert training.discount == 0.9
    assert training.origin.endswith("tried.yaml:7:1")
    assert progress.origin.endswith("tried.yaml:11:5")


def test_the_reward_is_of_the_measures_in_their_order(scenario: Scenario) -> None:
    training = trained(scenario)
    found = evaluate([training.reward], training.register, np.array([0.05, 1.0, 0.2]))

    assert float(found[0]) == pytest.approx(0.05 - 10.0 + 0.2)


def test_an_episode_ends_where_its_margin_is_no_longer_below_0(scenario: Scenario) -> None:
    ends_when = trained(scenario).ends_when

    assert value(ends_when, r_x=4.7, r_y=3.0) > 0.0
    assert value(ends_when, r_x=4.5, r_y=3.0) < 0.0


@given(x=st.sampled_from([0.0, 1.0, 2.0, 3.0]), y=st.sampled_from([0.0, 1.0, 2.0, 3.0]))
def test_conditions_that_are_joined_hold_as_python_has_it(
    tmp_path_factory: pytest.TempPathFactory, x: float, y: float
) -> None:
    text = "(not r.x <= 1 m and r.y < 2 m) or (if r.x > 0 m then 2 m <= r.y <= 200 cm)"
    margin = value(joined(tmp_path_factory, text), r_x=x, r_y=y)

    assert (margin >= 0.0) == ((not x <= 1 and y < 2) or (not x > 0 or 2 <= y <= 2))
    assert abs(margin) >= TIE / 2


KNOWN: dict[str, Code | None] = {}


def joined(factory: pytest.TempPathFactory, text: str) -> Code | None:
    """The code of an end, compiled once."""
    if text not in KNOWN:
        train = TRAIN.replace("hypot(r.x - 5 m, r.y - 3 m) < 0.4 m", text)
        path = spec(factory.mktemp("joined"), train)
        KNOWN[text] = trained(compile_scenario(path, silent).scenario).ends_when
    return KNOWN[text]


def test_an_artifact_has_the_training_and_the_learner(scenario: Scenario) -> None:
    data = to_bytes(scenario)
    read = from_bytes(data)

    assert read.training == scenario.training
    assert [a.learner for a in read.robots[0].architecture.arbiters] == ["alcsr"]
    assert read.robots[0].architecture.arbiters[0].rules[0].right == 412
    assert to_bytes(read) == data


def changed(scenario: Scenario, **more: object) -> Scenario:
    return replace(scenario, training=replace(trained(scenario), **more))  # type: ignore[arg-type]


OF_NOTHING = Measure("lost", How.MOST, None, None, "here:1:1")
TOO_MUCH = Measure("safe", How.ROBUSTNESS, Code("1"), None, "here:1:1")


@pytest.mark.parametrize(
    ("more", "why"),
    [
        ({"node": "seek"}, "'r.seek' is to be trained, and is no arbiter that learns"),
        ({"robot": "s"}, "'s.choose' is to be trained"),
        ({"discount": 1.5}, "has the discount 1.5"),
        ({"reward": Code("speed")}, "the reward can't be worked out"),
        ({"ends_when": Code("r.x add")}, "the end of an episode can't be worked out"),
        ({"quantities": ("r.x", "r.x")}, "names something twice"),
        ({"quantities": (), "ends_when": None}, "the measure 'progress' can't be worked out"),
        (
            {"measures": (OF_NOTHING,), "reward": Code("1")},
            "'lost' is not of a quantity or of a requirement",
        ),
        (
            {"measures": (TOO_MUCH,), "reward": Code("1")},
            "'safe' is not of a quantity or of a requirement",
        ),
    ],
)
def test_a_training_that_does_not_fit_is_refused(
    scenario: Scenario, more: dict[str, object], why: str
) -> None:
    with pytest.raises(ArtifactError, match=why):
        to_bytes(changed(scenario, **more))


@pytest.mark.parametrize(
    ("more", "why"),
    [
        ({"learner": "q"}, "learned by 'q', which is not known"),
        ({"rules": ()}, "has no rule that holds where no other does"),
    ],
)
def test_a_learned_arbiter_that_does_not_fit_is_refused(
    scenario: Scenario, more: dict[str, object], why: str
) -> None:
    (robot,) = scenario.robots
    (arbiter,) = robot.architecture.arbiters
    wrong = replace(arbiter, **more)  # type: ignore[arg-type]
    architecture = replace(robot.architecture, arbiters=(wrong,))

    with pytest.raises(ArtifactError, match=why):
        to_bytes(replace(scenario, robots=(replace(robot, architecture=architecture),)))


def test_everything_that_is_wrong_is_told_at_once(tmp_path: Path) -> None:
    train = TRAIN.replace("r.choose", "r.chose").replace("progress -", "progres -")
    train = train.replace("r.contacts", "r.contact").replace("5 cm", "5").replace("< 0.4 m", "")

    found = check(spec(tmp_path, train))

    assert [one.code for one in found] == ["S392", "S139", "S371", "S141", "S374"]
    with pytest.raises(SpecError):
        compile_scenario(spec(tmp_path, train), silent)


def test_of_an_unreadable_robot_the_reward_is_checked_all_the_same(tmp_path: Path) -> None:
    path = spec(tmp_path, TRAIN.replace("10 * contact", "10 * contac"))
    path.write_text(path.read_text().replace("learn_light", "learn_lite"))

    assert [one.code for one in check(path)] == ["S320", "S139"]


def test_a_half_turn_is_measured_in_radians(tmp_path: Path) -> None:
    train = TRAIN.replace("r.contacts", "abs(wrap(r.heading - 90 deg))")
    contact = trained(compile_scenario(spec(tmp_path, train), silent).scenario).measures[1]

    assert value(contact.code, r_heading=-math.pi / 2) == pytest.approx(math.pi)
