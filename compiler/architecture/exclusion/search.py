"""Is there a point where a formula holds? Branch and prune over boxes, with a proof either way.

First the formula is split into conjunctions of comparisons. Of each, what follows from the order of
its terms is drawn (`order`), and equal terms are put for one another. Then boxes: narrowed by every
comparison (`contract`), dropped where one can't hold, tried at a point, else halved, down to
neighboring doubles. A point is found only where the formula holds as the machine works it out.
"""

import math
from collections import deque
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Final, TypeAlias, final

from compiler.architecture.exclusion.contract import contracted, possible
from compiler.architecture.exclusion.formula import (
    EQUAL,
    EVERY,
    LESS,
    MORE,
    ZERO,
    All,
    Atom,
    Formula,
    Some,
    both,
    compared,
    either,
    holds,
)
from compiler.architecture.exclusion.order import order_of
from spec_schema.expressions.bounds import interval_of
from spec_schema.expressions.evaluate import evaluate
from spec_schema.expressions.rewrite import names_in, substitute
from spec_schema.expressions.tree import Apply, Expr, Name, Number

BUDGET: Final = 2000
"""Boxes and branches of one search."""

NARROW: Final = 1e-9
"""Ranges that are narrower beside their numbers are one number but for rounding."""
VAST: Final = 1e6
"""Ranges of more units than that are without limits; their points are taken from the near end."""

Box: TypeAlias = dict[str, tuple[float, float]]


@final
@dataclass(frozen=True, slots=True)
class Variable:
    """What a name may be: low to high, or one of `options` (rising). unit: for round numbers."""

    low: float
    high: float
    options: tuple[float, ...] = ()
    unit: float = 1.0


@final
@dataclass(frozen=True, slots=True)
class Found:
    """The formula holds where the names have these values."""

    values: dict[str, float]


@final
@dataclass(frozen=True, slots=True)
class Nowhere:
    """It holds nowhere: proved with so many boxes."""

    boxes: int


@final
@dataclass(frozen=True, slots=True)
class Open:
    """The budget is spent; this box, among others, is left."""

    box: Box


Variables: TypeAlias = Mapping[str, Variable]


def solve(formula: Formula, variables: Variables, budget: int = BUDGET) -> Found | Nowhere | Open:
    """A point where the formula holds, or that there is none.

    Names that are in no comparison get a round number of their range.
    """
    search = _Search(formula, variables, budget)
    return search.run()


@final
class _Search:
    def __init__(self, formula: Formula, variables: Variables, budget: int) -> None:
        self._formula = formula
        self._variables = variables
        self._left = budget
        self._budget = budget
        self._root: Box = {name: (v.low, v.high) for name, v in variables.items()}

    def run(self) -> Found | Nowhere | Open:
        left: Box | None = None
        for atoms in self._conjunctions():
            found = self._conjunction(atoms)
            if isinstance(found, Found):
                return found
            left = left or found
            if self._left <= 0:
                break
        if self._left <= 0:
            return Open(left or self._root)
        return Nowhere(self._budget - self._left)

    def _conjunctions(self) -> Iterator[tuple[Atom, ...]]:
        """The formula as alternatives; those that contradict themselves are left out."""
        waiting: list[tuple[tuple[Atom, ...], tuple[Formula, ...]]] = [((), (self._formula,))]
        while waiting and self._left > 0:
            self._left -= 1
            atoms, rest = waiting.pop()
            known = self._known(both((*atoms, *(self._decided(part) for part in rest))))
            if known is None:
                continue
            atoms, choices = known
            if not choices:
                yield atoms
                continue
            first = min(choices, key=lambda some: len(some.parts))
            others = tuple(some for some in choices if some is not first)
            waiting.extend((atoms, (part, *others)) for part in reversed(first.parts))

    def _known(self, formula: Formula) -> tuple[tuple[Atom, ...], tuple[Some, ...]] | None:
        """Its comparisons and its alternatives; None where the comparisons contradict."""
        if formula is False:
            return None
        parts = formula.parts if isinstance(formula, All) else () if formula is True else (formula,)
        atoms = merged([part for part in parts if isinstance(part, Atom)])
        if order_of(atoms, self._root) is None:
            return None
        return atoms, tuple(part for part in parts if isinstance(part, Some))

    def _decided(self, formula: Formula) -> Formula:
        """The formula without what the ranges of its names decide."""
        match formula:
            case Atom(left=left, right=right, allowed=allowed):
                if _is_difference(formula, self._root):
                    assert isinstance(left, Apply), "a difference is an operation"
                    return self._decided(compared(left.operands[0], left.operands[1], allowed))
                can = possible(formula, self._root)
                if not can & ~allowed:
                    return True
                return Atom(left, right, can & allowed) if can & allowed else False
            case All(parts=parts):
                return both(self._decided(part) for part in parts)
            case Some(parts=parts):
                return either(self._decided(part) for part in parts)
        return formula

    def _conjunction(self, atoms: tuple[Atom, ...]) -> Found | Box | None:
        """A point, a box that is left, or (None) that there is nothing."""
        fixed: list[tuple[str, Expr]] = []
        while True:
            equal = order_of(atoms, self._root)
            if equal is None:
                return None
            swap = self._replaceable(equal, atoms)
            if swap is None:
                return self._boxes(atoms, fixed)
            name, term = swap
            fixed.append(swap)
            one = {name: term}
            rewritten = [
                compared(substitute(a.left, one), substitute(a.right, one), a.allowed)
                for a in atoms
            ]
            range_ = self._variables[name]
            ends = (
                compared(term, Number(range_.low), MORE | EQUAL),
                compared(term, Number(range_.high), LESS | EQUAL),
            )
            known = self._known(self._decided(both((*rewritten, *ends))))
            if known is None:
                return None
            atoms, _ = known

    def _replaceable(
        self, equal: list[tuple[Expr, Expr]], atoms: tuple[Atom, ...]
    ) -> tuple[str, Expr] | None:
        """A name of the atoms and the term that it must be equal to."""
        names = {n for a in atoms for side in (a.left, a.right) for n in names_in(side)}
        for pair in equal:
            for one, other in (pair, pair[::-1]):
                if not isinstance(one, Name) or one.name in names_in(other):
                    continue
                options = self._variables[one.name].options
                fits = not options or (isinstance(other, Number) and other.value in options)
                if one.name in names and fits:
                    return one.name, other
        return None

    def _boxes(self, atoms: tuple[Atom, ...], fixed: list[tuple[str, Expr]]) -> Found | Box | None:
        names = sorted({n for a in atoms for side in (a.left, a.right) for n in names_in(side)})
        queue = deque([dict(self._root)])
        while queue:
            if self._left <= 0:
                return queue[0]
            self._left -= 1
            box = self._narrowed(atoms, queue.popleft())
            if box is None:
                continue
            found = self._tried(box, fixed)
            if found is not None:
                return found
            queue.extend(self._halves(box, names))
        return None

    def _narrowed(self, atoms: tuple[Atom, ...], box: Box) -> Box | None:
        for atom in atoms:
            if not possible(atom, box) & atom.allowed:
                return None
            smaller = contracted(atom, box)
            if smaller is None:
                return None
            kept = self._to_options(smaller)
            if kept is None:
                return None
            box = kept
        return box

    def _to_options(self, box: Box) -> Box | None:
        for name, (low, high) in box.items():
            options = self._variables[name].options
            if options and (low not in options or high not in options):
                inside = [option for option in options if low <= option <= high]
                if not inside:
                    return None
                box[name] = (inside[0], inside[-1])
        return box

    def _tried(self, box: Box, fixed: list[tuple[str, Expr]]) -> Found | None:
        """The formula at a round point of the box."""
        values = {name: self._point(name, *ends) for name, ends in box.items()}
        for name, term in reversed(fixed):
            values[name] = evaluate(term, values)
        return Found(values) if holds(self._formula, values) else None

    def _point(self, name: str, low: float, high: float) -> float:
        variable = self._variables[name]
        if variable.options:
            inside = [option for option in variable.options if low <= option <= high]
            return inside[len(inside) // 2]
        return round_between(low, high, variable.unit)

    def _halves(self, box: Box, names: list[str]) -> list[Box]:
        """The box halved where it is widest beside what the name ranges over."""

        def width(name: str) -> float:
            low, high = box[name]
            whole = 0.5 * self._variables[name].high - 0.5 * self._variables[name].low
            return (0.5 * high - 0.5 * low) / whole if whole > 0.0 else 0.0

        # Widths of the smallest doubles are rounded to 0: what is no point is halved all the same.
        name = max((n for n in names if box[n][0] < box[n][1]), key=width, default=None)
        if name is None:
            return []
        return [{**box, name: part} for part in self._split(name, *box[name])]

    def _split(self, name: str, low: float, high: float) -> tuple[tuple[float, float], ...]:
        options = [o for o in self._variables[name].options if low <= o <= high]
        if options:
            middle = len(options) // 2
            return (low, options[middle - 1]), (options[middle], high)
        between = middle_of(low, high)
        if between in {low, high}:
            return (low, low), (high, high)
        return (low, between), (between, high)


def _is_difference(atom: Atom, box: Box) -> bool:
    """Whether it compares a difference of finite numbers with 0: the numbers compare as that does.

    IEEE 754 has gradual underflow, so a - b is 0 only where a and b are equal.
    """
    left, right = atom.left, atom.right
    if not (isinstance(left, Apply) and left.op == "sub" and right == ZERO):
        return False
    found = [interval_of(part, box) for part in left.operands]
    return not any(part.nan or part.is_empty or part.is_unbounded for part in found)


def merged(atoms: list[Atom]) -> tuple[Atom, ...]:
    """One atom for each pair of terms."""
    known: dict[tuple[str, str], Atom] = {}
    for atom in atoms:
        allowed = known[atom.key].allowed if atom.key in known else EVERY
        known[atom.key] = Atom(atom.left, atom.right, atom.allowed & allowed)
    return tuple(known.values())


def middle_of(low: float, high: float) -> float:
    """The middle of two numbers, however large; halves of the smallest doubles are rounded.

    >>> middle_of(-1e308, 1e308), middle_of(5e-324, 5e-324)
    (0.0, 5e-324)
    """
    return min(max(0.5 * low + 0.5 * high, low), high)


def round_between(low: float, high: float, unit: float = 1.0) -> float:
    """A number from low to high that is short to write in the unit; near the middle.

    >>> round_between(0.0, 0.3), round_between(0.2999, 0.3001), round_between(0.1, 0.1)
    (0.1, 0.3, 0.1)
    """
    if high - low > VAST * unit:
        near = 0.0 if low <= 0.0 <= high else min(low, high, key=abs)
        low, high = max(low, near - abs(near) - unit), min(high, near + abs(near) + unit)
    middle = middle_of(low, high)
    size = (high - low) / unit
    if size <= NARROW * abs(middle / unit):
        short = (round(middle / unit, digits) * unit for digits in range(16))
        return next((value for value in short if low <= value <= high), middle)
    if size > 0.0:
        first = -math.floor(math.log10(size))
        for digits in range(first, first + 3):
            value = round(middle / unit, digits) * unit
            if low < value < high:
                return value
    return middle
