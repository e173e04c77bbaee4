"""Coefficients of cubic B-splines through values on evenly spaced nodes.

f: values at the n nodes; c: coefficients. On the cell between nodes i and i + 1 the spline is the
sum of c[i + k] w_k(t), k = 0 .. 3, t the position within the cell; at node i it is
(c[i] + 4 c[i + 1] + c[i + 2]) / 6. De Boor, A Practical Guide to Splines (2001), chapters IX, XI.
"""

import numpy as np

from runtime.arrays import Array

MINIMUM_NODES = 4


def not_a_knot(f: Array) -> Array:
    """Coefficients (n + 2, ...) of the C² spline through f (n, ...), n >= 4, with not-a-knot ends.

    Not-a-knot: the third derivative is continuous at the second and the last but one node, so that
    the fourth difference of c vanishes there. With the interpolation conditions around, this gives
    the coefficient of that node alone: c[2] = (8 f[1] - f[0] - f[2]) / 6.
    """
    n = len(f)
    c = np.empty((n + 2, *f.shape[1:]))
    c[2] = (8.0 * f[1] - f[0] - f[2]) / 6.0
    c[n - 1] = (8.0 * f[n - 2] - f[n - 3] - f[n - 1]) / 6.0
    if n > 4:
        right = 6.0 * f[2 : n - 2]
        right[0] -= c[2]
        right[-1] -= c[n - 1]
        c[3 : n - 1] = _solve(np.full(n - 4, 4.0), right)
    c[1] = 6.0 * f[1] - 4.0 * c[2] - c[3]
    c[0] = 6.0 * f[0] - 4.0 * c[1] - c[2]
    c[n] = 6.0 * f[n - 2] - 4.0 * c[n - 1] - c[n - 2]
    c[n + 1] = 6.0 * f[n - 1] - 4.0 * c[n] - c[n - 1]
    return c


def periodic(f: Array) -> Array:
    """Coefficients (n + 3, ...) of the C² periodic spline through f (n, ...), n >= 4.

    The cyclic system is a tridiagonal one plus a matrix of rank one (Sherman and Morrison 1950):
    A = T + u v', with u = (g, 0, ..., 0, 1), v = (1, 0, ..., 0, 1 / g), g = -4.
    """
    n = len(f)
    g = -4.0
    diagonal = np.full(n, 4.0)
    diagonal[0] -= g
    diagonal[-1] -= 1.0 / g
    u = np.zeros(n)
    u[0], u[-1] = g, 1.0
    y, z = _solve(diagonal, 6.0 * f), _solve(diagonal, u)
    share = (y[0] + y[-1] / g) / (1.0 + z[0] + z[-1] / g)
    centred = y - np.multiply.outer(z, share)
    return np.concatenate([centred[-1:], centred, centred[:2]])


def _solve(diagonal: Array, right: Array) -> Array:
    """Solve the tridiagonal system with ones beside `diagonal` (k,) for right (k, ...).

    Elimination without pivoting: the matrix is diagonally dominant.
    """
    x = np.array(right)
    pivot = diagonal.copy()
    for i in range(1, len(x)):
        pivot[i] -= 1.0 / pivot[i - 1]
        x[i] -= x[i - 1] / pivot[i - 1]
    x[-1] /= pivot[-1]
    for i in range(len(x) - 2, -1, -1):
        x[i] = (x[i] - x[i + 1]) / pivot[i]
    return x
