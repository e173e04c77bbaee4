"""Small robots in small worlds: real specs, the real compiler, and the real world."""

import tempfile
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import numpy as np

from compiler.world.scenario import CompiledScenario, compile_scenario
from runtime.arrays import Array
from runtime.progress import in_silence
from runtime.scenario import Scenario
from runtime.scheduler.observer import Observer
from runtime.start import started

PROBE = """
shape: {circle: 12 cm}
mass: 3 kg
friction: 0.2
drive: {differential: {track: 20 cm, speed: 0.5 m/s, turn: 3 rad/s}}
sensors:
  ahead: {senses: range, at: [12 cm, 0], reach: 3 m, every: 10 ms}
  bumper: {senses: bump, every: 10 ms}
  beacon: {senses: sight, of: [light], reach: 6 m, every: 10 ms}
  lamp: {senses: light, height: 9 cm, every: 10 ms}
"""

AHEAD = """
state:
  ahead:
    {unit: m, domain: [0, 6], role: both,
     relates: {agent: front of the base, environment: the nearest thing ahead}}
"""

BEHAVIORS = {
    # Drives on, whatever is ahead.
    "go": f"""{AHEAD}
control: {{speed: {{unit: m/s, domain: [-2, 2], default: 0.4}}}}
field: {{formula: {{ahead: -speed}}}}
realizes: {{speed: base.speed as set-point}}
""",
    # Drives until something is near.
    "halt": f"""{AHEAD}
control:
  pace: {{unit: m/s, domain: [0, 2], default: 0.4}}
  near: {{unit: m, domain: [0, 3], default: 1}}
output: {{speed: {{unit: m/s, is: "where(ahead > near, pace, 0)"}}}}
field: {{formula: {{ahead: "where(ahead > near, -pace, 0)"}}}}
table: {{keep: code}}
realizes: {{speed: base.speed as set-point}}
""",
    # Keeps an eye on what is ahead, and moves nothing.
    "watch": f"""{AHEAD}
constants: {{rate: {{value: 0.5, unit: 1/s}}}}
output: {{half: {{unit: m, is: ahead / 2}}}}
field: {{formula: {{ahead: -rate * ahead}}}}
""",
    # Turns at one rate for ever.
    "spin": """
state:
  bearing:
    {unit: rad, domain: [-pi, pi], kind: periodic, role: both,
     relates: {agent: direction of travel, environment: the light}}
control: {rate: {unit: rad/s, domain: [-3, 3], default: 0.5}}
field: {formula: {bearing: -rate}}
realizes: {rate: base.turn as set-point}
""",
}

GO = "{behavior: go.yaml, period: 50 ms, sense: {ahead: ahead.range}}"
WATCH = "{{behavior: watch.yaml, period: {} ms, sense: {{ahead: ahead.range}}}}"
SPIN = "{behavior: spin.yaml, period: 50 ms, sense: {bearing: beacon.bearing}}"


def halt(
    response: str = "0 ms", near: str = "1 m", period: str = "10 ms", pace: str = "0.4 m/s"
) -> str:
    """A node that drives until something is near."""
    return (
        f"{{behavior: halt.yaml, period: {period}, response_time: {response}, "
        f"sense: {{ahead: ahead.range}}, set: {{near: {near}, pace: {pace}}}}}"
    )


def robot(at: str, *, body: str = PROBE, channels: str = "", **nodes: str) -> dict[str, str]:
    """What one robot is made of: where it starts, its body, and its nodes by name."""
    lines = "".join(f"  {name}: {node}\n" for name, node in nodes.items())
    return {"at": at, "body": body, "nodes": lines, "channels": channels}


def scenario(
    *robots: dict[str, str],
    world: str = "arena: {box: [4 m, 3 m]}",
    duration: str = "2 s",
    step: str = "5 ms",
    seed: int = 1,
) -> Scenario:
    """Compile robots r0, r1, ... in a world.

    Raises:
        SpecError: something is wrong with it.
    """
    return compiled(*robots, world=world, duration=duration, step=step, seed=seed).scenario


def compiled(
    *robots: dict[str, str],
    world: str = "arena: {box: [4 m, 3 m]}",
    duration: str = "2 s",
    step: str = "5 ms",
    seed: int = 1,
) -> CompiledScenario:
    """The same, with the warnings."""
    files = {"world.yaml": _headed("world", "world", world)}
    lines = []
    for place, made in enumerate(robots):
        files[f"body{place}.yaml"] = _headed("body", f"body{place}", made["body"])
        nodes = f"body: body{place}.yaml\nnodes:\n{made['nodes']}{made['channels']}"
        files[f"mind{place}.yaml"] = _headed("architecture", f"mind{place}", nodes)
        lines.append(f"  r{place}: {{architecture: mind{place}.yaml, at: {made['at']}}}\n")
    body = (
        f"world: world.yaml\nrobots:\n{''.join(lines)}"
        f"duration: {duration}\nstep: {step}\nseed: {seed}\n"
    )
    return _compiled(tuple(files.items()), _headed("scenario", "scene", body))


@cache
def _compiled(files: tuple[tuple[str, str], ...], text: str) -> CompiledScenario:
    behaviors = [(f"{name}.yaml", _headed("behavior", name, it)) for name, it in BEHAVIORS.items()]
    with tempfile.TemporaryDirectory() as folder:
        for name, content in (*behaviors, *files, ("scene.yaml", text)):
            (Path(folder) / name).write_text(content, encoding="utf-8")
        return compile_scenario(Path(folder) / "scene.yaml", in_silence)


def _headed(kind: str, name: str, text: str) -> str:
    return f"specc: 1\nkind: {kind}\nname: {name}\n{text}"


class Started:
    """A world with the scheduler that drives the robots in it, at instant 0."""

    def __init__(
        self, made: Scenario, observer: Observer | None = None, *, allow_code: bool = False
    ) -> None:
        begun = started(made, allow_code=allow_code, observer=observer)
        self.scenario = made
        self.world, self.scheduler = begun.world, begun.scheduler

    def steps(self, seconds: float | None = None) -> Iterator[float]:
        """Step by step to the end, or so many seconds; gives the time after each."""
        duration = self.scenario.duration if seconds is None else seconds
        for _ in range(round(duration / self.scenario.step)):
            self.scheduler.step()
            yield self.world.time

    def finish(self) -> Array:
        """To the end; the poses (n, 3) there, of things, then robots."""
        for _ in self.steps():
            pass
        return self.world.poses()


def hashes(started: Started) -> list[str]:
    """The hash of the state before the first step and after each."""
    found = [started.scheduler.state_hash().hex()]
    return found + [started.scheduler.state_hash().hex() for _ in started.steps()]


def way(made: Scenario) -> Array:
    """Where all are after every step: (steps + 1, n, 3)."""
    started = Started(made)
    found = [started.world.poses()]
    found += [started.world.poses() for _ in started.steps()]
    return np.array(found)
