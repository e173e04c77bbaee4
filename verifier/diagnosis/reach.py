"""Integration knots that reach as far as the sensors of a setting look.

A sensor that is late by d tells at t of t - d: before its window where t is the window's first
moment. Windows begin earlier then, and end later for one that is early, so that nothing is guessed
beyond a path's ends. Step maps keep their ticks.

A state that stops at a bound does so within a step: its steps are finer.

L lanes, each a setting; W windows; S integration steps; F, E knots put in front and at the end.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array
from runtime.program import Kind
from verifier.diagnosis.altered import Altered
from verifier.diagnosis.loosened import is_bound
from verifier.diagnosis.scene import Scene

CUTS: Final = 5
"""Into so many steps each is cut where a state is bounded."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Reach:
    """Knots (L, W, F + S + 1 + E), each step cut into `cuts`.

    Those of the scene begin at the index `front`, and are `cuts` apart.
    """

    times: Array
    front: int
    cuts: int = 1

    @property
    def step(self) -> float:
        """The longest step."""
        return float(np.max(np.diff(self.times, axis=-1)))


def reach_of(scene: Scene, settings: list[Altered]) -> Reach:
    """As far and as fine as each setting needs; all have as many knots."""
    plain = _far(scene, settings)
    if not any(is_bound(name) for setting in settings for name in setting.register):
        return plain
    shares = np.arange(CUTS) / CUTS
    lows, steps = plain.times[..., :-1, None], np.diff(plain.times, axis=-1)[..., None]
    cut = (lows + shares * steps).reshape(*plain.times.shape[:-1], -1)
    times = np.concatenate([cut, plain.times[..., -1:]], axis=-1)
    return Reach(times, plain.front * CUTS, CUTS)


def _far(scene: Scene, settings: list[Altered]) -> Reach:
    """As far as each setting needs; knots coincide where none is needed."""
    delays = [[seen.delay for seen in setting.seen.values()] for setting in settings]
    late = [max(0.0, *each) if each else 0.0 for each in delays]
    early = [max(0.0, *(-d for d in each)) if each else 0.0 for each in delays]
    plain = np.broadcast_to(scene.times, (len(settings), *scene.times.shape))
    if scene.flow.is_map or not (any(late) or any(early)):
        return Reach(plain, 0)
    step = float(np.max(np.diff(scene.times, axis=1)))
    front, end = _parts(late, step), _parts(early, step)
    rows = []
    for setting, before, after in zip(settings, late, early, strict=True):
        changes = _changes(scene, setting)
        first, last = scene.times[:, 0], scene.times[:, -1]
        ahead = np.linspace(first - before, first, front + 1, axis=1)
        beyond = np.linspace(last, last + after, end + 1, axis=1)
        ahead, beyond = (_with(changes, knots) for knots in (ahead, beyond))
        rows.append(np.concatenate([ahead[:, :-1], scene.times, beyond[:, 1:]], axis=1))
    return Reach(np.array(rows), front)


def _parts(lengths: Iterable[float], step: float) -> int:
    return int(np.ceil(max(lengths) / step - 1e-9))


def _changes(scene: Scene, setting: Altered) -> Array:
    """When modes change: a step must not go across."""
    discrete = [s.name for s in scene.program.states if s.kind is Kind.DISCRETE]
    told = [setting.courses[name] for name in discrete if name in setting.courses]
    found = [each.times[1:][np.diff(each.values) != 0.0] for each in told]
    return np.unique(np.concatenate([np.empty(0), *found]))


def _with(changes: Array, knots: Array) -> Array:
    """The inner knots (W, F + 1) that are nearest to a change, moved there."""
    moved = np.array(knots)
    for row in moved if len(changes) else ():
        for change in changes[(changes > row[0]) & (changes < row[-1])]:
            inner = row[1:-1]
            if len(inner):
                inner[np.argmin(np.abs(inner - change))] = change
        row.sort()
    return moved
