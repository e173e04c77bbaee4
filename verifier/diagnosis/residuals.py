"""Measured minus predicted at every sample of every window, for many settings at once.

L lanes, each a setting with a start state per window; W windows; R residuals in a window, those
of the first predicted state first.
"""

from typing import Final

import numpy as np

from runtime.arrays import Array, Booleans, Integers
from runtime.integrators import rk4
from runtime.program import Kind
from verifier.diagnosis.altered import Altered, Seen
from verifier.diagnosis.courses import Course, means
from verifier.diagnosis.loosened import PACE
from verifier.diagnosis.reach import Reach, reach_of
from verifier.diagnosis.scene import Observed, Scene
from verifier.fidelity.shooting.samples import turned

BATCH: Final = 3_000_000
"""So many numbers are integrated at once, at most."""
LOST: Final = 0.25
"""The residual of a prediction that left the domain, as a share of the domain."""


def owners(scene: Scene) -> Integers:
    """Which predicted state each residual (R,) belongs to."""
    counts = [each.values.shape[1] for each in scene.observed]
    return np.repeat(np.arange(len(counts)), counts)


def used(scene: Scene) -> Booleans:
    """Which residuals (W, R) are real."""
    return np.concatenate([each.used for each in scene.observed], axis=1)


def residuals(scene: Scene, settings: list[Altered], starts: Array) -> Array:
    """(L, W, R) for one setting per lane and starts (L, W, n); 0 where there is no sample."""
    each = scene.windows * scene.times.shape[1] * (len(scene.flow.defaults) + 4)
    size = max(1, BATCH // max(each, 1))
    parts = [
        _residuals(scene, settings[i : i + size], starts[i : i + size])
        for i in range(0, len(settings), size)
    ]
    return np.concatenate(parts)


def paths_of(scene: Scene, settings: list[Altered], reach: Reach, starts: Array) -> Array:
    """The predicted states (L, W, S + 1, n) at the knots of `reach`."""
    lanes, windows, steps = reach.times.shape
    columns, inputs = _inputs(scene, settings, reach)
    n = scene.start.shape[1]
    flat = rk4(
        scene.flow_for(settings),
        starts.reshape(lanes * windows, n),
        np.ascontiguousarray(reach.times.reshape(lanes * windows, steps)),
        inputs.reshape(lanes * windows, steps - 1, len(columns)),
        columns,
    )
    return flat.reshape(lanes, windows, steps, n)


def _residuals(scene: Scene, settings: list[Altered], starts: Array) -> Array:
    reach = reach_of(scene, settings)
    paths = paths_of(scene, settings, reach, starts)
    found = []
    for each in scene.observed:
        rows = [
            _as_seen(reach, lane, setting.seen[each.name], paths[lane, ..., each.column], each)
            for lane, setting in enumerate(settings)
        ]
        difference = turned(each.values - np.array(rows), each.turn)
        difference = np.where(np.isfinite(difference), difference, LOST * each.width)
        found.append(np.where(each.used, difference, 0.0))
    return np.concatenate(found, axis=2)


def _as_seen(reach: Reach, lane: int, seen: Seen, path: Array, observed: Observed) -> Array:
    """What the sensor would tell (W, m) of the path (W, S + 1)."""
    rows = np.arange(len(path))[:, None]
    if seen.delay == 0.0:
        plain = path[rows, observed.at * reach.cuts + reach.front]
    else:
        plain = _between(reach.times[lane], path, observed.times - seen.delay)
    return np.asarray(seen.scale * plain + seen.offset)


def _between(times: Array, path: Array, at: Array) -> Array:
    """The path at other times (W, m): linear between knots, and beyond the first and last step."""
    inner = np.diff(times, axis=1) > 0.0
    steps = times.shape[1] - 1
    first = np.argmax(inner, axis=1)[:, None]
    last = steps - 1 - np.argmax(inner[:, ::-1], axis=1)[:, None]
    # The last of equal knots comes before, so that no step between is empty inside.
    left = np.sum(times[:, None, :] <= at[:, :, None], axis=2) - 1
    left = np.clip(left, first, last)
    rows = np.arange(len(path))[:, None]
    low, high = times[rows, left], times[rows, left + 1]
    share = (at - low) / np.where(high > low, high - low, 1.0)
    return np.asarray(path[rows, left] * (1.0 - share) + path[rows, left + 1] * share)


def _inputs(scene: Scene, settings: list[Altered], reach: Reach) -> tuple[Integers, Array]:
    """The register's columns that are told from outside, and their values (L, W, S, K)."""
    register = scene.flow.program.register
    names = list(dict.fromkeys(name for s in settings for name in (*s.courses, *s.register)))
    columns = np.array([register.index(name) for name in names], dtype=np.int64)
    lanes, windows, steps = reach.times.shape
    values = np.empty((lanes, windows, steps - 1, len(names)))
    discrete = {s.name for s in scene.program.states if s.kind is Kind.DISCRETE}
    known: dict[tuple[str, int, bytes], Array] = {}
    for i, (setting, times) in enumerate(zip(settings, reach.times, strict=True)):
        knots = times.tobytes()
        for k, name in enumerate(names):
            course = setting.courses.get(name)
            if course is None:
                values[i, :, :, k] = _number(scene, setting, reach, name)
                continue
            key = (name, id(course), knots)
            if key not in known:
                known[key] = _held(course, times) if name in discrete else means(course, times)
            values[i, :, :, k] = known[key]
    low, high = scene.flow.domain[:, columns]
    return columns, np.clip(values, low, high)


def _number(scene: Scene, setting: Altered, reach: Reach, name: str) -> float:
    """An entry of the register that stays; states come to rest at their bounds within a step."""
    if name == PACE and name in setting.register:
        return 1.0 / reach.step
    default = float(scene.flow.defaults[scene.flow.program.register.index(name)])
    return setting.register.get(name, default)


def _held(course: Course, times: Array) -> Array:
    """A discrete input has no mean: what it is at the beginning of each step."""
    at = np.searchsorted(course.times, times[:, :-1] + 1e-9, side="right") - 1
    return np.asarray(course.values[np.clip(at, 0, None)])
