"""Scattered things and random robots stand free, by the seed alone."""

import math
import pickle
from dataclasses import replace

import numpy as np
import pytest

from runtime.world.footprint import in_world
from runtime.world.kernels.nearness import gap
from runtime.world.layout import Layout, NoRoomError, lay_out
from runtime.world.model import Pose
from tests.runtime.world.worlds import body, box, round_, scatter, thing, world

ROBOTS = [("here", body(), Pose(1.0, 1.0, 0.0)), ("anywhere", body(), None)]


def laid(seed: int = 3) -> Layout:
    scattered = [scatter("crate", 12, box(0.3, 0.2), fixed=0.25), scatter("post", 5, round_(0.05))]
    desk = thing("desk", box(0.8, 0.5), (3.0, 2.0, 0.5), is_fixed=True)
    return lay_out(world([desk], scattered=scattered), ROBOTS, seed)


def test_all_that_is_laid_keeps_its_gap() -> None:
    found = laid()
    shapes = [(t.shape, t.pose) for t in found.things]
    shapes += [(b.shape, pose) for (_, b, _), pose in zip(ROBOTS, found.starts, strict=True)]
    outlines = [in_world(*shape) for shape in shapes]

    for index, (edges, circles) in enumerate(outlines):
        points = np.vstack([edges[:, :2], circles[:, :2]])
        assert ((points > 0.0) & (points < (4.0, 3.0))).all()
        for other_edges, other_circles in outlines[:index]:
            taken = np.ones(len(other_edges) + len(other_circles), dtype=np.bool_)
            assert gap(edges, circles, other_edges, other_circles, taken, 9.0) > 0.02 - 1e-12


def test_names_sizes_masses_and_shares_are_those_declared() -> None:
    crates = [t for t in laid().things if t.name.startswith("crate_")]

    assert [t.name for t in crates] == [f"crate_{k}" for k in range(1, 13)]
    assert sum(t.is_fixed for t in crates) == 3
    for crate in crates:
        (x, _) = crate.shape.polygons[0].vertices[1]
        assert 0.7 * 0.15 <= x <= 1.3 * 0.15
        assert crate.mass == pytest.approx((x / 0.15) ** 2)


def test_the_seed_says_where_all_stand() -> None:
    assert laid(3) == laid(3)
    assert laid(3).starts[1] != laid(4).starts[1]
    assert laid(3).things[1] != laid(4).things[1]
    assert laid(3).starts[0] == laid(4).starts[0] == Pose(1.0, 1.0, 0.0)


def test_an_area_is_kept() -> None:
    part = replace(scatter("post", 8, round_(0.05)), area=(0.5, 0.5, 1.5, 1.0))

    found = lay_out(world(scattered=[part]), [], 1)

    assert all(0.5 <= t.pose.x <= 1.5 and 0.5 <= t.pose.y <= 1.0 for t in found.things)


def test_where_there_is_no_room_the_error_names_what_has_none() -> None:
    part = replace(scatter("desk", 30, box(0.8, 0.8)), origin="office.yaml:9:3")

    with pytest.raises(NoRoomError, match="no room for 'desk_") as caught:
        lay_out(world(scattered=[part]), [], 1)

    assert caught.value.origin == "office.yaml:9:3"


def test_nothing_is_laid_within_another_thing() -> None:
    """A hall fills nearly everything; a post in it would cross no outline."""
    hall = thing("hall", box(3.6, 2.6), (2.0, 1.5, 0.0), is_fixed=True)

    with pytest.raises(NoRoomError):
        lay_out(world([hall], scattered=[scatter("post", 1, round_(0.1))]), [], 1)


def test_what_hangs_takes_no_room_from_what_is_lower() -> None:
    lamp = thing("lamp", box(3.8, 2.8), (2.0, 1.5, 0.0), is_fixed=True, heights=(0.15, 0.3))

    (start,) = lay_out(world([lamp]), [("r", body(high=0.1), None)], 1).starts

    assert 0.12 < start.x < 3.88


def test_places_in_a_bent_arena_are_inside_it() -> None:
    bent = ((0.0, 0.0), (3.0, 0.0), (3.0, 1.0), (1.0, 1.0), (1.0, 3.0), (0.0, 3.0))
    part = scatter("post", 20, round_(0.05), gap=0.01)

    found = lay_out(replace(world(scattered=[part]), arena=bent), [], 1)

    for post in found.things:
        assert post.pose.x < 1.0 or post.pose.y < 1.0
    headings = [post.pose.heading for post in found.things]
    assert min(headings) < -math.pi / 2.0 < math.pi / 2.0 < max(headings)


def test_that_there_is_no_room_can_be_told_by_another_process() -> None:
    told = pickle.loads(pickle.dumps(NoRoomError("box_3", "w.yaml:4:3")))  # noqa: S301 our own
    assert (told.name, told.origin) == ("box_3", "w.yaml:4:3")
    assert str(told) == str(NoRoomError("box_3", ""))
