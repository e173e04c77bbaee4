"""A robot in a pen that learns when to drive on and when to turn: a training of a few seconds."""

from pathlib import Path
from typing import Final

from lcs.policies.decision_list import DecisionList
from runtime.progress import in_silence
from runtime.scenario import Scenario
from specc.loading import load_scenario
from specc.training.checkpoint import keep
from specc.training.course import Course
from specc.training.settings import Settings
from specc.training.training import go_on
from specc.training.workers import Workers

SMALL: Final = Settings(episodes=20, first=6, each=6, mended=2, varied=2, tried_in=3, rules=3)
"""Two generations."""

FILES: Final = {
    "pen_world.yaml": """\
specc: 1
kind: world
name: pen
arena: {box: [2 m, 2 m]}
""",
    "mouse.yaml": """\
specc: 1
kind: body
name: mouse
shape: {circle: 10 cm}
mass: 1 kg
drive: {differential: {track: 16 cm, speed: 0.5 m/s, turn: 3 rad/s}}
rest: {base.speed: stop, base.turn: stop}
sensors:
  ahead: {senses: range, at: [0, 0], width: 60 deg, reach: 2 m, rays: 5, every: 200 ms}
""",
    "go.yaml": """\
specc: 1
kind: behavior
name: go
state:
  room:
    unit: m
    domain: [0, 2]
    role: both
    relates: {agent: front of the base, environment: the nearest thing ahead}
control:
  speed: {unit: m/s, domain: [0, 0.5], default: 0.4}
field:
  formula: {room: -speed * (1 + 0 * room)}
realizes:
  speed: base.speed as set-point
""",
    "turn.yaml": """\
specc: 1
kind: behavior
name: turn
state:
  heading:
    unit: rad
    domain: [-pi, pi]
    kind: periodic
    role: driven
    relates: {agent: direction of travel, environment: where it pointed at first}
  room:
    unit: m
    domain: [0, 2]
    role: sensed
    hold: 1
    relates: {agent: front of the base, environment: the nearest thing ahead}
control:
  spin: {unit: rad/s, domain: [-3, 3], default: 2}
field:
  formula: {heading: spin * (1 + 0 * room)}
realizes:
  spin: base.turn as set-point
""",
    "choose.yaml": """\
# Who acts in the pen.
specc: 1
kind: arbiter
name: choose
reads:
  ahead: {unit: m, domain: [0, 2], about: the nearest thing ahead}   # of five rays
choices: [go, turn]
by:   # no rules yet
  alcsr: {}
agreement: {share: 0.9}   # of its decisions
""",
    "pen_robot.yaml": """\
specc: 1
kind: architecture
name: pen_robot
body: mouse.yaml
nodes:
  go: {behavior: go.yaml, period: 200 ms, sense: {room: ahead.range}}
  turn: {behavior: turn.yaml, period: 200 ms, sense: {room: ahead.range}}
  choose:
    arbiter: choose.yaml
    period: 400 ms
    sense: {ahead: ahead.range}
    choices: {go: [go], turn: [turn]}
""",
    "pen.yaml": """\
specc: 1
kind: scenario
name: pen
world: pen_world.yaml
robots:
  r: {architecture: pen_robot.yaml, at: random}
duration: 4 s
step: 20 ms
require:
  - always r.clearance > 0 m
train:
  arbiter: r.choose
  reward: 5 * fast - 5 * (room < 0.03)
  measures:
    fast: {mean: r.speed}
    room: {least: r.clearance}
  ends_when: r.clearance < 1 mm
""",
}


def written_in(folder: Path) -> Path:
    """The scenario's file, with all that it names beside it."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in FILES.items():
        (folder / name).write_text(text)
    return folder / "pen.yaml"


def pen_in(folder: Path) -> Scenario:
    """The scenario, compiled from such files."""
    return load_scenario(written_in(folder)).scenario


def trained(
    scenario: Scenario, *, jobs: int = 1, course: Course | None = None, kept: Path | None = None
) -> Course:
    """The course of a small training, from its beginning or from where it is."""

    def keeping(now: Course) -> None:
        if kept is not None:
            keep(now, kept)

    with Workers(scenario, jobs) as workers:
        return go_on(course or Course(), scenario, SMALL, workers, in_silence, keeping)


def equal(one: DecisionList, other: DecisionList) -> bool:
    """Whether two lists are the same to the bit."""
    names = ("action", "lower", "upper", "right", "wrong")
    pairs = ((getattr(one, name), getattr(other, name)) for name in names)
    return one.otherwise == other.otherwise and all(
        a.tobytes() == b.tobytes() and a.shape == b.shape for a, b in pairs
    )
