"""Principle 1c: no point of space is occupied by two things at once."""

from functools import cache

import numpy as np
import pytest

from runtime.scenario import Scenario
from runtime.world.audit import Audit
from spec_schema.diagnostics import SpecError
from tests.principles.overlap import deepest
from tests.principles.scenes import GO, PROBE, SPIN, Started, robot, scenario

CROWD = """
arena: {box: [3 m, 3 m]}
scatter:
  box: {shape: {box: [20 cm, 12 cm]}, count: 12, mass: 0.5 kg, sizes: [0.7, 1.3], gap: 1 cm}
  can: {shape: {circle: 6 cm}, count: 8, mass: 0.3 kg, gap: 1 cm}
  post: {shape: {box: [15 cm, 15 cm]}, count: 4, fixed: true, gap: 1 cm}
"""
SQUARE = PROBE.replace("{circle: 12 cm}", "{box: [24 cm, 20 cm]}")
MOST = 2e-3
"""Metres: so deep contacts may be pressed, and no deeper."""


def ploughed() -> Scenario:
    """Three robots plough through a crowd, round and round, for 6 s."""
    hard = GO[:-1] + ", set: {speed: 0.5 m/s}}"
    return scenario(
        robot("random", go=hard, spin=SPIN),
        robot("random", go=hard, body=SQUARE),
        robot("random", go=hard, spin=SPIN),
        world=CROWD,
        duration="6 s",
    )


@cache
def crowd() -> tuple[float, float, Audit]:
    """How deep things stood in one another: at first, ever, and as the world tells of itself."""
    made = ploughed()
    started = Started(made)
    world = started.world
    shapes = [thing.shape for thing in world.layout.things] + [r.body.shape for r in made.robots]
    arena = np.array(made.world.arena)
    first = worst = deepest(shapes, world.poses(), arena)
    for k, _ in enumerate(started.steps()):
        if k % 12 == 0:
            worst = max(worst, deepest(shapes, world.poses(), arena))
    return first, worst, world.audit()


def test_in_a_crowd_that_is_ploughed_nothing_stands_in_anything_else() -> None:
    """1c: by an independent measure, over every footprint and wall."""
    first, worst, _ = crowd()

    assert first < 0.0
    assert 0.0 < worst < MOST


def test_the_world_tells_of_itself_how_deep_contacts_were() -> None:
    """1c: the audit of the run says no less than is found from outside."""
    _, worst, audit = crowd()

    assert worst <= audit.depth + 1e-4  # the slop: outlines are drawn that much smaller
    assert audit.depth < MOST


def test_a_world_that_begins_with_two_things_in_one_place_is_refused() -> None:
    """1c: at the beginning, too."""
    with pytest.raises(SpecError, match="S327"):
        scenario(
            robot("[2 m, 1.5 m]", go=GO),
            world="arena: {box: [4 m, 3 m]}\n"
            "things: {crate: {shape: {box: [0.3, 0.2]}, at: [2.2, 1.5], mass: 1 kg}}",
        )
