"""A field with its correction: f_i (1 + a_i) + g_i for each axis i.

Coefficients (..., P): axis by axis those of the K functions of g_i, then the gain a_i. Letters: n
states, D axes, P = D (K + 1).
"""

from dataclasses import dataclass
from typing import final

import numpy as np

from runtime.arrays import Array, Integers
from runtime.flow import Flow, jacobian, rates
from verifier.robot_topology.basis import Basis, functions, slopes


@final
@dataclass(frozen=True, eq=False, slots=True)
class Corrected:
    """The spec's flow, and the functions that its correction is made of.

    columns (D,): of the axes in the state vector; lows, turns (D,): where an angle's domain
    begins and its period, 0 for other axes.
    """

    flow: Flow
    basis: Basis
    columns: Integers
    lows: Array
    turns: Array

    @property
    def count(self) -> int:
        """P, the number of coefficients."""
        return len(self.columns) * (self.basis.count + 1)


def corrected_rates(field: Corrected, x: Array, u: Array, coefficients: Array) -> Array:
    """Rates (..., n) at states x (..., n) and controls u (..., p)."""
    moved = spec_rates(field, x, u)
    weights, gains = _split(field, coefficients)
    phi = functions(field.basis, x[..., field.columns])
    one_for_all = weights.ndim == 2
    added = phi @ weights.T if one_for_all else (weights @ phi[..., None])[..., 0]
    moved[..., field.columns] = moved[..., field.columns] * (1.0 + gains) + added
    return moved


def corrected_slopes(field: Corrected, x: Array, u: Array, coefficients: Array) -> Array:
    """Derivatives (..., D, D) of the rates of the axes by the axes."""
    weights, gains = _split(field, coefficients)
    own = jacobian(field.flow, _wrapped(field, x), u)[..., field.columns, :][..., field.columns]
    bent = slopes(field.basis, x[..., field.columns], weights)
    return np.asarray(own * (1.0 + gains)[..., None] + bent)


def spec_rates(field: Corrected, x: Array, u: Array) -> Array:
    """The spec's own rates (..., n), at angles of any turn."""
    return rates(field.flow, _wrapped(field, x), u)


def step(field: Corrected, x: Array, u: Array, seconds: Array, coefficients: Array) -> Array:
    """States (..., n) after one step of the classical Runge-Kutta method; seconds (..., 1)."""
    k1 = corrected_rates(field, x, u, coefficients)
    k2 = corrected_rates(field, x + 0.5 * seconds * k1, u, coefficients)
    k3 = corrected_rates(field, x + 0.5 * seconds * k2, u, coefficients)
    k4 = corrected_rates(field, x + seconds * k3, u, coefficients)
    return np.asarray(x + seconds / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4))


def _wrapped(field: Corrected, x: Array) -> Array:
    """States with angles inside their domains."""
    moved = np.array(x)
    for column, low, turn in zip(field.columns, field.lows, field.turns, strict=True):
        if turn > 0.0:
            moved[..., column] = low + np.mod(x[..., column] - low, turn)
    return moved


def _split(field: Corrected, coefficients: Array) -> tuple[Array, Array]:
    """Coefficients (..., P) as those of functions (..., D, K) and gains (..., D)."""
    table = coefficients.reshape(*coefficients.shape[:-1], len(field.columns), -1)
    return table[..., :-1], table[..., -1]
