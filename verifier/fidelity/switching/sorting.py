"""What each change of mode is: expected, unexpected, missed, to another mode, or undeclared."""

import numpy as np

from runtime.arrays import Array
from verifier.fidelity.switching.arrivals import Arrivals
from verifier.fidelity.switching.jumps import Jumps
from verifier.fidelity.switching.setting import Setting
from verifier.fidelity.switching.stays import Stay
from verifier.report.switching import Switch, SwitchSort

SURE = 4.0
"""Another guard counts as first, or a guard as not reached, by so many deviations of the noise."""


def allowed_times(setting: Setting, arrivals: Arrivals, jumps: Jumps) -> Array:
    """The time (K,) by which each switch may differ.

    The room that the tolerances leave in the guard, over the speed at which it rises. Where the
    guard reads no state that has a tolerance: the time in which a switch that comes late carries
    some state beyond its tolerance.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        by_guard = arrivals.room / arrivals.speed
        by_state = np.min(setting.tolerance / np.abs(jumps.slope), axis=1, initial=np.inf)
    is_told = (arrivals.room > 0.0) & np.isfinite(arrivals.speed)
    return np.where(is_told, by_guard, by_state)


def sorted_switches(
    setting: Setting, stays: tuple[Stay, ...], arrivals: Arrivals, jumps: Jumps
) -> tuple[Switch, ...]:
    """The changes of mode, in their order."""
    allowed = allowed_times(setting, arrivals, jumps)
    stamps = np.sqrt(jumps.shift_variance)
    with np.errstate(divide="ignore", invalid="ignore"):
        carried = np.where(arrivals.speed > 0.0, arrivals.doubt / arrivals.speed, np.inf)
    doubts = np.hypot(carried, stamps)
    beyond = _beyond(setting, stays)
    return tuple(
        _switch(setting, arrivals, k, (jumps.shift[k], doubts[k], allowed[k]), beyond.get(k, set()))
        for k in range(len(setting.changes))
    )


def _switch(
    setting: Setting,
    arrivals: Arrivals,
    k: int,
    figures: tuple[float, float, float],
    beyond: set[str],
) -> Switch:
    """Change k. figures: its shift, its doubt, what is allowed; beyond: as `_beyond` gives it."""
    shift, doubt, allowed = (float(each) for each in figures)
    changes, names = setting.changes, setting.mode_names
    time = float(changes.times[k]) + shift
    source, target = names[changes.left[k]], names[changes.entered[k]]
    guard = int(arrivals.guards[k])
    nothing = float("nan")
    if guard < 0:
        first = _first_other(setting, arrivals, k, time + setting.horizon)
        return Switch(time, source, target, SwitchSort.UNDECLARED, first, nothing, nothing, nothing)
    if not arrivals.is_good[k]:
        return Switch(time, source, target, SwitchSort.UNJUDGED, "", nothing, nothing, nothing)
    opened = float(arrivals.opened[k, guard])
    is_near = arrivals.value[k] + arrivals.room[k] + SURE * arrivals.doubt[k] >= 0.0
    if np.isinf(opened) and is_near:
        return Switch(time, source, target, SwitchSort.EXPECTED, "", nothing, nothing, nothing)
    if np.isinf(opened):
        first = _first_other(setting, arrivals, k, time + setting.horizon)
        sort = SwitchSort.WRONG_TARGET if first else SwitchSort.UNEXPECTED
        return Switch(time, source, target, sort, first, nothing, nothing, nothing)
    # Another way was open before, and the robot, beyond it for sure, did not take it.
    earlier = _first_other(setting, arrivals, k, min(opened, time) - allowed - SURE * doubt)
    if earlier and earlier in beyond:
        return Switch(
            time, source, target, SwitchSort.WRONG_TARGET, earlier, nothing, nothing, allowed
        )
    return Switch(time, source, target, SwitchSort.EXPECTED, "", time - opened, doubt, allowed)


def _beyond(setting: Setting, stays: tuple[Stay, ...]) -> dict[int, set[str]]:
    """For each change, where the guards lead that were open for sure just before it."""
    return {
        stay.change: {
            setting.mode_names[guard.target]
            for index, guard in enumerate(setting.guards)
            if guard.mode == stay.mode and stay.beyond[-1, index] > 0.0
        }
        for stay in stays
        if stay.change >= 0
    }


def _first_other(setting: Setting, arrivals: Arrivals, k: int, latest: float) -> str:
    """Where another guard of the same mode leads that opens first, and by `latest`; else empty."""
    entered = setting.changes.entered[k]
    times = {
        guard.target: arrivals.opened[k, index]
        for index, guard in enumerate(setting.guards)
        if guard.mode == setting.changes.left[k] and guard.target != entered
    }
    first = min(times, key=lambda target: times[target], default=-1)
    return setting.mode_names[first] if first >= 0 and times[first] <= latest else ""


def missed_switches(setting: Setting, stays: tuple[Stay, ...]) -> list[Switch]:
    """Guards that were open beyond doubt and tolerance, and that the robot did not take.

    Neither at the end of that stay, nor within a horizon.
    """
    found = []
    for stay in stays:
        for index, guard in enumerate(setting.guards):
            if guard.mode != stay.mode or guard.target == guard.mode or len(stay.times) == 0:
                continue
            time = _passed(setting, stay, index)
            if time is not None:
                nothing = float("nan")
                source, target = (setting.mode_names[mode] for mode in (guard.mode, guard.target))
                found.append(
                    Switch(time, source, target, SwitchSort.MISSED, "", nothing, nothing, nothing)
                )
    return found


def _passed(setting: Setting, stay: Stay, guard: int) -> float | None:
    """When a guard first opened that was open beyond doubt and then not taken."""
    is_open, is_sure = stay.guards[:, guard] >= 0.0, stay.beyond[:, guard] > 0.0
    entered = setting.changes.entered[stay.change] if stay.change >= 0 else -1
    starts = np.flatnonzero(is_open & ~np.append(False, is_open[:-1]))
    for start in starts:
        after = np.flatnonzero(~is_open[start:])
        closes = start + after[0] if len(after) else len(is_open)
        is_taken = closes == len(is_open) and entered == setting.guards[guard].target
        if is_taken or not np.any(is_sure[start:closes]):
            continue
        if stay.end - stay.times[start] > setting.horizon:
            return float(stay.times[start])
    return None
