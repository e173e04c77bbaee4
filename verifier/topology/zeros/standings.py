"""Zeros of the tables held against those of the formula that the tables were made from.

A zero that both have is moved by the tables' error, but it keeps its index (the sign of the
Jacobian's determinant); invented ones come in pairs of opposite index. k: zeros; m: axes.
"""

from typing import Final

import numpy as np

from runtime.arrays import Array, Booleans, frozen
from verifier.topology.features import Standing, UndecidedBox
from verifier.topology.slices import Slice, shortest
from verifier.topology.zeros.proof import Proof

NODES: Final = 2.0
"""A table may move a zero by so many of its nodes before it is another one."""

SHARE: Final = 0.02
"""The same as a share of the domain, where no table stands over an axis."""


def compared(view: Slice, tables: Proof, formula: Proof) -> tuple[tuple[Standing, ...], Array]:
    """The standing of each zero of the tables, and the zeros (k, m) of the formula they lack."""
    reach = _reach(view)
    pairs = _pairs(view, tables, formula, reach)
    partners = dict(pairs)
    standings = tuple(
        Standing.SHARED if i in partners else _alone(at, formula.undecided, reach)
        for i, at in enumerate(tables.zeros)
    )
    matched = {j for _, j in pairs}
    lost = [
        zero
        for j, zero in enumerate(formula.zeros)
        if j not in matched and not _is_beside(zero, tables.undecided, reach)
    ]
    return standings, frozen(np.reshape(lost, (-1, len(view.axes))))


def _reach(view: Slice) -> Array:
    """How far (m,) a table may move a zero."""
    steps = [
        max(
            (a.step for t in view.program.field.tables for a in t.axes if a.name == name), default=0
        )
        for name in (axis.name for axis in view.axes)
    ]
    return np.asarray(
        np.maximum(NODES * np.array(steps), SHARE * view.width * (np.array(steps) == 0.0))
    )


def _pairs(view: Slice, a: Proof, b: Proof, reach: Array) -> list[tuple[int, int]]:
    """Zeros of both that are near and have one index, the nearest first, each once."""
    if not len(a.zeros) or not len(b.zeros):
        return []
    apart = np.abs(shortest(view, a.zeros[:, None] - b.zeros)) / reach
    distance = apart.max(axis=-1)
    distance[_index(view, a)[:, None] != _index(view, b)] = np.inf
    pairs: list[tuple[int, int]] = []
    while distance.min() <= 1.0:
        i, j = np.unravel_index(np.argmin(distance), distance.shape)
        pairs.append((int(i), int(j)))
        distance[i, :] = distance[:, j] = np.inf
    return pairs


def _index(view: Slice, proof: Proof) -> Array:
    J = 0.5 * (proof.slopes.low + proof.slopes.high)
    own = np.eye(len(view.axes)) if view.is_map else 0.0
    return np.asarray(np.sign(np.linalg.det(J - own)))


def _alone(at: Array, undecided: tuple[UndecidedBox, ...], reach: Array) -> Standing:
    return Standing.UNCOMPARED if _is_beside(at, undecided, reach) else Standing.INVENTED


def _is_beside(at: Array, boxes: tuple[UndecidedBox, ...], reach: Array) -> bool:
    near: list[Booleans] = [(at >= b.low - reach) & (at <= b.high + reach) for b in boxes]
    return any(bool(np.all(one)) for one in near)
