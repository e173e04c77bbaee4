"""A formula as a sum of c(controls) * t(states), so that its tables stay small.

Controls that stand only in factors never become axes of a table: `mu * (1 - x**2) * v - x` is
mu * t1(x, v) + 1 * t2(x). A factor that reads both (`sin(x - phase)`) keeps its controls as axes.
Discrete states are dealt with value by value: [mode = 0] * f0 + [mode = 1] * f1.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import reduce
from itertools import product
from typing import final

from spec_schema.expressions.rewrite import names_in, simplify, substitute
from spec_schema.expressions.tree import Apply, Expr, Name, Number

MOST_TERMS = 48  # a product that would expand further stays as it is
MOST_CASES = 256  # combinations of discrete values in one term
ALWAYS: Expr = Number(1.0)


@final
class TooManyCasesError(Exception):
    """One term tells more combinations of discrete values apart than can be tabulated."""

    def __init__(self, names: list[str], combinations: int) -> None:
        self.names, self.combinations = names, combinations
        super().__init__(f"{combinations} combinations of {', '.join(names)}")


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
    for whole in _expanded(simplify(expr), continuous):
        for case, special in _cases(whole, discrete):
            for term in _expanded(special, continuous):
                summand = _split(term, continuous)
                found.append(Summand(_only_in(case, summand.coefficient), summand.part))
    return _joined(found)


def _only_in(case: Expr, coefficient: Expr) -> Expr:
    """The coefficient in its case, else 0: not a product, since 0 times infinity is no number."""
    if case == ALWAYS:
        return coefficient
    return Apply("where", (case, coefficient, Number(0.0)))


def _cases(expr: Expr, discrete: Mapping[str, int]) -> Iterator[tuple[Expr, Expr]]:
    """The expression for each combination of discrete values, and the condition for it."""
    read = sorted(names_in(expr) & discrete.keys())
    combinations = math.prod(discrete[name] for name in read)
    if combinations > MOST_CASES:
        raise TooManyCasesError(read, combinations)
    for values in product(*(range(discrete[name]) for name in read)):
        chosen: dict[str, Expr] = {
            name: Number(float(value)) for name, value in zip(read, values, strict=True)
        }
        tests: list[Expr] = [Apply("eq", (Name(name), value)) for name, value in chosen.items()]
        case = reduce(lambda a, b: Apply("and", (a, b)), tests, ALWAYS) if tests else ALWAYS
        yield case, simplify(substitute(expr, chosen))


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
