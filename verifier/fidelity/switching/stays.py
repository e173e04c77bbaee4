"""The stays in each mode, and what the guards said of the measured states meanwhile.

Guards are evaluated at the samples of the time base and averaged over as many as a state is
fitted to; T: samples of one stay; q: guards.
"""

from dataclasses import dataclass
from typing import final

import numpy as np

from runtime.arrays import Array
from verifier.fidelity.shooting.samples import measured_states
from verifier.fidelity.switching.guards import changed_by, guards_at, room_at
from verifier.fidelity.switching.setting import Setting, knot_at

SURE = 3.0
"""A guard counts as open where it is so by this many deviations of the noise, and the tolerance."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Stay:
    """One stay in `mode`, from `begin` to `end`; `change` ends it, -1 where the trace does.

    times (T,); guards (T, q): averaged values. beyond (T, q): how far they are open beyond the
    tolerance and the noise.
    """

    mode: int
    begin: float
    end: float
    change: int
    times: Array
    guards: Array
    beyond: Array


def stays_of(setting: Setting) -> tuple[Stay, ...]:
    """All stays, cut at what is excluded; of such a part, only the last one ends in a change."""
    base = max(setting.samples, key=lambda each: each.distance)
    values, room, noise = _measured_guards(setting, base.times)
    width = max(1, round(setting.lead / base.distance))
    changes, found = setting.changes, []
    modes = np.append(changes.left, changes.entered[-1:] if len(changes) else setting.only_mode)
    begins = np.append(-np.inf, changes.until)
    ends = np.append(changes.since, np.inf)
    for k, (mode, begin, end) in enumerate(zip(modes, begins, ends, strict=True)):
        reach = setting.spans[(setting.spans[:, 1] > begin) & (setting.spans[:, 0] < end)]
        for low, high in reach:
            first, last = max(low, begin), min(high, end)
            here = slice(
                np.searchsorted(base.times, first - 1e-9),
                np.searchsorted(base.times, last + 1e-9),
            )
            if here.stop <= here.start:
                continue
            smooth, count = _averaged(values[here], width)
            beyond = smooth - room[here] - SURE * noise[here] / np.sqrt(count)[:, None]
            is_last = high >= end and k < len(changes)
            change = k if is_last else -1
            found.append(Stay(int(mode), first, last, change, base.times[here], smooth, beyond))
    return tuple(found)


def open_since(setting: Setting, stay: Stay, guard: int) -> float:
    """When a guard opened that is open at the end of the stay; that end where it is not."""
    closed = np.flatnonzero(stay.guards[:, guard] < 0.0)
    first = closed[-1] + 1 if len(closed) else 0
    if first >= len(stay.times) or stay.end - stay.times[first] < setting.lead / 2.0:
        return stay.end
    return float(stay.times[first])


def _averaged(values: Array, width: int) -> tuple[Array, Array]:
    """Centered averages (T, q) over `width` samples, fewer at the ends, and of how many (T,)."""
    kernel = np.ones(min(width, len(values)))
    count = np.convolve(np.ones(len(values)), kernel, "same")
    columns = [np.convolve(column, kernel, "same") / count for column in values.T]
    return np.stack(columns, axis=-1), count


def _measured_guards(setting: Setting, times: Array) -> tuple[Array, Array, Array]:
    """At each time (T, q): the guards, what the tolerances change in them, and what noise does."""
    knots = knot_at(setting.model.grid, times)
    states = measured_states(setting.model, setting.samples, knots)
    noise = np.zeros((len(times), len(setting.guards)))
    for each, sigma in zip(setting.samples, setting.sigma, strict=True):
        noise += changed_by(setting, states, knots, (each.column, float(sigma))) ** 2
    return guards_at(setting, states, knots), room_at(setting, states, knots), np.sqrt(noise)
