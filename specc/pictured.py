"""A run as pictures draw it: the scene, everybody's trail, and what was required."""

from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np

from runtime.architecture import Architecture, Way
from runtime.arrays import Array, Booleans, Integers
from runtime.recording.tracks import ActingTrack
from runtime.run import Run
from runtime.scenario import Scenario
from runtime.world.model import Thing
from specc.drawn import write_picture
from specc.figures.animation import Progress, animate
from specc.figures.quantities import quantity, seconds
from specc.figures.scene import NOBODY, Glow, Item, Lamp, Mark, Outcome, Scene, Trails
from specc.figures.style_names import Style
from specc.figures.world import draw_world
from verifier.report.requirement_results import Outcome as Judged
from verifier.report.requirement_results import RequirementResult

HELD: Final = {Judged.SATISFIED: True, Judged.VIOLATED: False, Judged.OPEN: None}


def pictured(made: Run, requirements: Sequence[RequirementResult]) -> tuple[Scene, Trails]:
    """What posters and animations show of a run; the light where the run kept it."""
    glow = None
    if made.floor is not None:
        glow = Glow(made.floor.xs, made.floor.ys, made.floor.times, made.floor.lux)
    return scene_of(made.scenario, made.layout.things, glow), _trails(made, requirements)


def scene_of(scenario: Scenario, things: Sequence[Thing], glow: Glow | None = None) -> Scene:
    """What stands in a scenario; things: all of them, with those that were laid at random."""
    names = [thing.name for thing in things]
    return Scene(
        title=scenario.name,
        about=scenario.about,
        arena=np.array(scenario.world.arena),
        things=tuple(Item(thing.name, thing.shape, thing.is_fixed) for thing in things),
        robots=tuple(Item(robot.name, robot.body.shape) for robot in scenario.robots),
        lamps=tuple(
            Lamp(lamp.name, lamp.pose.x, lamp.pose.y, names.index(lamp.on) if lamp.on else NOBODY)
            for lamp in scenario.world.lights
        ),
        glow=glow,
    )


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
    """Who has its way: names, and for each time an index of them, or NOBODY."""
    acting = np.full(len(times), NOBODY, dtype=np.int64)
    if not len(track.times):
        return (), acting
    rows = np.searchsorted(track.times, times + 1e-9, side="right") - 1
    told = [winner(architecture, acts) for acts in track.acts]
    names = [name for name in dict.fromkeys(told) if name]
    places = np.array([names.index(name) if name else NOBODY for name in told], dtype=np.int64)
    seen = rows >= 0
    acting[seen] = places[rows[seen]]
    return tuple(names), acting


def winner(architecture: Architecture, acts: Booleans) -> str:
    """Who has its way on the first channel that is reached, empty for nobody.

    Of a priority it is the highest that acts; where several are added or mixed it is all of them.
    """
    channel = next((c for c in architecture.channels if c.resolution.nodes), None)
    if channel is None:
        return ""
    who = [node for node in channel.resolution.nodes if acts[node]]
    replaced = {part for node in who for part in architecture.nodes[node].replaces}
    who = [node for node in who if node not in replaced]
    if channel.resolution.way is Way.PRIORITY:
        who = who[:1]
    return " + ".join(architecture.nodes[node].name for node in who)


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


def write_poster(
    made: Run, requirements: Sequence[RequirementResult], path: Path, style: Style = Style.SCREEN
) -> None:
    """Write the poster of a run as .svg, .png or .pdf; the light where the run kept it.

    Raises:
        SpecError: another suffix, or a file that can't be written.
    """
    write_picture(draw_world(*pictured(made, requirements), style), path, style)


def write_film(
    made: Run, path: Path, progress: Progress | None = None, style: Style = Style.SCREEN
) -> None:
    """Write a run as .gif or .mp4; the light as often as the run kept it.

    Raises:
        SpecError: another suffix, .mp4 without ffmpeg, or a file that can't be written.
    """
    scene, trails = pictured(made, ())
    animate(scene, trails, path, progress, style=style)
