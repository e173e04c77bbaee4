"""How large the corrections are, and how sure: what prior and data say together.

The size s of the corrections is the one with the largest marginal likelihood (MacKay 1992), but
never less than what the tolerance would let pass over one horizon: a field is not called known
because it is called close.

Errors of neighbouring samples and windows are related (process noise, coloured noise). So the
information is divided by the factor by which the scores of blocks of windows spread more than
independent ones would (a design effect: Kish 1965). Resampling the blocks themselves would have no
rank here: there are fewer blocks than coefficients.
"""

from typing import Final

import numpy as np

from runtime.arrays import Array
from verifier.robot_topology.equations import Equations

GAIN: Final = 0.2
"""The prior deviation of a rate's gain."""
SIZES: Final = 2.0 ** np.arange(0, 9)
"""Of the corrections, in tolerances per horizon."""
BLOCK: Final = 2
"""Windows in a block: two horizons."""
ROUNDING: Final = 1e-10


def solved(rows: Equations, found: Array, least: Array) -> tuple[Array, Array]:
    """The best coefficients (P,) around `found`, and a root (P, P) of their covariance.

    least (D,): of the sizes of the corrections, a rate per axis.
    """
    information, right = _sums(rows, found)
    effect = effect_of(rows, found, least)
    prior = _best_prior(information / effect, right / effect, least)
    precision = information / effect + np.diag(1.0 / prior)
    value = np.linalg.solve(precision, right / effect)
    root = _lower(np.linalg.inv(precision).astype(np.float64))
    return value.astype(np.float64), root


def effect_of(rows: Equations, found: Array, least: Array) -> float:
    """By how much the errors of blocks of windows spread more than independent ones."""
    information, right = _sums(rows, found)
    effect = 1.0
    for _ in range(2):
        prior = _best_prior(information / effect, right / effect, least)
        precision = information + effect * np.diag(1.0 / prior)
        value = np.linalg.solve(precision, right)
        effect = max(1.0, _design_effect(rows, value - found, information, precision))
    return effect


def evidence_of(rows: Equations, found: Array, least: Array, effect: float) -> float:
    """The logarithm of the marginal likelihood, of the best size, but for a constant."""
    information, right = _sums(rows, found)
    prior = _best_prior(information / effect, right / effect, least)
    return _evidence(information / effect, right / effect, prior)


def _sums(rows: Equations, found: Array) -> tuple[Array, Array]:
    """The normal equations of all windows, for the coefficients themselves."""
    design = rows.design.reshape(-1, rows.design.shape[-1])
    information = design.T @ design
    return information, design.T @ rows.residual.ravel() + information @ found


def _best_prior(information: Array, right: Array, least: Array) -> Array:
    count = len(right) // len(least)
    return max(
        (_prior(least * size, count) for size in SIZES),
        key=lambda each: _evidence(information, right, each),
    )


def _prior(sizes: Array, count: int) -> Array:
    """Prior variances (P,): `count` coefficients an axis, the last one its gain."""
    variances = np.repeat(sizes**2, count)
    variances[count - 1 :: count] = GAIN**2
    return variances


def _evidence(information: Array, right: Array, prior: Array) -> float:
    """The logarithm of the marginal likelihood, but for a constant."""
    root = np.sqrt(prior)
    lower = _lower(np.eye(len(root)) + root[:, None] * information * root)
    projected = np.linalg.solve(lower, root * right)
    return float(0.5 * projected @ projected - np.sum(np.log(np.diag(lower))))


def _design_effect(rows: Equations, step: Array, information: Array, precision: Array) -> float:
    """By how much more the scores of blocks spread than information says, on the average."""
    left = rows.residual - rows.design @ step
    scores = np.einsum("wrp,wr->wp", rows.design, left)
    count = max(1, len(scores) // BLOCK)
    summed = np.zeros((count, scores.shape[1]))
    np.add.at(summed, np.arange(len(scores)) * count // len(scores), scores)
    spread = np.sum(summed * np.linalg.solve(precision, summed.T).T)
    expected = np.trace(np.linalg.solve(precision, information))
    return float(spread / max(expected, 1e-300))


def _lower(matrix: Array) -> Array:
    """Cholesky's factor of a matrix that is positive definite but for rounding."""
    even = 0.5 * (matrix + matrix.T)
    even[np.diag_indices_from(even)] *= 1.0 + ROUNDING
    even[np.diag_indices_from(even)] += ROUNDING * np.mean(np.diag(even))
    return np.linalg.cholesky(even).astype(np.float64)
