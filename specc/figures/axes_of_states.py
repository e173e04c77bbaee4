"""Axes for state variables: labels with units, angles in multiples of pi, seams of wrapping."""

import math
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis

from runtime.arrays import Array
from specc.figures.quantities import axis_label, is_multiple_of_pi, multiple_of_pi
from verifier.topology.features import AxisRange

SAME_SCALE: Final = (0.4, 2.5)
"""Two axes of one unit are drawn to the same scale if their lengths compare like this."""

SAME_NUMBERS: Final = (0.66, 1.5)
"""Two axes without units, which need not be of one kind, if they compare like this."""


def shown(axes: tuple[AxisRange, ...], points: Array) -> Array:
    """Points (..., m) in the user's units."""
    return np.asarray(points / np.array([axis.unit.scale for axis in axes]))


def name_x(axes: Axes, state: AxisRange) -> None:
    """Labels, limits and ticks of the horizontal axis."""
    axes.set_xlim(state.low / state.unit.scale, state.high / state.unit.scale)
    axes.set_xlabel(axis_label(state.name, state.unit))
    _tick_angles(axes.xaxis, state)


def name_y(axes: Axes, state: AxisRange) -> None:
    """Labels, limits and ticks of the vertical axis."""
    axes.set_ylim(state.low / state.unit.scale, state.high / state.unit.scale)
    axes.set_ylabel(axis_label(state.name, state.unit))
    _tick_angles(axes.yaxis, state)


def same_scale(states: tuple[AxisRange, ...]) -> bool:
    """Whether both axes show the same kind of length and can share one scale."""
    x, y = states
    low, high = SAME_NUMBERS if x.unit.text in {"", "1"} else SAME_SCALE
    return x.unit.text == y.unit.text and low < x.width / y.width < high


def split_at_seams(states: tuple[AxisRange, ...], points: Array) -> list[Array]:
    """A path (T, m), continuous on periodic axes, as pieces within the domain."""
    pieces: list[Array] = [points]
    for j, state in enumerate(states):
        if state.periodic:
            pieces = [part for piece in pieces for part in _split(piece, j, state)]
    return pieces


def _split(path: Array, j: int, state: AxisRange) -> list[Array]:
    """Splits `path` wherever coordinate j crosses a seam, with a point on either side of it."""
    turn = np.floor((path[:, j] - state.low) / state.width)
    pieces: list[Array] = []
    start = path[:1]
    begin = 1
    for k in map(int, np.flatnonzero(np.diff(turn))):
        seam = state.low + state.width * max(turn[k], turn[k + 1])
        a, b = path[k], path[k + 1]
        on_seam = a + (b - a) * (seam - a[j]) / (b[j] - a[j])
        pieces.append(_shifted(np.vstack([start, path[begin : k + 1], on_seam]), j, turn[k], state))
        start, begin = on_seam[None], k + 1
    pieces.append(_shifted(np.vstack([start, path[begin:]]), j, turn[-1], state))
    return pieces


def _shifted(path: Array, j: int, turn: float, state: AxisRange) -> Array:
    moved = path.copy()
    moved[:, j] -= turn * state.width
    return moved


def _tick_angles(axis: Axis, state: AxisRange) -> None:
    """Ticks at multiples of pi where an axis in rad begins and ends at such."""
    ends = (state.low, state.high)
    if state.unit.text != "rad" or not all(map(is_multiple_of_pi, ends)):
        return
    quarters = round(4.0 * state.width / math.pi)
    step = math.pi / 4.0 * max(1, 2 ** math.ceil(math.log2(quarters / 8.0)))
    first = math.ceil(state.low / step - 1e-9)
    last = math.floor(state.high / step + 1e-9)
    ticks = [step * k for k in range(first, last + 1)]
    axis.set_ticks(ticks, labels=[multiple_of_pi(tick) for tick in ticks])
