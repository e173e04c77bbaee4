"""Each way of the spec: its times and its jumps, averaged over all switches that took it."""

import math
from dataclasses import dataclass
from typing import final

import numpy as np

from runtime.arrays import Integers
from verifier.fidelity.switching.arrivals import Arrivals
from verifier.fidelity.switching.jumps import Jumps
from verifier.fidelity.switching.means import FEWEST, Mean, mean_of
from verifier.fidelity.switching.setting import Setting
from verifier.report.switching import Switch, SwitchSort
from verifier.report.wording import listed, quantity


@final
@dataclass(frozen=True, eq=False, slots=True)
class Compared:
    """All changes, compared with the model; `switches` in the order of the changes."""

    setting: Setting
    arrivals: Arrivals
    jumps: Jumps
    switches: tuple[Switch, ...]


@final
@dataclass(frozen=True, slots=True)
class WayMeans:
    """What is to be judged of one guard. late is None where no switch can be compared.

    basis: what the time that is allowed was derived from. jumps: of which states, with the means.
    """

    guard: int
    late: Mean | None
    basis: str
    resolution: float
    jumps: tuple[tuple[int, Mean], ...]


def means_of(compared: Compared) -> tuple[WayMeans, ...]:
    """The means of every guard, in the order of the spec."""
    return tuple(_means(compared, guard) for guard in range(len(compared.setting.guards)))


def _means(compared: Compared, guard: int) -> WayMeans:
    switches = compared.switches
    expected = np.array([each.sort is SwitchSort.EXPECTED for each in switches], dtype=bool)
    taken = np.flatnonzero(expected & (compared.arrivals.guards == guard))
    late, allowed, doubt = (
        np.array([getattr(switches[k], name) for k in taken], dtype=float)
        for name in ("late", "allowed", "doubt")
    )
    timed = np.isfinite(late) & np.isfinite(allowed) & (allowed > 0.0)
    bias = bias_of(compared, taken[timed], guard)
    if _is_crowded(compared, guard, int(np.sum(timed))):
        return WayMeans(guard, None, "", 0.0, ())
    mean = None
    if np.any(timed):
        # In shares of what each may be late by: guards are not always approached equally fast.
        typical = float(np.median(allowed[timed]))
        share = typical / allowed[timed]
        mean = mean_of(late[timed] * share, doubt[timed] * share, typical, bias)
    able = taken[compared.jumps.is_good[taken]]
    doubts = compared.setting.changes.doubt[taken]
    return WayMeans(
        guard=guard,
        late=mean,
        basis="" if mean is None else _basis(compared, guard, mean.allowed),
        resolution=float(np.max(doubts, initial=0.0)),
        jumps=tuple(_jumps(compared, able, bias)) if len(able) else (),
    )


def _is_crowded(compared: Compared, guard: int, timed: int) -> bool:
    """Whether most switches came too soon after the one before to be compared.

    Which of them can be depends on when they came, so that those are no fair sample.
    """
    setting = compared.setting
    before = np.concatenate([[-np.inf], setting.changes.until[:-1]])
    is_short = setting.changes.since - before < setting.lead
    able = compared.arrivals.is_good
    return int(np.sum(is_short & ~able & (compared.arrivals.guards == guard))) > timed


def _jumps(compared: Compared, able: Integers, bias: float) -> list[tuple[int, Mean]]:
    setting, jumps = compared.setting, compared.jumps
    found = []
    for j, tolerance in enumerate(setting.tolerance):
        if np.isfinite(tolerance):
            slack = bias * abs(float(np.mean(jumps.slope[able, j])))
            deviation = np.sqrt(jumps.variance[able, j])
            found.append((j, mean_of(jumps.error[able, j], deviation, float(tolerance), slack)))
    return found


def bias_of(compared: Compared, taken: Integers, guard: int) -> float:
    """What the stamps of the mode may do to a mean, however many switches it is of.

    The doubt of a stamp averages out where switches fall anywhere between two of them. The
    resultant length of their phases, without what chance makes of it and with what noise takes
    from it, says how far they do not. Where states tell the time, stamps do nothing.
    """
    doubt = compared.setting.changes.doubt[taken]
    by_stamp = compared.jumps.shift_variance[taken] * 12.0 >= doubt**2 * (1.0 - 1e-9)
    if len(taken) < FEWEST or not np.all(doubt > 0.0) or not np.any(by_stamp):
        return 0.0
    arrivals, count = compared.arrivals, len(taken)
    phases = np.exp(2j * np.pi * arrivals.opened[taken, guard] / doubt)
    square = max((count * abs(np.mean(phases)) ** 2 - 1.0) / (count - 1.0), 0.0)
    blur = 2.0 * math.pi * float(np.mean(arrivals.doubt[taken] / arrivals.speed[taken] / doubt))
    locked = min(1.0, math.sqrt(square) * math.exp(min(blur**2 / 2.0, 300.0)))
    return float(locked * np.mean(by_stamp * doubt / 2.0))


def _basis(compared: Compared, guard: int, allowed: float) -> str:
    setting = compared.setting
    read = set(setting.guards[guard].condition.tokens)
    told = [
        (each.state, float(tolerance))
        for each, tolerance in zip(setting.samples, setting.tolerance, strict=True)
        if each.state.name in read and np.isfinite(tolerance)
    ]
    if not told:
        return "then the other mode has carried some state beyond its tolerance"
    if len(told) == 1:
        state, tolerance = told[0]
        speed = quantity(tolerance / allowed, state.unit).split(" ")
        rate = f"{' '.join(speed)}/s" if len(speed) > 1 else f"{speed[0]} 1/s"
        return f"{quantity(tolerance, state.unit)} of {state.name} at {rate}"
    names = listed([state.name for state, _ in told])
    return f"the tolerances of {names} at the speed at which the guard is approached"
