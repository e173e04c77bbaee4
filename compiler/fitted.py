"""Curve fitting: the smooth surface of few numbers that is nearest to the arrows.

Each rate is a sum of products of one function per axis: Chebyshev polynomials along an ordinary
axis, sines and cosines along a periodic one. The degrees in a product add up to at most that of
the surface (a harmonic counts as its order), and the numbers before the products make the
weighted sum of squared misfits least. k: arrows; d: axes; m: rates; P: products.
"""

from dataclasses import dataclass
from functools import reduce
from itertools import product
from typing import Final, final

import numpy as np
from numpy.polynomial.chebyshev import chebvander

from compiler.scattered import SketchError
from runtime.arrays import Array
from spec_schema.wording import counted

HIGHEST: Final = 3
"""The highest degree that is chosen unasked."""
AMPLE: Final = 2
"""So many arrows for each number, where the degree is chosen: an average needs two."""
SOUND: Final = 1e3
"""The largest condition number of a degree that is chosen unasked."""
HOPELESS: Final = 1e8
"""The condition number from which on the arrows don't determine the surface."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Surface:
    """numbers: (P, m). exponents: (P, d) which function of each axis is in each product."""

    low: Array
    high: Array
    periodic: tuple[bool, ...]
    degree: int
    exponents: tuple[tuple[int, ...], ...]
    numbers: Array

    def __call__(self, points: Array) -> Array:
        """The rates (N, m) at points (N, d)."""
        products = _products(points, self.low, self.high, self.periodic, self.exponents)
        found: Array = products @ self.numbers
        return found


def least_squares(
    at: Array,
    go: Array,
    weights: Array,
    low: Array,
    high: Array,
    periodic: tuple[bool, ...],
    degree: int | None,
) -> Surface:
    """The surface of a degree, or of the highest up to 3 that the arrows determine well.

    at: (k, d); go: (k, m); weights: (k,) positive; low, high: (d,) the box of the surface.

    Raises:
        SketchError: the arrows don't determine a surface of this degree, or of any.
    """
    root = np.sqrt(weights)[:, np.newaxis]

    def products_of(degree: int) -> tuple[tuple[tuple[int, ...], ...], Array]:
        exponents = _exponents(periodic, degree)
        return exponents, root * _products(at, low, high, periodic, exponents)

    chosen = degree
    if chosen is None:
        chosen = 1
        while chosen < HIGHEST and _is_ample(products_of(chosen + 1)[1]):
            chosen += 1
    exponents, system = products_of(chosen)
    fewer = [d for d in range(1, chosen) if len(_exponents(periodic, d)) <= len(at)]
    _require_determined(system, chosen, f", or write 'degree: {fewer[-1]}'" if fewer else "")
    numbers, *_ = np.linalg.lstsq(system, root * go, rcond=None)
    return Surface(low, high, periodic, chosen, exponents, np.asarray(numbers, dtype=np.float64))


def _is_ample(system: Array) -> bool:
    arrows, numbers = system.shape
    return arrows >= AMPLE * numbers and _condition(system) <= SOUND


def _require_determined(system: Array, degree: int, lower: str) -> None:
    arrows, numbers = system.shape
    what = f"a surface of degree {degree} has {counted(numbers, 'number')} for each rate"
    if arrows < numbers:
        message = f"{what}, and {counted(arrows, 'arrow')} can't tell them all"
        raise SketchError(message, f"sketch at least {numbers} arrows{lower}")
    if _condition(system) > HOPELESS:
        message = f"{what}, and these arrows leave some of them open: they stand in too few places"
        raise SketchError(message, f"add arrows at other places along every axis{lower}")


def _condition(system: Array) -> float:
    values = np.linalg.svd(system, compute_uv=False)
    return float(values[0] / values[-1]) if values[-1] > 0.0 else float("inf")


def _exponents(periodic: tuple[bool, ...], degree: int) -> tuple[tuple[int, ...], ...]:
    """The products (P, d) of at most the degree; 2k - 1 is a sine, 2k a cosine."""
    each = [range((2 if turns else 1) * degree + 1) for turns in periodic]
    return tuple(
        found
        for found in product(*each)
        if sum((e + 1) // 2 if turns else e for e, turns in zip(found, periodic, strict=True))
        <= degree
    )


def _products(
    points: Array,
    low: Array,
    high: Array,
    periodic: tuple[bool, ...],
    exponents: tuple[tuple[int, ...], ...],
) -> Array:
    """The values (N, P) of the products."""
    share = (points - low) / (high - low)
    most = np.max(np.array(exponents), axis=0)
    each: list[Array] = [
        _harmonics(2.0 * np.pi * share[:, i], int(most[i]))
        if turns
        else np.asarray(chebvander(2.0 * share[:, i] - 1.0, int(most[i])), dtype=np.float64)
        for i, turns in enumerate(periodic)
    ]
    chosen = [functions[:, [e[i] for e in exponents]] for i, functions in enumerate(each)]
    found: Array = reduce(np.multiply, chosen)
    return found


def _harmonics(angle: Array, most: int) -> Array:
    """1, sin, cos, sin of twice the angle, and so on, up to index `most`: (N, most + 1)."""
    waves = [np.ones_like(angle)]
    for order in range(1, most // 2 + 1):
        waves += [np.sin(order * angle), np.cos(order * angle)]
    return np.stack(waves, axis=-1)
