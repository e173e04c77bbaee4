"""How large a run will be: what is told before it begins, against what it then takes."""

import dataclasses
import tracemalloc

import pytest

from runtime.run import CELL, MOST_CELLS, MOST_FRAMES, cells_of, run, steps_between_frames
from runtime.run_size import MOST, OF_CELL, bytes_of, longest
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
    assert light == pytest.approx(11 * cells * OF_CELL), "eleven pictures in ten seconds"


def test_the_light_on_a_small_floor_has_cells_of_five_centimetres() -> None:
    assert cells_of(((0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0))) == (80, 60)


def test_a_large_floor_has_wider_cells_and_not_more() -> None:
    for side in (21.0, 300.0, 1e5):
        columns, rows = cells_of(((0.0, 0.0), (side, 0.0), (side, 0.5 * side), (0.0, 0.5 * side)))
        assert (columns, rows) == (MOST_CELLS, MOST_CELLS // 2)


def test_a_long_run_keeps_no_more_pictures_of_light_at_instants_that_were_wanted() -> None:
    for duration in (3.0, 299.0, 400.0, 3600.0, 86400.0):
        scenario = first_light(duration)
        wanted = round(1.0 / scenario.step)
        every = steps_between_frames(scenario, 1.0)
        assert every % wanted == 0
        assert duration / (every * scenario.step) <= MOST_FRAMES
        assert (every == wanted) == (duration <= MOST_FRAMES)
