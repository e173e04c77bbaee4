"""Each change of mode beside the model: when the model would have switched, and where to.

The state before is fitted to the last samples of the stay; from it the model goes on in its mode,
past the robot's switch if need be, until its own guard opens.

K: changes; D: predicted states; q: guards.
"""

from dataclasses import dataclass
from typing import final

import numpy as np

from runtime.arrays import Array, Booleans, Integers
from verifier.fidelity.switching.crossings import GuardPaths, guard_paths, opening_of
from verifier.fidelity.switching.fits import Fit, fan, fitted, knots_between
from verifier.fidelity.switching.guards import room_at
from verifier.fidelity.switching.setting import Setting, knot_at
from verifier.fidelity.switching.stays import Stay, open_since


@final
@dataclass(frozen=True, eq=False, slots=True)
class Arrivals:
    """The changes (K,) that can be compared, as far as `is_good` (K,) says.

    guards (K,): the way taken, -1 where the spec has none between these modes.
    opened (K, q): when the model opens each guard of the mode left; infinite where it does not
    within a horizon of the change, NaN for guards of other modes.
    value, room, doubt (K,): of the guard taken: its value at the change in the state fitted
    before it, what the tolerances change in it, and its deviation by noise. speed (K,): how fast
    it rises where it opens.
    """

    is_good: Booleans
    guards: Integers
    opened: Array
    value: Array
    room: Array
    doubt: Array
    speed: Array
    before: Fit


def arrivals_of(setting: Setting, stays: tuple[Stay, ...]) -> Arrivals:
    """All changes, in their order."""
    changes, grid = setting.changes, setting.model.grid
    leads = _leads(setting, stays)
    modes = changes.left.astype(np.float64)
    before = fitted(setting, knot_at(grid, leads[:, 0]), leads, leads[:, 1], modes)
    knots = knots_between(before.first, knot_at(grid, changes.times + setting.horizon))
    paths, nudge = fan(setting, before, knots)
    here = np.clip(knot_at(grid, changes.times) - before.first, 0, knots.shape[1] - 1)
    along = guard_paths(setting, paths[0], knots, modes)
    opened = _opened(setting, along)
    taken = _taken(setting, along, here, opened)
    used = np.maximum(taken, 0)
    opening = opening_of(along, used)
    step = np.where(np.isfinite(opening.times), opening.steps, here)
    rows = np.arange(len(changes))
    value = along.before[rows, here, used]
    nudged = [guard_paths(setting, copy, knots, modes).before for copy in paths[1:]]
    changed = [each[rows, step, used] - along.before[rows, step, used] for each in nudged]
    slopes = np.stack(changed, axis=-1) / nudge
    variance = np.einsum("ki,kij,kj->k", slopes, before.covariance, slopes)
    at = paths[0][rows, step]
    return Arrivals(
        is_good=before.is_good & np.isfinite(value),
        guards=taken,
        opened=opened,
        value=value,
        room=room_at(setting, at, knots[rows, step])[rows, used],
        doubt=np.sqrt(np.maximum(variance, 0.0)),
        speed=opening.speed,
        before=before,
    )


def _leads(setting: Setting, stays: tuple[Stay, ...]) -> Array:
    """The spans (K, 2) to whose samples the states before the changes are fitted.

    They end where the robot switched, or where the guard of its way opened before. A change
    beside an exclusion has an empty one.
    """
    leads = np.column_stack([setting.changes.since, setting.changes.since - 1.0])
    ways = {(guard.mode, guard.target): i for i, guard in reversed([*enumerate(setting.guards)])}
    for stay in stays:
        if stay.change >= 0:
            way = (stay.mode, int(setting.changes.entered[stay.change]))
            end = open_since(setting, stay, ways[way]) if way in ways else stay.end
            end = max(end, stay.begin + min(setting.lead, stay.end - stay.begin))
            leads[stay.change] = max(stay.begin, end - setting.lead), end
    return leads


def _taken(setting: Setting, along: GuardPaths, here: Integers, opened: Array) -> Integers:
    """The guard between the two modes (K,).

    Of several, the one that opens nearest to the change; where none opens, the one furthest open.
    """
    rows, changes = np.arange(len(here)), setting.changes
    taken = np.full(len(here), -1)
    best, least = np.full(len(here), -np.inf), np.full(len(here), np.inf)
    for index, guard in enumerate(setting.guards):
        value = along.before[rows, here, index]
        apart = np.abs(opened[:, index] - changes.times)
        fits = (changes.left == guard.mode) & (changes.entered == guard.target)
        nearer = (apart < least) | ((apart == least) & (value > best))
        better = fits & ((taken < 0) | nearer)
        taken = np.where(better, index, taken)
        best, least = np.where(better, value, best), np.where(better, apart, least)
    return taken


def _opened(setting: Setting, along: GuardPaths) -> Array:
    opened = np.full((len(setting.changes), len(setting.guards)), np.nan)
    for index, guard in enumerate(setting.guards):
        here = setting.changes.left == guard.mode
        times = opening_of(along, np.full(len(here), index)).times
        opened[here, index] = times[here]
    return opened
