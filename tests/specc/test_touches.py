"""Where robots touch what: held against poses and shapes, which know nothing of contacts."""

from functools import cache

import numpy as np
import pytest

from runtime.container import ArtifactError
from runtime.recording.happened import Happened, from_bytes, to_bytes
from runtime.run import Run
from specc.scenarios.pictured import pictured
from specc.scenarios.simulating import simulate_scenario


@cache
def walked() -> Run:
    """A round robot that bumps into boxes and walls."""
    return simulate_scenario("specs/scenarios/random_walker.yaml", duration="20 s").run


def test_a_round_robot_touches_at_its_radius_from_its_middle() -> None:
    run = walked()
    (disc,) = run.scenario.robots[0].body.shape.discs
    poses = run.world.poses[:, -1, :2]

    assert len(run.touches) > 5
    for touch in run.touches:
        row = int(np.argmin(np.abs(run.world.times - touch.time)))
        away = float(np.hypot(touch.x - poses[row, 0], touch.y - poses[row, 1]))
        assert away == pytest.approx(disc.radius, abs=0.012)  # of 20 ms at 0.5 m/s


def test_walls_are_touched_where_they_are() -> None:
    run = walked()
    arena = np.array(run.scenario.world.arena)
    (left, low), (right, high) = arena.min(axis=0), arena.max(axis=0)
    walls = [touch for touch in run.touches if touch.what == "walls"]

    assert walls
    for touch in walls:
        gaps = (touch.x - left, right - touch.x, touch.y - low, high - touch.y)
        assert min(map(abs, gaps)) < 0.002


def test_a_touch_begins_where_more_is_touched_than_before() -> None:
    run = walked()
    steps = np.rint(np.array([touch.time for touch in run.touches]) / run.scenario.step)
    contacts = run.world.contacts[:, 0]
    rises = np.flatnonzero(np.diff(contacts, prepend=0.0) > 0.0)

    assert set(rises.tolist()) <= set(steps.astype(int).tolist())
    assert all(contacts[step] > 0.0 for step in steps.astype(int))


def test_pictures_mark_every_touch_where_it_was() -> None:
    run = walked()
    _, trails = pictured(run, ())

    assert [(m.time, m.x, m.y) for m in trails.contacts] == [
        (t.time, t.x, t.y) for t in run.touches
    ]


def test_what_happened_is_read_back_as_it_was_written() -> None:
    run = walked()
    told = Happened(run.layout.things, run.touches, run.audit.jams)

    assert from_bytes(to_bytes(told)) == told


@pytest.mark.parametrize("data", [b"", b"{}", b"[1]", b'{"format": 7}', b'{"format": 1}'])
def test_what_tells_nothing_is_refused(data: bytes) -> None:
    with pytest.raises(ArtifactError):
        from_bytes(data)
