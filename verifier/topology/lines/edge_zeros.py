"""Zeros of one rate on the edges of a planar grid: crossing zero, touching it, bordering on it.

f: the rate, divided by its typical size on the grid.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, TypeAlias, final

import numpy as np

from runtime.arrays import Array, Booleans, Integers

Values: TypeAlias = Callable[[Array], Array]
"""f (...,) at points (..., 2)."""

NONE, CROSSING, TOUCHING = 0, 1, 2

NOTHING: Final = 1e-14
"""An |f| below this is zero."""

ON_LINE: Final = 1e-6
"""What |f| must fall below where it changes its sign; at a jump of f it does not."""

TOUCH: Final = 1e-9
"""What |f| must fall below where it touches zero without a change of sign,"""

DEEP: Final = 0.01
"""and as a share of its size at the edge's ends."""

BESIDE: Final = 1e-3
"""How far to both sides, as a share of the edge, |f| must be larger than where it touches."""

ROUNDS, PARTS = 18, 6
"""An edge is divided so often into so many parts until the place of a crossing is left."""

SECTIONS: Final = 42
GOLDEN: Final = 0.6180339887498949


@final
@dataclass(frozen=True, eq=False, slots=True)
class EdgeZeros:
    """For every edge in one direction of a grid: the kinds of its zeros, and their places.

    kind: (..., 2); at: (..., 2, 2). The second one, if there is one, is nearer to the edge's end.
    """

    kind: Integers
    at: Array


def zeros_on_edges(
    f_at: Values, nodes: tuple[Array, Array], f: Array, along: int, blur: float
) -> EdgeZeros:
    """The zeros on the edges from node to node of the axis `along`, of f (n1, n2) on the nodes.

    blur: how far f may miss zero, or go beyond it, where it touches zero but for its error.
    """
    corners = np.stack(np.meshgrid(*nodes, indexing="ij"), axis=-1)
    first, last = (_part(corners, along, s) for s in (slice(None, -1), slice(1, None)))
    kind = np.zeros((*first.shape[:2], 2), dtype=np.int64)
    at = np.full((*first.shape[:2], 2, 2), np.nan)

    sign = _sign(f)
    before, after = (_part(sign, along, s) for s in (slice(None, -1), slice(1, None)))
    changes = (before != after) & np.isfinite(before) & np.isfinite(after)
    at[changes, 0], kind[changes, 0] = _crossing(
        f_at, first[changes], last[changes], before[changes]
    )

    dips = _dips(nodes[along], f, along)
    a, b, up = first[dips], last[dips], before[dips]
    places = _lowest(f_at, a, b, up)
    lowest, fuzzy = up * f_at(places), max(TOUCH, blur)
    ends = np.minimum(np.abs(f_at(a)), np.abs(f_at(b)))
    touches = (np.abs(lowest) <= fuzzy) & _is_inner(f_at, places, a, b, up)
    touches &= np.abs(lowest) <= max(DEEP, blur) * np.maximum(np.abs(f_at(a)), np.abs(f_at(b)))
    twice = (lowest < -fuzzy) & (ends > NOTHING)
    at[dips, 0], kind[dips, 0] = places, np.where(touches, TOUCHING, NONE)

    both = np.argwhere(dips)[twice]
    for slot, (start, end, s) in enumerate(((a, places, up), (places, b, -up))):
        where = (*both.T, slot)
        at[where], kind[where] = _crossing(f_at, start[twice], end[twice], s[twice])
    return EdgeZeros(kind, at)


def _sign(f: Array) -> Array:
    """-1, 0 or 1; NaN where f is not known."""
    return np.where(np.abs(f) <= NOTHING, 0.0, np.sign(f))


def _crossing(f_at: Values, a: Array, b: Array, sign: Array) -> tuple[Array, Integers]:
    """Where f ceases to have the sign that it has at a, between a and b (k, 2), and what is there.

    A jump across zero is nothing.
    """
    shares = np.arange(1.0, PARTS)[:, None] / PARTS
    for _ in range(ROUNDS if len(a) else 0):
        inner = a[:, None] + shares * (b - a)[:, None]
        same = _sign(f_at(inner)) == sign[:, None]
        # How many of them, one after the other, still have the sign.
        count = np.cumprod(same, axis=1, dtype=np.int64).sum(axis=1)
        step = (b - a) / PARTS
        a = a + count[:, None] * step
        b = a + step
    places = 0.5 * (a + b)
    return places, np.where(np.abs(f_at(places)) <= ON_LINE, CROSSING, NONE)


def _part(values: Array, along: int, part: slice) -> Array:
    return values[part] if along == 0 else values[:, part]


def _dips(nodes: Array, f: Array, along: int) -> Booleans:
    """Edges between nodes of one sign where |f| may come down to zero.

    |f| falls before the edge or on it, rises on it or after it, and straight on it would meet
    below zero.
    """
    size = np.moveaxis(np.abs(f), along, 0)
    slope = np.diff(size, axis=0) / np.diff(nodes)[:, None]
    # Beyond the border: as within.
    down = -np.concatenate([slope[:1], slope[:-1]])
    up = np.concatenate([slope[1:], slope[-1:]])
    left, right, step = size[:-1], size[1:], np.diff(nodes)[:, None]
    sign = np.moveaxis(np.sign(f), along, 0)
    with np.errstate(invalid="ignore"):
        one_sign = sign[:-1] * sign[1:] > 0.0
        falls, rises = np.maximum(down, -slope) > 0.0, np.maximum(up, slope) > 0.0
        down, up = np.maximum(down, 0.0), np.maximum(up, 0.0)
        deep = left * up + right * down - up * down * step <= TOUCH * (up + down)
        return np.moveaxis(np.asarray(one_sign & falls & rises & deep), 0, along)


def _is_inner(f_at: Values, places: Array, a: Array, b: Array, up: Array) -> Booleans:
    """Whether f is least there, and does not go on falling beyond the end of the edge."""
    depth = up * f_at(places)
    around = [up * f_at(places + sign * BESIDE * (b - a)) for sign in (-1.0, 1.0)]
    share = np.linalg.norm(places - a, axis=-1) / np.linalg.norm(b - a, axis=-1)
    # What is exactly on a node belongs to the edge that begins there.
    inner = share < 1.0 - 1e-7
    return np.asarray(inner & ~(around[0] < depth) & ~(around[1] < depth))


def _lowest(f_at: Values, a: Array, b: Array, up: Array) -> Array:
    """Where `up` times f is least between a and b (k, 2), by golden section (Kiefer 1953)."""
    inner = [b - GOLDEN * (b - a), a + GOLDEN * (b - a)]
    values = [up * f_at(p) for p in inner]
    for _ in range(SECTIONS if len(a) else 0):
        left = values[0] <= values[1]
        keep = left[:, None]
        a, b = np.where(keep, a, inner[0]), np.where(keep, inner[1], b)
        kept, value = np.where(keep, inner[0], inner[1]), np.where(left, values[0], values[1])
        fresh = np.where(keep, b - GOLDEN * (b - a), a + GOLDEN * (b - a))
        other = up * f_at(fresh)
        inner = [np.where(keep, fresh, kept), np.where(keep, kept, fresh)]
        values = [np.where(left, other, value), np.where(left, value, other)]
    return np.asarray(0.5 * (a + b))
