"""Traps by Lyapunov's function of the linearisation: ellipsoids that nothing leaves.

m: number of axes. e: differences from a fixed point as shares of the axes' widths. For a flow
followed backward in time `sign` is -1: what repels then attracts.
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Booleans, frozen
from verifier.topology.slices import Slice, jacobians_at, rates_at, shortest

SHELLS: Final = 0.8 ** np.arange(40.0)[::-1]
"""Sizes of the ellipsoids that are tried, as shares of the largest one."""

DECAY: Final = 0.05
"""What of its decay by the linearisation e'Pe must keep on every shell of a trap."""

DIRECTIONS: Final = {1: 2, 2: 96, 3: 400, 4: 1200}
"""How many points of each shell are looked at, by the number of axes."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Ellipsoid:
    """The places e'Pe <= 1 round the fixed point `index` at `at`, which nothing leaves.

    On samples of every shell in it, e'Pe falls: Lyapunov's function of the linearisation (Khalil
    2002, theorem 4.6) is one of the field itself. Samples, no proof: kinks between may escape.
    """

    index: int
    at: Array
    metric: Array

    def holds(self, view: Slice, points: Array) -> Booleans:
        """Which of `points` (..., m) lie in it."""
        e = shortest(view, points - self.at) / view.width
        return np.asarray(_energy(self.metric, e) <= 1.0)


def ellipsoid_round(
    view: Slice, index: int, at: Array, others: Array, sign: int
) -> Ellipsoid | None:
    """The largest one without `others` (k, m) in which e'Pe falls on every shell, if any."""
    P = _lyapunov(view, at, sign)
    if P is None:
        return None
    largest = _room(view, at, P, others)
    root = np.linalg.inv(np.linalg.cholesky(P)).T
    unit = _directions(at.size) @ root.T
    e = np.sqrt(largest) * SHELLS[:, None, None] * unit
    moved = sign * rates_at(view, at + e * view.width) / view.width
    if view.is_map:
        falls = _energy(P, e + moved) - _energy(P, e)
    else:
        falls = 2.0 * np.einsum("...i,ij,...j", e, P, moved)
    # NaN, outside the domain, fails as well.
    good = np.all(falls <= -DECAY * np.sum(e * e, axis=-1), axis=-1)
    count = len(good) if good.all() else int(np.argmin(good))
    if count == 0 or largest <= 0.0:
        return None
    size = largest * SHELLS[count - 1] ** 2
    return Ellipsoid(index, at, frozen(P / size))


def _lyapunov(view: Slice, at: Array, sign: int) -> Array | None:
    """P with J'P + PJ = -1, of maps J'PJ - P = -1, in shares; None where it is not positive."""
    J = jacobians_at(view, at[None])[0] * view.width / view.width[:, None]
    one = np.eye(at.size)
    if not np.all(np.isfinite(J)):
        return None
    if view.is_map:
        system = np.kron(J.T, J.T) - np.kron(one, one)
    else:
        system = sign * (np.kron(one, J.T) + np.kron(J.T, one))
    try:
        P = np.linalg.solve(system, -one.ravel()).reshape(one.shape)
    except np.linalg.LinAlgError:
        return None
    P = 0.5 * (P + P.T)
    return P if np.linalg.eigvalsh(P).min() > 0.0 else None


def _room(view: Slice, at: Array, P: Array, others: Array) -> float:
    """The largest e'Pe of an ellipsoid within the domain and without other features."""
    low, high = (at - view.low) / view.width, (view.low + view.width - at) / view.width
    gap = np.where(view.periodic, 0.5, np.minimum(low, high))
    inside = float(np.min(gap * gap / np.diag(np.linalg.inv(P))))
    apart = _energy(P, shortest(view, others - at) / view.width)
    apart = apart[apart > 1e-12 * np.trace(P)]
    return min(inside, 0.99 * float(apart.min(initial=np.inf)))


def _energy(P: Array, e: Array) -> Array:
    return np.asarray(np.einsum("...i,ij,...j", e, P, e))


def _directions(m: int) -> Array:
    """Points (d, m) all over the unit sphere, the same every time."""
    if m == 1:
        return np.array([[-1.0], [1.0]])
    if m == 2:
        angles = 2.0 * np.pi * np.arange(DIRECTIONS[2]) / DIRECTIONS[2]
        return np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    normal = np.random.default_rng(0).standard_normal((DIRECTIONS[m], m))
    return np.asarray(normal / np.linalg.norm(normal, axis=-1, keepdims=True))
