"""The unit of a part of a formula, against what a hand works out."""

import pytest

import specc
from verifier.diagnosis.part_units import unit_of
from verifier.diagnosis.wraps import wraps_of

JOINT = """
specc: 1
kind: behavior
name: joint
about: A joint under a controller.
state:
  q: {unit: deg, domain: [-90, 90], role: both, relates: {agent: it, environment: there}}
  w: {unit: rad/s, domain: [-8, 8], role: both, relates: {agent: it, environment: there}}
  z: {unit: m, domain: [-9, 9], role: both, relates: {agent: it, environment: there}}
  v: {unit: m/s, domain: [-9, 9], role: both, relates: {agent: it, environment: there}}
control:
  target: {unit: deg, domain: [-80, 80], default: 0}
  goal: {unit: m, domain: [-9, 9], default: 0}
constants:
  kp: {value: 16, unit: 1/s^2, about: stiffness over inertia}
  kd: {value: 4, unit: 1/s, about: damping over inertia}
  k: {value: 2, unit: 1/s, about: speed wanted per metre}
  lag: {value: 0.4, unit: s, about: time constant}
field:
  formula:
    q: w
    w: kp*(target - q) - kd*w - 2*kp*cos(q)
    z: v
    v: (k*(goal - z) - v)/lag
"""


@pytest.fixture(scope="module")
def units(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    path = tmp_path_factory.mktemp("joint") / "joint.yaml"
    path.write_text(JOINT, encoding="utf-8")
    program = specc.load_program(path)
    return {each.words: unit_of(each, program).text for each in wraps_of(program)}


@pytest.mark.parametrize(
    ("words", "unit"),
    [
        ("the rate of w", "rad/s^2"),
        ("(kp * (target - q)) - (kd * w)", "rad/s^2"),
        ("target - q", "deg"),
        ("the rate of v", "m/s^2"),
        ("(k * (goal - z)) - v", "m/s"),
        ("goal - z", "m"),
    ],
)
def test_a_part_is_told_in_its_own_unit(units: dict[str, str], words: str, unit: str) -> None:
    assert units[words] == unit
