"""Every kind of arbiter from its YAML to a run in the world: a robot that goes to and fro along x.

What is asserted is what the robot did, and that it follows from what was sampled, worked out here
by hand. `go` drives ahead with 0.3 m/s and `back` backwards; they share the channel `base.forward`.
"""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

import numpy as np
import pytest

from compiler.check import check
from compiler.world.scenario import compile_scenario
from runtime.arrays import Array
from runtime.recording.tracks import NodeTrack
from runtime.run import Run, run
from runtime.user_code import UserCodeError

PACE = 0.3
LATE = 0.25
"""Seconds from a threshold to what the robot does: a period, a response, and to turn round."""

BODY = """
specc: 1
kind: body
name: puck
shape: {circle: 10 cm}
mass: 2 kg
drive: {holonomic: {speed: 0.5 m/s, turn: 2 rad/s}}
sensors: {truth: {senses: pose, every: 50 ms}}
"""
BEHAVIOR = """
specc: 1
kind: behavior
name: NAME
state:
  x:
    unit: m
    domain: [0, 4]
    role: both
    relates: {agent: the middle of the base, environment: the wall on the left}
constants: {pace: {value: PACE, unit: m/s}, aside: {value: 1 cm/s, unit: m/s}}
output: {speed: {unit: m/s, is: pace}, slide: {unit: m/s, is: aside}}
field: {formula: {x: pace}}
realizes: {speed: base.forward as set-point}
"""
SLIDES = BEHAVIOR.replace("realizes: {", "realizes: {slide: base.left as set-point, ")
SLOWS = """
specc: 1
kind: behavior
name: back
state:
  v:
    unit: m/s
    domain: [-1, 1]
    role: both
    relates: {agent: the middle of the base, environment: the floor}
constants: {pull: {value: 1, unit: 1/s}}
field: {formula: {v: -pull * v}}
realizes: {v: base.forward as acceleration}
"""
MODES = """
specc: 1
kind: behavior
name: modes
state:
  x:
    unit: m
    domain: [0, 4]
    role: sensed
    relates: {agent: the middle of the base, environment: the wall on the left}
  haste:
    unit: "1"
    domain: [0, 1]
    role: driven
    relates: {agent: how eager it is, environment: the wall on the left}
  doing:
    kind: discrete
    values: [back, go]
    role: both
    relates: {agent: what it is about, environment: the wall on the left}
constants: {near: {value: 2, unit: m}, far: {value: 2.5, unit: m}, slow: {value: 0, unit: 1/(m*s)}}
field:
  modes:
    of: doing
    each:
      go: {formula: {haste: slow * x}, leave: [{when: x >= far, to: back}]}
      back: {formula: {haste: slow * x}, leave: [{when: x <= near, to: go}]}
"""
ARBITER = """
specc: 1
kind: arbiter
name: choose
reads: {x: {unit: m, domain: [0, 4]}}
constants: {near: {value: 2, unit: m}, far: {value: 2.5, unit: m}, soft: {value: 5 cm, unit: m}}
choices: [back, go]
by: """
SENSE = "sense: {x: {from: truth.x, outside: clip}}"
GO = f"  go: {{behavior: go.yaml, period: 50 ms, {SENSE}}}"
BACK = f"  back: {{behavior: back.yaml, period: 50 ms, {SENSE}}}"
MEANS = "choices: {back: [back], go: [go]}"
CHOOSE = (
    f"  choose: {{arbiter: choose.yaml, period: 100 ms, response_time: 50 ms, {SENSE}, {MEANS}}}"
)
EXCLUSIVE = "{base.forward: {exclusive: choose}}"
BLEND = "{base.forward: {blend: choose}}"
PRIORITY = "{base.forward: {priority: [back, go]}}"
HYSTERESIS = "{rules: [{choose: back, when: x > far, until: x < near}, {choose: go}]}"
PYTHON = """
def choose(reads, time):
    return "back" if reads["x"] > 2.5 else {"go": 1.0}


class Counting:
    def __init__(self, reads, choices):
        assert (reads, choices) == (("x",), ("back", "go"))

    def reset(self, seed):
        self.decisions = 0

    def decide(self, reads, time):
        self.decisions += 1
        return [0.0, 1.0] if self.decisions % 20 < 10 else [1.0, 0.0]

    def learn(self, reward):
        raise AssertionError("nobody rewards it")


def mix(wants):
    return sum(wants.values()) / 2
"""


@dataclass(frozen=True)
class Ran:
    """A run and its architecture's names."""

    made: Run

    def node(self, name: str) -> NodeTrack:
        nodes = self.made.scenario.robots[0].architecture.nodes
        return self.made.robots[0].nodes[[node.name for node in nodes].index(name)]

    @property
    def sampled(self) -> Array:
        """What the arbiter read at its ticks."""
        return self.node("choose").register[:, 0]

    @property
    def numbers(self) -> Array:
        """How strongly `back` and `go` held."""
        return self.node("choose").outputs[:, -3:-1]

    @property
    def goes(self) -> Array:
        """1 where it chose to go, 0 where it chose to go back."""
        return self.node("choose").outputs[:, -1]

    @property
    def x(self) -> Array:
        return self.made.signals["r.x"].values

    def channel(self, place: int = 0) -> Array:
        """The set-points of a channel, (T,) since it was first driven."""
        return self.made.robots[0].channels.set_points[:, place]


Make: TypeAlias = Callable[..., Path]


@pytest.fixture
def make(tmp_path: Path) -> Make:
    """All files of a scenario; the path of the scenario."""

    def write(by: str, nodes: tuple[str, ...], channels: str, duration: str = "20 s") -> Path:
        lines = "\n".join(nodes)
        files = {
            "puck": BODY,
            "go": BEHAVIOR.replace("NAME", "go").replace("PACE", str(PACE)),
            "back": BEHAVIOR.replace("NAME", "back").replace("PACE", str(-PACE)),
            "slides": SLIDES.replace("NAME", "slides").replace("PACE", str(PACE)),
            "modes": MODES,
            "choose": ARBITER + by,
            "robot": "specc: 1\nkind: architecture\nname: robot\nbody: puck.yaml\n"
            f"nodes:\n{lines}\nchannels: {channels}",
            "room": "specc: 1\nkind: world\nname: room\narena: {box: [4 m, 3 m]}",
            "tried": "specc: 1\nkind: scenario\nname: tried\nworld: room.yaml\n"
            f"robots: {{r: {{architecture: robot.yaml, at: [1, 1.5]}}}}\nduration: {duration}",
        }
        for name, text in files.items():
            (tmp_path / f"{name}.yaml").write_text(text.lstrip() + "\n", encoding="utf-8")
        (tmp_path / "mine.py").write_text(PYTHON, encoding="utf-8")
        return tmp_path / "tried.yaml"

    return write


def ran(path: Path, *, allow_code: bool = False) -> Ran:
    """The scenario, checked, compiled and run; its behaviors are imitations, and nothing else."""
    assert {found.code for found in check(path)} <= {"S362"}
    compiled = compile_scenario(path, lambda _what, _done, _of: None)
    made = run(compiled.scenario, allow_code=allow_code)
    assert [event.what for event in made.events] == []
    return Ran(made)


def turns(goes: Array) -> tuple[Array, Array]:
    """The ticks at which it first chose to go back, and to go again."""
    change = np.diff(goes)
    return np.flatnonzero(change < 0) + 1, np.flatnonzero(change > 0) + 1


def assert_goes_to_and_fro(robot: Ran) -> None:
    """Between 2 and 2.5 m, as hysteresis has it, several times."""
    backs, agains = turns(robot.goes)
    assert min(len(backs), len(agains)) >= 3
    assert np.all(robot.sampled[backs] > 2.5)
    assert np.all(robot.sampled[backs - 1] <= 2.5)
    assert np.all(robot.sampled[agains] < 2.0)
    assert np.all(robot.sampled[agains - 1] >= 2.0)
    assert 2.5 < np.max(robot.x) < 2.5 + PACE * LATE
    assert 2.0 - PACE * LATE < np.min(robot.x[len(robot.x) // 2 :]) < 2.0
    assert set(robot.channel()[robot.channel() != 0.0]) == {PACE, -PACE}


def test_rules_with_hysteresis_go_to_and_fro(make: Make) -> None:
    assert_goes_to_and_fro(ran(make(HYSTERESIS, (GO, BACK, CHOOSE), EXCLUSIVE)))


def test_a_rule_that_lasts_goes_on_so_long_and_no_longer(make: Make) -> None:
    rules = "{rules: [{choose: back, when: x > far, lasts: 1 s}, {choose: go}]}"

    robot = ran(make(rules, (GO, BACK, CHOOSE), EXCLUSIVE))

    times, (backs, agains) = robot.node("choose").times, turns(robot.goes)
    assert len(agains) >= 3
    assert times[agains] - times[backs[: len(agains)]] == pytest.approx(1.0)
    assert np.all(robot.sampled[backs] > 2.5)
    assert np.all(robot.sampled[agains - 1] < 2.5)


def test_a_plan_goes_to_and_fro_as_its_modes_say(make: Make) -> None:
    robot = ran(make("{plan: modes.yaml}", (GO, BACK, CHOOSE), EXCLUSIVE))

    backs, agains = turns(robot.goes)
    assert min(len(backs), len(agains)) >= 3
    assert np.all(robot.sampled[backs] >= 2.5)
    assert np.all(robot.sampled[agains] <= 2.0)
    assert 2.5 < np.max(robot.x) < 2.5 + PACE * LATE


def test_a_layer_above_suppresses_those_below_where_they_meet_and_nowhere_else(
    make: Make,
) -> None:
    layers = "{subsumption: [{choose: back, when: x > far}, {choose: go}]}"
    slides = GO.replace("go.yaml", "slides.yaml")

    robot = ran(make(layers, (slides, BACK, CHOOSE), PRIORITY))

    assert np.array_equal(robot.numbers[:, 1], np.ones(len(robot.numbers)))
    assert np.array_equal(robot.numbers[:, 0] == 1.0, robot.sampled > 2.5)
    tracks = robot.made.robots[0]
    both = tracks.acting.acts[:, :2].all(axis=1)
    assert both.any()
    names = [channel.name for channel in robot.made.scenario.robots[0].architecture.channels]
    forward, left = names.index("base.forward"), names.index("base.left")
    since = np.searchsorted(tracks.channels.times, tracks.acting.times[both])
    assert np.all(tracks.channels.set_points[since, forward] == -PACE)
    assert np.all(tracks.channels.set_points[since, left] == 0.01)
    assert 2.5 < np.max(robot.x) < 2.5 + PACE * LATE
    assert robot.made.signals["r.y"].values[-1] == pytest.approx(1.5 + 0.01 * 20, abs=0.01)


def test_what_is_sensed_may_inhibit_a_behavior_and_leave_its_channel_to_another(
    make: Make, tmp_path: Path
) -> None:
    inhibited = GO.replace("outside: clip", "outside: inhibit")
    path = make(HYSTERESIS, (inhibited, BACK), "{base.forward: {priority: [go, back]}}")
    narrow = (tmp_path / "go.yaml").read_text(encoding="utf-8").replace("[0, 4]", "[0, 2]")
    (tmp_path / "go.yaml").write_text(narrow, encoding="utf-8")

    compiled = compile_scenario(path, lambda _what, _done, _of: None)
    robot = Ran(run(compiled.scenario))

    track = robot.node("go")
    sampled = robot.node("back").register[:, 0]
    assert np.array_equal(track.acts, sampled <= 2.0)
    assert np.all(robot.node("back").acts)
    assert 2.0 < np.max(robot.x) < 2.0 + PACE * LATE
    assert "outside" in {event.what for event in robot.made.events}


def test_an_arbiter_above_keeps_the_whole_robot_at_rest(make: Make, tmp_path: Path) -> None:
    top = CHOOSE.replace("choose:", "top:").replace("choose.yaml", "top.yaml")
    top = top.replace(MEANS, "choices: {rest: [], work: [choose]}")
    path = make(HYSTERESIS, (GO, BACK, CHOOSE, top), EXCLUSIVE)
    above = ARBITER.replace("name: choose", "name: top").replace("[back, go]", "[rest, work]")
    rules = "{rules: [{choose: rest, when: x > near}, {choose: work}]}"
    (tmp_path / "top.yaml").write_text((above + rules).lstrip() + "\n", encoding="utf-8")

    robot = ran(path)

    assert 2.0 < robot.x[-1] < 2.0 + PACE * LATE
    assert robot.made.signals["r.speed"].values[-1] == pytest.approx(0.0, abs=1e-6)
    assert np.all(robot.goes == 1.0), "it goes on deciding"
    assert not robot.made.robots[0].acting.acts[-1][:2].any()
    levels = [node.level for node in robot.made.scenario.robots[0].architecture.nodes]
    assert levels == [0, 0, 1, 2]


def test_weights_come_to_rest_where_they_are_equal(make: Make) -> None:
    weights = '{weights: {back: "max(x - near, 0) / near", go: "max(far - x, 0) / near"}}'

    robot = ran(make(weights, (GO, BACK, CHOOSE), BLEND))

    back, go = robot.numbers.T
    assert back == pytest.approx(np.maximum(robot.sampled - 2.0, 0.0) / 2.0)
    assert go == pytest.approx(np.maximum(2.5 - robot.sampled, 0.0) / 2.0)
    blend = PACE * (go - back) / (go + back)
    commanded = robot.made.robots[0].channels
    later = robot.node("choose").times + 0.05
    at = np.searchsorted(commanded.times, later[:-1] + 1e-9, side="right") - 1
    assert commanded.set_points[at, 0] == pytest.approx(blend[:-1])
    assert robot.x[-1] == pytest.approx(2.25, abs=0.01)


def test_competing_activations_hold_the_robot_where_neither_is_favored(make: Make) -> None:
    competition = (
        '{competition: {advantage: {back: "tanh((x - far) / soft)", go: "tanh((far - x) / soft)"},'
        " suppresses: {back: {go: 2}, go: {back: 2}}, time: 0.05 s, noise: 0.01}}"
    )

    robot = ran(make(competition, (GO, BACK, CHOOSE), BLEND))

    far = robot.sampled < 2.5 - 0.3
    assert np.all(robot.goes[far] == 1.0)
    assert robot.numbers[far][-1, 1] == pytest.approx(1.0, abs=0.1)
    assert 2.3 < np.mean(robot.x[len(robot.x) // 2 :]) < 2.7
    assert np.max(robot.x) < 2.5 + 0.3


@pytest.mark.parametrize("name", ["choose", "Counting"])
def test_python_of_ones_own_decides_only_where_that_is_allowed(make: Make, name: str) -> None:
    path = make(f'{{module: "mine:{name}"}}', (GO, BACK, CHOOSE), PRIORITY)

    with pytest.raises(UserCodeError, match="--allow-code"):
        ran(path)
    robot = ran(path, allow_code=True)

    wanted = robot.sampled <= 2.5
    if name == "Counting":
        wanted = (np.arange(len(robot.goes)) + 1) % 20 < 10
    assert np.array_equal(robot.goes == 1.0, wanted)


def test_a_channel_is_mixed_by_python_of_ones_own_only_where_that_is_allowed(make: Make) -> None:
    mixed = '{base.forward: {function: "mine:mix"}}'
    layers = "{subsumption: [{choose: back, when: x > far}, {choose: go}]}"
    path = make(layers, (GO, BACK, CHOOSE), mixed)

    with pytest.raises(UserCodeError, match="--allow-code"):
        ran(path)
    robot = ran(path, allow_code=True)

    # Half of what one wants; nothing where both act and want opposite things.
    assert set(robot.channel()) == {0.0, PACE / 2}
    assert 2.5 < robot.x[-1] < 2.5 + PACE * LATE


def test_a_function_is_given_like_quantities_or_refused(make: Make, tmp_path: Path) -> None:
    slows = BACK.replace("x: {from: truth.x", "v: {from: truth.speed")
    path = make(HYSTERESIS, (GO, slows, CHOOSE), '{base.forward: {function: "mine:mix"}}')
    (tmp_path / "back.yaml").write_text(SLOWS.lstrip(), encoding="utf-8")

    (found,) = check(path)

    assert found.code == "S344"
    assert "go" in found.message
