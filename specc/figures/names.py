"""Names on the picture of a run: of robots, of lights, and of the things that matter."""

from typing import Final

import numpy as np

from specc.figures.footprints import lamps_at, moved, outline, placed, reach_of
from specc.figures.labels import Labels, Note, Words
from specc.figures.palettes import Palette
from specc.figures.scene import Scene, Trails

MOST: Final = 12
"""Things that are named though nobody speaks of them, at most."""
STAR: Final = 6.5
"""Points from the middle of a light's star to its tips."""
SIZE: Final = 7.0
"""Points of a thing's name."""


def named_things(scene: Scene, trails: Trails) -> list[int]:
    """Which things have their names on pictures: all, where they are few.

    Else those that a requirement or a behavior speaks of, and of the others those that were moved,
    the farthest first, as long as they are few.
    """
    places = range(len(scene.things))
    if len(scene.things) <= MOST:
        return list(places)
    spoken = [i for i in places if scene.things[i].name in scene.spoken]
    pushed = [i for i in places if i not in spoken and moved(trails.things[:, i])]
    way = np.hypot(*(trails.things[-1] - trails.things[0])[:, :2].T)
    pushed.sort(key=lambda i: (-float(way[i]), i))
    return sorted([*spoken, *pushed[: max(MOST - len(spoken), 0)]])


def named_on_films(scene: Scene) -> list[int]:
    """Which things have names: all, where they are few, else those that are spoken of."""
    are_few = len(scene.things) <= MOST
    return [i for i, item in enumerate(scene.things) if are_few or item.name in scene.spoken]


def keep_clear(labels: Labels, scene: Scene, trails: Trails) -> None:
    """What words may not cover: robots where they were first and last, and lights.

    What they should not: outlines of things and ways of what was pushed, and walls.
    """
    for row in (0, -1):
        for item, pose in zip(scene.robots, trails.robots[row], strict=True):
            labels.keep_off(placed(part, pose) for part in outline(item.shape))
    for at in lamps_at(scene, trails.things[-1]).tolist():
        labels.keep_off_mark(at, STAR)
    labels.spare(np.vstack([scene.arena, scene.arena[:1]]))
    for index, item in enumerate(scene.things):
        poses = trails.things[:, index]
        is_moved = moved(poses)
        labels.spare_bodies(placed(part, poses[-1]) for part in outline(item.shape))
        for part in outline(item.shape):
            for row in (0, -1) if is_moved else (-1,):
                there = placed(part, poses[row])
                labels.spare(np.vstack([there, there[:1]]))
        if is_moved:
            labels.spare(poses[:, :2])


def name_robots_and_lights(labels: Labels, scene: Scene, trails: Trails, palette: Palette) -> None:
    """Beside each robot where it was last, and beside each light, its name."""
    for item, pose in zip(scene.robots, trails.robots[-1], strict=True):
        reach = reach_of(outline(item.shape)) * labels.per_metre
        words = Words(item.name, 8.5, palette.ink, palette.paper, is_bold=True)
        labels.put_by(Note(words, (float(pose[0]), float(pose[1])), reach))
    for lamp, (x, y) in zip(scene.lamps, lamps_at(scene, trails.things[-1]).tolist(), strict=True):
        labels.put_by(Note(Words(lamp.name, 7.5, palette.ink, palette.paper), (x, y), STAR))


def name_things(labels: Labels, scene: Scene, trails: Trails, palette: Palette) -> None:
    """On each thing that matters its name, or beside it, where there is no room on it."""
    for index in named_things(scene, trails):
        item, pose = scene.things[index], trails.things[-1, index]
        parts = [placed(part, pose) for part in outline(item.shape)]
        color = palette.paper if item.is_fixed else palette.ink
        if not labels.put_on(Words(item.name, SIZE, color), parts):
            reach = 0.8 * reach_of(outline(item.shape)) * labels.per_metre
            words = Words(item.name, SIZE, palette.ink, palette.paper)
            labels.put_by(Note(words, (float(pose[0]), float(pose[1])), reach))
