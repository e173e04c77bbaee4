"""A run as pictures draw it: the scene, everybody's trail, and what was required."""

from collections.abc import Sequence
from typing import Final

import numpy as np

from runtime.architecture import Architecture, Way
from runtime.arrays import Array, Booleans, Integers
from runtime.recording.tracks import ActingTrack
from runtime.run import Run
from specc.figures.quantities import quantity, seconds
from specc.figures.scene import NOBODY, Glow, Item, Lamp, Mark, Outcome, Scene, Trails
from verifier.report.requirement_results import Outcome as Judged
from verifier.report.requirement_results import RequirementResult

HELD: Final = {Judged.SATISFIED: True, Judged.VIOLATED: False, Judged.OPEN: None}


def pictured(made: Run, requirements: Sequence[RequirementResult]) -> tuple[Scene, Trails]:
    """What posters and animations show of a run; the light where the run kept it."""
    things = made.layout.things
    names = [thing.name for thing in things]
    world = made.scenario.world
    glow = None
    if made.floor is not None:
        glow = Glow(made.floor.xs, made.floor.ys, made.floor.times, made.floor.lux)
    scene = Scene(
        title=made.scenario.name,
        about=made.scenario.about,
        arena=np.array(world.arena),
        things=tuple(Item(thing.name, thing.shape, thing.is_fixed) for thing in things),
        robots=tuple(Item(robot.name, robot.body.shape) for robot in made.scenario.robots),
        lamps=tuple(
            Lamp(lamp.name, lamp.pose.x, lamp.pose.y, names.index(lamp.on) if lamp.on else NOBODY)
            for lamp in world.lights
        ),
        glow=glow,
    )
    return scene, _trails(made, requirements)


def _trails(made: Run, requirements: Sequence[RequirementResult]) -> Trails:
    times, count = made.world.times, len(made.layout.things)
    doing = [
        who_acts(robot.architecture, track.acting, times)
        for robot, track in zip(made.scenario.robots, made.robots, strict=True)
    ]
    robots = [robot.name for robot in made.scenario.robots]
    poses = made.world.poses[:, count:]
    jams = []
    for jam in made.audit.jams:
        robot = robots.index(jam.robot)
        x, y = _at(times, poses[:, robot], jam.begin)
        jams.append(Mark(robot, jam.begin, x, y, jam.end))
    return Trails(
        times=times,
        things=made.world.poses[:, :count],
        robots=poses,
        doers=tuple(names for names, _ in doing),
        acting=np.column_stack([acting for _, acting in doing]),
        contacts=tuple(_contacts(made, poses)),
        jams=tuple(jams),
        outcomes=tuple(Outcome(one.text, HELD[one.outcome], _margin(one)) for one in requirements),
    )


def who_acts(
    architecture: Architecture, track: ActingTrack, times: Array
) -> tuple[tuple[str, ...], Integers]:
    """Who has its way on the first channel that is reached: names, and for each time an index.

    Of a priority it is the highest that acts; where several are added or mixed it is all of them.
    """
    channel = next((c for c in architecture.channels if c.resolution.nodes), None)
    acting = np.full(len(times), NOBODY, dtype=np.int64)
    if channel is None or not len(track.times):
        return (), acting
    resolution = channel.resolution
    rows = np.searchsorted(track.times, times + 1e-9, side="right") - 1
    names: list[str] = []
    known: dict[tuple[int, ...], int] = {}
    places: list[int] = []
    for acts in track.acts:
        who = _winners(resolution.nodes, acts, alone=resolution.way is Way.PRIORITY)
        replaced = {part for node in who for part in architecture.nodes[node].replaces}
        who = tuple(node for node in who if node not in replaced)
        if who and who not in known:
            known[who] = len(names)
            names.append(" + ".join(architecture.nodes[node].name for node in who))
        places.append(known.get(who, NOBODY))
    seen = rows >= 0
    acting[seen] = np.array(places, dtype=np.int64)[rows[seen]]
    return tuple(names), acting


def _winners(nodes: tuple[int, ...], acts: Booleans, *, alone: bool) -> tuple[int, ...]:
    who = tuple(node for node in nodes if acts[node])
    return who[:1] if alone else who


def _contacts(made: Run, poses: Array) -> list[Mark]:
    """Where robots began to touch something."""
    found = []
    for robot in range(poses.shape[1]):
        touching = made.world.contacts[:, robot] > 0.0
        begins = np.flatnonzero(touching & ~np.concatenate([[False], touching[:-1]]))
        for time in made.world.close_times[begins].tolist():
            x, y = _at(made.world.times, poses[:, robot], time)
            found.append(Mark(robot, time, x, y))
    return found


def _at(times: Array, poses: Array, time: float) -> tuple[float, float]:
    """Where something was at a time."""
    row = min(int(np.searchsorted(times, time - 1e-9)), len(times) - 1)
    return float(poses[row, 0]), float(poses[row, 1])


def _margin(one: RequirementResult) -> str:
    """By how much it holds, and where that was decided."""
    if not np.isfinite(one.robustness):
        return ""
    margin = f"robustness {quantity(one.robustness, one.unit)}"
    return f"{margin} at {seconds(one.witness.time)}" if one.witness else margin
