"""How large a run will be: what is told before it begins, against what it then takes."""

import dataclasses
import tracemalloc

import pytest

from runtime.run import CELL, run
from runtime.run_size import MOST, OF_NUMBER, bytes_of, longest
from tests.runtime.first_light import first_light


def taken(duration: float) -> float:
    """The most bytes that a run takes while it goes on."""
    tracemalloc.start()
    run(first_light(duration))
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    return float(peak)


def test_a_run_takes_about_as_much_as_was_told() -> None:
    run(first_light(0.5))
    told = bytes_of(first_light(6.0)) - bytes_of(first_light(2.0))

    # What is taken once, however long the run, is in both.
    assert taken(6.0) - taken(2.0) == pytest.approx(told, rel=0.4)


def test_the_longest_run_is_just_allowed() -> None:
    scenario = first_light()
    at_most = longest(scenario)

    allowed = bytes_of(dataclasses.replace(scenario, duration=at_most))
    assert allowed <= MOST < bytes_of(dataclasses.replace(scenario, duration=1.1 * at_most))


def test_a_finer_step_and_the_light_on_the_floor_count() -> None:
    scenario = first_light(10.0)
    finer = dataclasses.replace(scenario, step=scenario.step / 2.0)

    assert bytes_of(finer) > bytes_of(scenario)
    xs, ys = zip(*scenario.world.arena, strict=True)
    cells = (max(xs) - min(xs)) * (max(ys) - min(ys)) / CELL**2
    light = bytes_of(scenario, light_every=1.0) - bytes_of(scenario)
    assert light == pytest.approx(11 * cells * OF_NUMBER), "eleven pictures in ten seconds"
