"""The linearised flow along a path, and the multipliers of a cycle.

m: number of axes; K: segments of equal duration, one after the other; A: Jacobian (m, m) of the
rates. A fundamental matrix takes a small displacement from the beginning of a segment to its end.
"""

from functools import reduce
from typing import Final

import numpy as np

from runtime.arrays import Array
from verifier.topology.features import Stability
from verifier.topology.paths.motion import moved
from verifier.topology.slices import Slice, jacobians_at, rates_at

NODES: Final = np.array([0.5 - 15.0**0.5 / 10.0, 0.5, 0.5 + 15.0**0.5 / 10.0])
WEIGHTS: Final = np.array([5.0, 8.0, 5.0]) / 18.0
"""Gauss's quadrature with three nodes on [0, 1]."""

PARTS: Final = (16, 64, 256)
"""Parts of a segment over which one exponential is taken; more of them where it matters."""

SETTLED: Final = 1e-8
"""Logarithms of determinants that differ less than this from those with fewer parts are right."""

TAYLOR: Final = 12
"""Terms of the exponential of a matrix whose norm is below 1/2."""

NUDGE: Final = 1e-5
"""How far starts are displaced, in widths, where segments are differentiated by differences."""

LARGEST: Final = 700.0
"""Logarithms of multipliers beyond this are not numbers of the machine any more."""

AGREEMENT: Final = 1e-4
"""Multipliers by two methods that differ by more than this share are doubtful."""


def fundamental(
    view: Slice, starts: Array, duration: float, tolerance: float, levels: tuple[int, ...] = PARTS
) -> tuple[Array, Array]:
    """Fundamental matrices (K, m, m) of segments, and the logarithms (K,) of their determinants.

    The Magnus series to order 6 (Blanes, Casas, Oteo, Ros 2009, section 5.4), and Liouville's
    formula: the determinant's logarithm is the integral of the trace. levels: into how many parts
    segments are cut, one level after the other until the integral has settled.
    """
    known: Array | None = None
    for parts in levels:
        A = _jacobians_along(view, starts, duration, parts, tolerance)
        h = duration / parts
        logarithms = h * np.einsum("kpgii,g->k", A, WEIGHTS)
        if known is not None and np.all(np.abs(logarithms - known) < SETTLED):
            break
        known = logarithms
    return _ordered_product(_exponential(_magnus(A, h))), logarithms


def differenced(view: Slice, starts: Array, duration: float, tolerance: float) -> Array:
    """Fundamental matrices (K, m, m) of segments by central differences of their ends.

    Differences over two distances are extrapolated to none (Richardson).
    """
    count, m = starts.shape
    shifts = NUDGE * np.array([1.0, -1.0, 2.0, -2.0])
    around = starts[:, None, None] + shifts[:, None, None] * np.diag(view.width)
    times = np.array([0.0, duration])
    ends = moved(view, around.reshape(-1, m), times, tolerance)[:, -1].reshape(count, 4, m, m)
    near, far = ends[:, 0] - ends[:, 1], ends[:, 2] - ends[:, 3]
    slopes = (8.0 * near - far) / (12.0 * NUDGE * view.width[:, None])
    return np.asarray(np.swapaxes(slopes, -1, -2))


def multipliers(
    view: Slice, starts: Array, duration: float, tolerance: float
) -> tuple[tuple[complex, ...], tuple[complex, ...], bool]:
    """The m - 1 multipliers of the cycle of segments, the same by a second method, any doubt.

    In the plane the one multiplier is the determinant (Liouville), also where it is tiny. The
    second method, differences of the flow, also sees what the field's derivatives do not: jumps.
    """
    m = starts.shape[1]
    matrices, logarithms = fundamental(view, starts, duration, tolerance)
    values = _transverse(view, starts[0], matrices)
    if m == 2:
        values = (complex(np.exp(np.clip(logarithms.sum(), -LARGEST, LARGEST))),)
    second = _transverse(view, starts[0], differenced(view, starts, duration, tolerance))
    apart = [abs(a - b) > AGREEMENT * (1.0 + abs(a)) for a, b in zip(values, second, strict=True)]
    return values, second, any(apart) or not np.all(np.isfinite(second))


def inverted(values: tuple[complex, ...]) -> tuple[complex, ...]:
    """The multipliers of the same cycle, followed in the other direction of time."""
    least = np.exp(-LARGEST)
    return tuple(1.0 / (value if abs(value) > least else complex(least)) for value in values[::-1])


def stability(values: tuple[complex, ...], doubt: float) -> Stability:
    """What multipliers say of a cycle; neutral if one is within `doubt` of the unit circle."""
    growth = np.array([np.log(abs(value)) if value else -np.inf for value in values])
    if np.any(np.abs(growth) <= doubt):
        return Stability.NEUTRAL
    if np.all(growth < 0.0):
        return Stability.STABLE
    return Stability.UNSTABLE if np.all(growth > 0.0) else Stability.SADDLE


def _transverse(view: Slice, start: Array, matrices: Array) -> tuple[complex, ...]:
    """Eigenvalues of the product of `matrices` without the flow's own direction."""
    scaled = matrices * view.width / view.width[:, None]
    whole = reduce(lambda product, matrix: matrix @ product, scaled)
    direction = rates_at(view, start) / view.width
    frame = np.linalg.qr(np.column_stack([direction, np.eye(len(start))]))[0]
    inner = (frame.T @ whole @ frame)[1:, 1:]
    if not np.all(np.isfinite(inner)):
        return (complex(np.nan),) * (len(start) - 1)
    values = np.linalg.eigvals(inner)
    order = np.lexsort((-values.imag, -np.abs(values)))
    return tuple(complex(value) for value in values[order])


def _jacobians_along(
    view: Slice, starts: Array, duration: float, parts: int, tolerance: float
) -> Array:
    """Jacobians (K, parts, 3, m, m) at Gauss's nodes of each part of each segment."""
    h = duration / parts
    nodes = (h * (np.arange(parts)[:, None] + NODES)).ravel()
    times = np.concatenate([[0.0], nodes])
    points = moved(view, starts, times, tolerance)[:, 1:]
    A = jacobians_at(view, points)
    return A.reshape(len(starts), parts, 3, *A.shape[-2:])


def _magnus(A: Array, h: float) -> Array:
    """Exponents (K, parts, m, m) of order 6 from A (K, parts, 3, m, m)."""
    first, middle, last = A[:, :, 0], A[:, :, 1], A[:, :, 2]
    a1 = h * middle
    a2 = (15.0**0.5 * h / 3.0) * (last - first)
    a3 = (10.0 * h / 3.0) * (last - 2.0 * middle + first)
    c1 = _commutator(a1, a2)
    c2 = -_commutator(a1, 2.0 * a3 + c1) / 60.0
    return np.asarray(a1 + a3 / 12.0 + _commutator(-20.0 * a1 - a3 + c1, a2 + c2) / 240.0)


def _commutator(a: Array, b: Array) -> Array:
    return np.asarray(a @ b - b @ a)


def _exponential(exponents: Array) -> Array:
    """Exponentials of matrices (..., m, m): Taylor's series of a part, squared."""
    norm = float(np.nanmax(np.abs(exponents).sum(axis=-1), initial=1e-300))
    halvings = max(0, int(np.ceil(np.log2(norm))) + 1) if np.isfinite(norm) else 0
    small = exponents / 2.0**halvings
    unit = np.eye(exponents.shape[-1])
    value = np.broadcast_to(unit, exponents.shape)
    for k in range(TAYLOR, 0, -1):
        value = unit + small @ value / k
    for _ in range(halvings):
        value = value @ value
    return np.asarray(value)


def _ordered_product(matrices: Array) -> Array:
    """The products (K, m, m) of matrices (K, parts, m, m), later ones on the left."""
    while matrices.shape[1] > 1:
        matrices = matrices[:, 1::2] @ matrices[:, ::2]
    return matrices[:, 0]
