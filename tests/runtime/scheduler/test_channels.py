"""Each way in which a channel is resolved, who replaces whom, and what an idle channel does."""

import math
from collections.abc import Sequence

import pytest

from runtime.architecture import Resolution, Way
from runtime.program import Program
from runtime.scheduler.observer import What
from runtime.scheduler.scheduler import Scheduler
from tests.runtime.behaviors import control, formula_program, state
from tests.runtime.scheduler.plane import (
    STEP,
    N,
    Noted,
    Plain,
    Plane,
    architecture,
    resolution,
    scenario,
)


def wants(speed: float) -> Program:
    """A behavior that always wants `speed`, and may be told when to act by what it senses."""
    return formula_program(
        (state("x", -1e6, 1e6),), {"x": "0"}, (control("speed", -99.0, 99.0, speed),)
    )


def node(name: str, speed: float, when: str | None = None, replaces: Sequence[str] = ()) -> N:
    """A node that commands channel x; `when` reads the instant as `x`."""
    commands = {"x": ("speed", "set-point")}
    return N(
        name, wants(speed), STEP, 0.0, {"x": "pos.x"}, commands, acts_when=when, replaces=replaces
    )


def driven(
    nodes: Sequence[N], way: Resolution, instants: int = 5, rest: str = "stop", limit: float = 99.0
) -> tuple[list[float], Noted]:
    """What channel x gets at each instant; NaN where it rolls freely."""
    plane = Plane(outside=lambda _robot, _sensor, time: (round(time / STEP), 0.0))
    noted = Noted()
    wired = architecture(nodes, ways={"x": way}, rest=rest, limit=limit)
    scheduler = Scheduler(scenario(wired), plane, Plain(plane), observer=noted)
    values = []
    for _ in range(instants):
        scheduler.step()
        agent = scheduler.agents[0]
        values.append(float(agent.set_points[0]) if agent.driven[0] else math.nan)
    return values, noted


A, B, C = node("a", 1.0), node("b", 4.0), node("c", -10.0, "x 2 eq x 3 eq or")


@pytest.mark.parametrize(
    ("way", "nodes", "expected"),
    [
        (resolution(Way.SINGLE, 0), [A], [1.0] * 5),
        (resolution(Way.SUM, 0, 1, 2), [A, B, C], [5.0, 5.0, -5.0, -5.0, 5.0]),
        (resolution(Way.PRIORITY, 2, 1, 0), [A, B, C], [4.0, 4.0, -10.0, -10.0, 4.0]),
        (resolution(Way.PRIORITY, 0, 1, 2), [A, B, C], [1.0] * 5),
        # Nobody weighs them: each counts alike.
        (resolution(Way.BLEND, 0, 1, 2), [A, B, C], [2.5, 2.5, -5.0 / 3.0, -5.0 / 3.0, 2.5]),
    ],
)
def test_a_channel_is_resolved_in_its_way(
    way: Resolution, nodes: Sequence[N], expected: Sequence[float]
) -> None:
    values, noted = driven(nodes, way)

    assert values == pytest.approx(expected)
    assert not noted.events


@pytest.mark.parametrize(
    ("way", "nodes", "expected"),
    [
        (resolution(Way.SUM, 0, 1, 2), [A, B, C], {0: (1, 1, 0), 2: (1, 1, 1), 4: (1, 1, 0)}),
        (resolution(Way.PRIORITY, 2, 1, 0), [A, B, C], {0: (0, 1, 0), 2: (0, 0, 1), 4: (0, 1, 0)}),
        (resolution(Way.PRIORITY, 0, 1, 2), [A, B, C], {0: (1, 0, 0)}),
        (resolution(Way.BLEND, 0, 2), [A, C], {0: (1, 0), 2: (0.5, 0.5), 4: (1, 0)}),
        (resolution(Way.EXCLUSIVE, 1, 0), [A, C], {0: (1, 0), 2: (0, 1), 4: (1, 0)}),
        (resolution(Way.SINGLE, 0), [C], {0: (0,), 2: (1,), 4: (0,)}),
    ],
)
def test_whoever_has_its_way_is_told_where_that_changes(
    way: Resolution, nodes: Sequence[N], expected: dict[int, tuple[float, ...]]
) -> None:
    _, noted = driven(nodes, way, 8)

    told = {instant: how.weights for instant, _, channel, how in noted.resolutions if channel == 0}
    assert told == expected
    conflicts = {instant for instant, _, _, how in noted.resolutions if how.is_in_conflict}
    assert conflicts == ({2} if way.way is Way.EXCLUSIVE else set())


def test_a_broken_exclusion_is_told_when_it_begins_and_the_first_has_its_way() -> None:
    values, noted = driven([A, C], resolution(Way.EXCLUSIVE, 1, 0), 8)

    assert values == [1.0, 1.0, -10.0, -10.0, 1.0, 1.0, 1.0, 1.0]
    assert [(i, event.what, event.channel) for i, event in noted.events] == [(2, What.CONFLICT, 0)]


@pytest.mark.parametrize(
    ("rest", "expected"),
    [("stop", 0.0), ("hold", -10.0), ("coast", math.nan)],
)
def test_a_channel_that_nobody_drives_rests(rest: str, expected: float) -> None:
    values, _ = driven([C], resolution(Way.SINGLE, 0), 6, rest)

    assert values[2:4] == [-10.0, -10.0]
    assert values[4:] == pytest.approx([expected] * 2, nan_ok=True)


def test_before_anybody_has_spoken_a_held_channel_is_at_zero() -> None:
    late = N("late", wants(3.0), STEP, 2 * STEP, {"x": "pos.x"}, {"x": ("speed", "set-point")})

    values, _ = driven([late], resolution(Way.SINGLE, 0), 4, "hold")

    assert values == [0.0, 0.0, 3.0, 3.0]


def test_a_combined_behavior_acts_where_all_its_parts_would_and_nowhere_else() -> None:
    early = node("early", 1.0, "x 4 lt")
    late = node("late", 2.0, "x 2 ge")
    both = node("both", 50.0, replaces=("early", "late"))

    values, noted = driven([early, late, both], resolution(Way.EXCLUSIVE, 0, 1), 6)

    assert values == [1.0, 1.0, 50.0, 50.0, 2.0, 2.0]
    assert not noted.events


def test_the_greater_combination_comes_first() -> None:
    nodes = [
        node("a", 1.0),
        node("b", 2.0),
        node("c", 4.0, "x 2 ge"),
        node("ab", 10.0, replaces=("a", "b")),
        node("abc", 20.0, replaces=("a", "b", "c")),
    ]

    values, _ = driven(nodes, resolution(Way.SUM, 0, 1, 2), 4)

    assert values == [10.0, 10.0, 20.0, 20.0]


def test_what_is_wanted_beyond_the_domain_is_limited_and_told_once() -> None:
    values, noted = driven([node("a", 12.0)], resolution(Way.SINGLE, 0), 4, limit=5.0)

    assert values == [5.0] * 4
    assert [event.what for _, event in noted.events] == [What.LIMITED]


def test_a_channel_tells_how_long_it_is_limited() -> None:
    _, noted = driven([C], resolution(Way.SINGLE, 0), 8, limit=5.0)

    assert [(i, how.is_limited) for i, _, channel, how in noted.resolutions if channel == 0] == [
        (0, False),
        (2, True),
        (4, False),
    ]


def test_accelerations_and_set_points_cannot_be_added() -> None:
    pushes = N("p", wants(1.0), STEP, 0.0, {"x": "pos.x"}, {"x": ("x", "acceleration")})

    with pytest.raises(ValueError, match="put together"):
        driven([A, pushes], resolution(Way.SUM, 0, 1))
