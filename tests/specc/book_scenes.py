"""A small robot in an empty room, as specs: one behavior, who sets its control, and a scenario."""

from pathlib import Path

FILES = {
    "face.yaml": """\
# Facing a light.
#
# It turns, and does not come closer.
specc: 1
kind: behavior
name: face
about: Turn to a light.
state:
  bearing:
    unit: rad
    domain: [-pi, pi]
    kind: periodic
    role: both
    relates: {agent: direction of travel, environment: direction of the light}
control:
  gain: {unit: 1/s, domain: [0.5, 3], default: 1.5}
output:
  turn: {unit: rad/s, is: gain * sin(bearing)}
  error: {unit: deg, is: abs(bearing)}
field:
  formula:
    bearing: -gain * sin(bearing)
realizes:
  turn: base.turn as set-point
feasibility: {level: hypothetical}
fidelity:
  tolerance: {bearing: 0.1 rad}
  horizon: 1 s
""",
    "arbiters/eager.yaml": """\
specc: 1
kind: arbiter
name: eager
about: Eager where the light is far, else calm.
reads:
  far: {unit: m, domain: [0, 8]}
constants:
  near: {value: 2, unit: m}
choices: [calm, eager]
by:
  rules:
    - {choose: eager, when: far > near}
    - {choose: calm}
""",
    "robots/turner.yaml": """\
specc: 1
kind: architecture
name: turner
about: Turn to a light, eagerly from afar.
body: ../body.yaml
nodes:
  index:
    behavior: ../face.yaml
    period: 50 ms
    response_time: 50 ms
    sense: {bearing: eye.bearing}
  choose:
    arbiter: ../arbiters/eager.yaml
    period: 100 ms
    sense: {far: eye.distance}
    choices:
      calm: [index]
      eager: {act: [index], set: {index.gain: 2 1/s}}
""",
    "body.yaml": """\
specc: 1
kind: body
name: small
shape: {circle: 12 cm}
height: [0, 10 cm]
mass: 3 kg
friction: 0.2
drive: {differential: {track: 20 cm, speed: 0.5 m/s, turn: 3 rad/s}}
rest: {base.speed: stop, base.turn: stop}
sensors:
  eye: {senses: sight, of: [light], reach: 8 m, every: 50 ms}
""",
    "room.yaml": """\
specc: 1
kind: world
name: room
arena: {box: [4 m, 3 m]}
lights:
  lamp: {at: [3, 2], power: 10 cd, height: 17 cm}
""",
    "turning.yaml": """\
specc: 1
kind: scenario
name: turning
about: Turn to the light in a room.
world: room.yaml
robots:
  r: {architecture: robots/turner.yaml, at: [1 m, 1 m, 90 deg]}
duration: 2 s
seed: 3
require:
  - eventually within 2 s r.eye.bearing < 20 deg
""",
}
ARCHITECTURE = "robots/turner.yaml"
SCENARIO = "turning.yaml"


def laid_down(folder: Path) -> Path:
    """The specs as files in a folder."""
    for name, text in FILES.items():
        file = folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")
    return folder
