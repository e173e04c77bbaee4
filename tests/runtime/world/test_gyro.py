"""A gyro as a body declares it: what it says in a world, and how far its sum strays."""

import math
from pathlib import Path

import numpy as np

from compiler.architecture.bodies import lower_body
from compiler.findings import Findings
from runtime.scheduler.sensors import SensorBank
from runtime.world.model import Body, Pose
from runtime.world.sensing import senses_of
from runtime.world.world import Inhabitant, SimulatedWorld
from spec_schema.body import BodySpec
from spec_schema.load import load
from tests.runtime.world.worlds import world

STEP, EVERY, NOISE = 0.01, 0.05, math.radians(2.0)
SAMPLES = 400


def declared(folder: Path) -> Body:
    """A robot with a gyro, from its file."""
    path = folder / "turner.yaml"
    path.write_text(
        "specc: 1\nkind: body\nname: turner\nshape: {circle: 12 cm}\nmass: 3 kg\n"
        "drive: {differential: {track: 20 cm, speed: 0.5 m/s, turn: 3 rad/s}}\n"
        "sensors:\n  gyro: {senses: gyro, every: 50 ms, noise: {turn: 2 deg/s}}\n"
    )
    loaded = load(path)
    assert isinstance(loaded.spec, BodySpec)
    findings = Findings(loaded)
    part = lower_body(loaded.spec, loaded, findings)
    assert not findings.diagnostics
    return part.body


def test_the_sum_of_a_gyro_is_the_heading_within_what_its_noise_adds_up_to(
    tmp_path: Path,
) -> None:
    """The noise of N samples adds up to noise * every * sqrt(N), and is white and unbiased."""
    body = declared(tmp_path)
    robot = Inhabitant("r", body, Pose(2.0, 1.5, 0.0), ("base.speed", "base.turn"))
    sim = SimulatedWorld(world(), [robot], STEP, 1, senses=senses_of)
    bank = SensorBank([("r", body)], sim, STEP, seed=3)
    sim.command(0, np.array([0.0, 0.5]), np.array([True, True]))
    said, true = [], []
    for instant in range(round(SAMPLES * EVERY / STEP)):
        for delivery in bank.due(instant):
            said.append(float(delivery.readings[0]))
            true.append(sim.motion(0).turn)
        sim.advance()

    assert len(said) == SAMPLES
    errors = np.array(said) - true
    assert abs(np.std(errors) / NOISE - 1.0) < 4.0 / math.sqrt(2 * SAMPLES)
    assert abs(np.corrcoef(errors[1:], errors[:-1])[0, 1]) < 4.0 / math.sqrt(SAMPLES)
    heading = float(sim.poses()[0, 2])
    coarse = 0.5 * EVERY / 2.0  # a turn rate that ramps up is sampled every 50 ms
    assert abs(sum(said) * EVERY - heading) < 4.0 * NOISE * EVERY * math.sqrt(SAMPLES) + coarse
