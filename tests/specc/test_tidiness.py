"""Whether a crate is worth fetching: the gap by plane geometry, and patience that ends."""

import math
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from runtime.program import Program
from runtime.simulate import simulate
from specc.loading import compile_spec

ASIDE = math.radians(15.0)


@cache
def tidiness() -> Program:
    """The compiled behavior."""
    return compile_spec(Path(__file__).parents[2] / "specs" / "tidiness.yaml").program


def told(output: str, **sensed: float) -> float:
    """What it tells of a crate at the very moment that it sees this."""
    program = tidiness()
    seen = {"crate": 1.0, "left": 2.0, "right": 2.0, **sensed}
    names = [each.name for each in program.outputs]
    return float(simulate(program, seen, 0.01, every=0.01).outputs[0, names.index(output)])


def ranges(walls: list[tuple[float, float]]) -> dict[str, float]:
    """What three rays say in a room whose walls are so far away in these directions (m, rad)."""
    rays = {"wall": 0.0, "leftwards": ASIDE, "rightwards": -ASIDE}
    return {
        name: min(far / math.cos(ray - way) for far, way in walls if math.cos(ray - way) > 0.0)
        for name, ray in rays.items()
    }


@pytest.mark.parametrize("seed", range(8))
def test_the_gap_is_that_to_the_line_of_the_wall_from_wherever_it_is_seen(seed: int) -> None:
    rng = np.random.default_rng(seed)
    far, way = rng.uniform(0.8, 1.5), rng.uniform(-1.0, 1.0)
    bearing, gap = rng.uniform(-0.25, 0.25), rng.uniform(0.05, 0.4)
    distance = (far - gap) / math.cos(bearing - way)  # so that the crate is so far from the wall

    said = told("gap_seen", **ranges([(far, way)]), bearing=bearing, distance=distance)

    assert said == pytest.approx(gap, abs=1e-9)


def test_in_a_corner_the_gap_is_the_room_behind_the_crate() -> None:
    corner = ranges([(1.0, math.radians(45.0)), (1.0, math.radians(-45.0))])

    said = told("gap_seen", **corner, bearing=0.0, distance=1.0)

    assert said == pytest.approx(math.sqrt(2.0) - 1.0)


def test_a_crate_that_is_pushed_along_a_wall_is_about_as_near_to_it_as_the_robot_is() -> None:
    along = ranges([(2.5, 0.0)])

    assert told("gap_seen", **along, bearing=0.0, distance=0.3, right=0.2) < 0.31
    assert told("gap_seen", **along, bearing=0.0, distance=1.0, right=0.2) == pytest.approx(1.5)


def test_a_crate_that_stays_near_is_given_up_and_tried_again_after_a_rest() -> None:
    seen = {"crate": 1.0, "distance": 0.25, "gap": 1.0, "weariness": 0.0}

    switches = simulate(tidiness(), seen, 24.0).switches

    given_up = 15.0 * math.log(1.0 / 0.3)  # weariness goes to 1 with 15 s; to 0.7 takes this
    assert list(switches.entered) == [2, 0]  # given up, and untidy again
    assert switches.times == pytest.approx([given_up, given_up + 5.0 * math.log(0.7 / 0.3)])
