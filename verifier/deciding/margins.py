"""How near a decision is to another: the least change of one quantity, alone, that changes it.

Along one read the decision is the same from boundary to boundary. The distance is that to the first
boundary beyond which another choice is made; within its domain, whatever rules kept from before.
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arbiter import Arbiter, Read
from runtime.arrays import Array, Integers
from runtime.machine import evaluate
from verifier.deciding.moments import Moments, choices_if
from verifier.deciding.rulings import boundaries

BLOCK: Final = 2048
"""Decisions that are looked at together."""
GRID: Final = 65
"""Points along a read between which a boundary that is not straight is looked for."""
HALVINGS: Final = 48


@final
@dataclass(frozen=True, eq=False, slots=True)
class Margins:
    """For each of n decisions and each read: what changes the choice, all else as it was.

    change (n, reads): SI, signed, the nearest that does; NaN where none within the domain does. Of
    a discrete read the index of the value that would. becomes (n, reads): the choice then.
    share (n, reads): its size as a share of the domain's width; infinite where there is none, and
    of discrete reads, which have no distance.
    """

    change: Array
    becomes: Integers
    share: Array

    @property
    def nearest(self) -> Integers:
        """(n,) the read with the least share."""
        return np.asarray(self.share.argmin(axis=1))


def margins_of(moments: Moments, at: Integers) -> Margins:
    """The margins of the decisions `at` (n,), by rules or weights."""
    reads = moments.arbiter.reads
    change = np.full((at.size, len(reads)), np.nan)
    becomes = np.full(change.shape, -1)
    for start in range(0, at.size, BLOCK):
        some = at[start : start + BLOCK]
        rows = slice(start, start + some.size)
        for k, read in enumerate(reads):
            along = _other_values if read.values else _along
            change[rows, k], becomes[rows, k] = along(moments, k, read, some)
    widths = np.array([np.inf if read.values else read.high - read.low for read in reads])
    share = np.abs(change) / widths
    share = np.where(np.isnan(change) | np.isinf(widths), np.inf, share)
    return Margins(change, becomes, share)


def _other_values(moments: Moments, place: int, read: Read, at: Integers) -> tuple[Array, Array]:
    """Of a discrete read the first other value with which another choice is made."""
    now = _now(moments, at)
    found, becomes = np.full(at.shape, np.nan), np.full(at.shape, -1)
    for value in reversed(range(len(read.values))):
        register = moments.decisions.register[at].copy()
        register[:, place] = value
        then = choices_if(moments, register, at)
        found, becomes = np.where(then != now, value, found), np.where(then != now, then, becomes)
    return found, becomes


def _now(moments: Moments, at: Integers) -> Integers:
    """What is chosen by what was read."""
    return choices_if(moments, moments.decisions.register[at], at)


def _along(moments: Moments, place: int, read: Read, at: Integers) -> tuple[Array, Array]:
    """The signed change of a continuous read that first makes another choice, and which."""
    value = moments.decisions.register[at, place]
    edges = _edges(moments, place, read, at)
    middles = 0.5 * (edges[:, 1:] + edges[:, :-1])
    count = middles.shape[1]
    register = np.repeat(moments.decisions.register[at], count, axis=0)
    register[:, place] = middles.reshape(-1)
    then = choices_if(moments, register, np.repeat(at, count)).reshape(middles.shape)
    differs = (then != _now(moments, at)[:, None]) & (edges[:, 1:] > edges[:, :-1])
    up = np.where(differs, np.maximum(edges[:, :-1] - value[:, None], 0.0), np.inf)
    up = np.where(edges[:, 1:] > value[:, None], up, np.inf)
    down = np.where(differs, np.maximum(value[:, None] - edges[:, 1:], 0.0), np.inf)
    down = np.where(edges[:, :-1] < value[:, None], down, np.inf)
    rows = np.arange(at.size)
    ways = [(up.argmin(axis=1), up), (down.argmin(axis=1), down)]
    sizes = [gaps[rows, first] for first, gaps in ways]
    goes_up = sizes[0] <= sizes[1]
    size = np.where(goes_up, sizes[0], -sizes[1])
    first = np.where(goes_up, ways[0][0], ways[1][0])
    is_found = np.isfinite(size)
    return np.where(is_found, size, np.nan), np.where(is_found, then[rows, first], -1)


def _edges(moments: Moments, place: int, read: Read, at: Integers) -> Array:
    """The ends of the domain, and the boundaries between, sorted (n, k); what is read splits none.

    Where a reading is beyond its domain, the domain reaches that far.
    """
    arbiter, register = moments.arbiter, moments.decisions.register[at]
    value = register[:, place]
    low, high = np.minimum(read.low, value), np.maximum(read.high, value)
    features = boundaries(arbiter, (read.name,))
    straight = [feature.code for feature in features if feature.is_affine]
    found = [low[:, None], high[:, None]]
    if straight:
        ends = []
        for end in (read.low, read.high):
            moved = register.copy()
            moved[:, place] = end
            ends.append(evaluate(straight, arbiter.register, moved))
        with np.errstate(divide="ignore", invalid="ignore"):
            share = ends[0] / (ends[0] - ends[1])
        found.append(read.low + share * (read.high - read.low))
    if len(straight) < len(features):
        found.append(_bent(arbiter, place, register, low, high))
    edges = np.concatenate(found, axis=1)
    edges = np.where(np.isfinite(edges), edges, low[:, None])
    return np.sort(np.clip(edges, low[:, None], high[:, None]), axis=1)


def _bent(arbiter: Arbiter, place: int, register: Array, low: Array, high: Array) -> Array:
    """Zeros of functions that are not straight, between the points of a grid; (n, k)."""
    name = arbiter.register[place]
    codes = [each.code for each in boundaries(arbiter, (name,)) if not each.is_affine]
    grid = low[:, None] + np.linspace(0.0, 1.0, GRID) * (high - low)[:, None]

    def values(points: Array) -> Array:
        """(n, m, codes) at points (n, m)."""
        many = np.repeat(register, points.shape[1], axis=0)
        many[:, place] = points.reshape(-1)
        found = evaluate(codes, arbiter.register, many)
        return np.asarray(found.reshape(*points.shape, len(codes)))

    signs = np.nan_to_num(values(grid)) > 0.0
    changes = signs[:, 1:] != signs[:, :-1]
    columns = []
    for k in range(len(codes)):
        for cell in np.flatnonzero(changes[..., k].any(axis=0)).tolist():
            a, b = grid[:, cell : cell + 1].copy(), grid[:, cell + 1 : cell + 2].copy()
            begins = signs[:, cell : cell + 1, k]
            for _ in range(HALVINGS):
                middle = 0.5 * (a + b)
                is_same = (np.nan_to_num(values(middle)[..., k]) > 0.0) == begins
                a, b = np.where(is_same, middle, a), np.where(is_same, b, middle)
            columns.append(np.where(changes[:, cell : cell + 1, k], b, np.nan))
    return np.concatenate(columns, axis=1) if columns else np.full((low.size, 1), np.nan)
