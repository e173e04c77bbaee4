"""A formula as a sum of c(controls) * t(states), so that its tables stay small.

Controls that stand only in factors never become axes of a table: `mu * (1 - x**2) * v - x` is
mu * t1(x, v) + 1 * t2(x). A factor that reads both (`sin(x - phase)`) keeps its controls as axes.
Discrete states are dealt with value by value: [mode = 0] * f0 + [mode = 1] * f1.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import product
from typing import final

from spec_schema.expressions.rewrite import names_in, simplify, substitute
from spec_schema.expressions.tree import Apply, Expr, Name, Number

MOST_TERMS = 48  # a product that would expand further stays as it is


@final
@dataclass(frozen=True, slots=True)
class Summand:
    """`coefficient * part`: the coefficient reads no continuous state, the part the rest."""

    coefficient: Expr
    part: Expr


def summands(
    expr: Expr, continuous: frozenset[str], discrete: Mapping[str, int]
) -> tuple[Summand, ...]:
    """`expr` as a sum; summands with the same coefficient are joined where that adds no axis.

    discrete: how many values each discrete state has.
    """
    found: list[Summand] = []
    for indicator, special in _cases(simplify(expr), discrete):
        for term in _expanded(special, continuous):
            summand = _split(term, continuous)
            found.append(Summand(simplify(_times(indicator, summand.coefficient)), summand.part))
    return _joined(found)


def _cases(expr: Expr, discrete: Mapping[str, int]) -> Iterator[tuple[Expr, Expr]]:
    read = sorted(names_in(expr) & discrete.keys())
    for values in product(*(range(discrete[name]) for name in read)):
        chosen: dict[str, Expr] = {
            name: Number(float(value)) for name, value in zip(read, values, strict=True)
        }
        tests: list[Expr] = [Apply("eq", (Name(name), value)) for name, value in chosen.items()]
        indicator: Expr = Number(1.0)
        for test in tests:
            indicator = _times(indicator, test)
        yield indicator, simplify(substitute(expr, chosen))


def _expanded(  # noqa: PLR0911  one return for each operation
    expr: Expr, continuous: frozenset[str]
) -> tuple[Expr, ...]:
    """`expr` as terms that no longer are sums, as far as separating them is of use."""
    match expr:
        case Apply("add", (left, right)):
            return (*_expanded(left, continuous), *_expanded(right, continuous))
        case Apply("sub", (left, right)):
            return (*_expanded(left, continuous), *map(_minus, _expanded(right, continuous)))
        case Apply("neg", (inner,)):
            return tuple(map(_minus, _expanded(inner, continuous)))
        case Apply("mul", (left, right)) if _is_mixed(left, continuous) or _is_mixed(
            right, continuous
        ):
            return _distributed(expr, left, right, continuous)
        case Apply("div", (left, right)) if _is_mixed(left, continuous):
            terms = _expanded(left, continuous)
            return tuple(Apply("div", (term, right)) for term in terms)
        case Apply("pow", (base, Number(value=power))) if power in (2.0, 3.0) and _is_mixed(
            base, continuous
        ):
            lower = base if power == 2.0 else Apply("mul", (base, base))
            return _distributed(expr, lower, base, continuous)
    return (expr,)


def _distributed(
    expr: Expr, left: Expr, right: Expr, continuous: frozenset[str]
) -> tuple[Expr, ...]:
    lefts, rights = _expanded(left, continuous), _expanded(right, continuous)
    if len(lefts) * len(rights) > MOST_TERMS:
        return (expr,)
    return tuple(_times(a, b) for a in lefts for b in rights)


def _is_mixed(expr: Expr, continuous: frozenset[str]) -> bool:
    names = names_in(expr)
    return bool(names & continuous) and not names <= continuous


def _split(term: Expr, continuous: frozenset[str]) -> Summand:
    coefficient: Expr = Number(1.0)
    part: Expr = Number(1.0)
    for factor, inverse in _factors(term, inverse=False):
        join = _over if inverse else _times
        if names_in(factor) & continuous:
            part = join(part, factor)
        else:
            coefficient = join(coefficient, factor)
    return Summand(simplify(coefficient), simplify(part))


def _factors(expr: Expr, *, inverse: bool) -> Iterator[tuple[Expr, bool]]:
    match expr:
        case Apply("mul", (left, right)):
            yield from _factors(left, inverse=inverse)
            yield from _factors(right, inverse=inverse)
        case Apply("div", (left, right)):
            yield from _factors(left, inverse=inverse)
            yield from _factors(right, inverse=not inverse)
        case Apply("neg", (inner,)):
            yield Number(-1.0), False
            yield from _factors(inner, inverse=inverse)
        case _:
            yield expr, inverse


def _joined(summands: list[Summand]) -> tuple[Summand, ...]:
    """Parts with the same coefficient summed where one's variables contain the other's."""
    widest_first = sorted(summands, key=lambda s: -len(names_in(s.part)))
    kept: list[Summand] = []
    for summand in widest_first:
        if summand.coefficient == Number(0.0) or summand.part == Number(0.0):
            continue
        for i, other in enumerate(kept):
            factor = _ratio(summand.coefficient, other.coefficient)
            if factor is not None and names_in(summand.part) <= names_in(other.part):
                scaled = _times(Number(factor), summand.part)
                kept[i] = Summand(other.coefficient, simplify(_plus(other.part, scaled)))
                break
        else:
            kept.append(summand)
    return tuple(kept)


def _ratio(coefficient: Expr, other: Expr) -> float | None:
    """How many times `other` the coefficient is, where that is plainly a number."""
    if coefficient == other:
        return 1.0
    match coefficient, other:
        case Number(value=a), Number(value=b) if b != 0.0 and math.isfinite(a / b):
            return a / b
    return None


def _plus(left: Expr, right: Expr) -> Expr:
    return Apply("add", (left, right))


def _times(left: Expr, right: Expr) -> Expr:
    return Apply("mul", (left, right))


def _over(left: Expr, right: Expr) -> Expr:
    return Apply("div", (left, right))


def _minus(expr: Expr) -> Expr:
    return _times(Number(-1.0), expr)
