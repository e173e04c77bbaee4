"""What checks by finite differences find, beside the verdict and on recordings of the same kind.

Such a check differentiates the measured states and compares the rates with the field's at the
measured states and inputs. It knows no tolerance: it looks for any difference. Noise in the states
is in the rates on both sides, so that a faithful robot differs, too. A check is therefore set by
faithful robots under the same conditions, hundreds of them, which a lab would have to simulate: it
gives alarm where it is farther from these than 95 % of them are. Only the last two do without, by
the interval of the regression, as a lab would.
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np
import numpy.typing as npt
from scipy import stats
from scipy.signal import savgol_filter

from tests.study.robots import Array, Robot
from verifier.traces.trace import Trace

ALARMS: Final = 0.05
"""The share of faithful robots at which a check may give alarm."""
WIDTH: Final = 0.55
"""Seconds that a polynomial of second order is fitted to (Savitzky and Golay 1964)."""
CHECKS: Final = (
    "size of the rates' error, central differences",
    "size of the rates' error, Savitzky-Golay",
    "gain of the rates, central differences",
    "gain of the rates, Savitzky-Golay",
    "gain's own interval, central differences",
    "gain's own interval, Savitzky-Golay",
)
OWN: Final = 2
"""So many, the last, have a limit of their own."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Usual:
    """What faithful robots give: center and spread (C, V) of C checks of V rates, limit (C,)."""

    center: Array
    spread: Array
    limit: Array


def usual(found: Array) -> Usual:
    """Of R faithful recordings (R, C, V); of all V rates together, 5 % are beyond the limit."""
    center, spread = np.median(found, axis=0), np.std(found, axis=0)
    center[-OWN:], spread[-OWN:] = 0.0, 1.0
    away = np.sort(np.max(np.abs(found - center) / spread, axis=-1), axis=0)
    rank = int(np.ceil((len(away) + 1) * (1.0 - ALARMS)))
    assert rank <= len(away), "twenty recordings or more tell one in twenty"
    limit = away[rank - 1]
    limit[-OWN:] = stats.norm.ppf(1.0 - 0.5 * ALARMS / found.shape[-1])
    return Usual(center, spread, limit)


def alarms(found: Array, faithful: Usual) -> npt.NDArray[np.bool_]:
    """Which of R recordings (R, C, V) each check finds unlike its spec, (R, C)."""
    away = np.max(np.abs(found - faithful.center) / faithful.spread, axis=-1)
    return np.asarray(away > faithful.limit)


def statistics(robot: Robot, trace: Trace) -> Array:
    """What each check makes of each rate, (C, V)."""
    times = trace.series[robot.states[0]].times
    states = np.stack([trace.series[name].values for name in robot.states], axis=-1)
    held = [_held(trace, name, times) for name in robot.inputs]
    rates = robot.rate(states, np.stack(held, axis=-1), 0.0)
    step = float(times[1] - times[0])
    points = 2 * round(0.5 * WIDTH / step) + 1
    smooth = savgol_filter(states, points, 2, deriv=1, delta=step, axis=0)
    inner = slice(points, -points)
    slopes = [np.gradient(states, step, axis=0)[inner], smooth[inner]]
    sizes = [np.sqrt(np.mean((slope - rates[inner]) ** 2, axis=0)) for slope in slopes]
    lines = [_line(slope, rates[inner]) for slope in slopes]
    gains = [gain for gain, _ in lines]
    return np.stack([*sizes, *gains, *((gain - 1.0) / doubt for gain, doubt in lines)])


def _held(trace: Trace, name: str, times: Array) -> Array:
    series = trace.series[name]
    return series.values[np.searchsorted(series.times, times, side="right") - 1]


def _line(slopes: Array, rates: Array) -> tuple[Array, Array]:
    """Gains of measured rates (N, V) over the field's, by least squares, and standard errors."""
    across, up = rates - np.mean(rates, axis=0), slopes - np.mean(slopes, axis=0)
    squares = np.sum(across**2, axis=0)
    gain = np.sum(across * up, axis=0) / squares
    left = np.sum((up - gain * across) ** 2, axis=0) / (len(rates) - 2)
    return gain, np.sqrt(left / squares)
