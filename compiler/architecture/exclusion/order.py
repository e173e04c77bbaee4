"""What follows from comparisons alone: they contradict one another, or make terms equal.

Doubles that are no nan are ordered, so `a < b`, `b <= c` and `c <= a` can't hold together whatever
the terms are and however they are rounded: a circle with a strict step in it. This sees what boxes
never do: that `c < near` and `c >= near` exclude each other, as near as both come to it.
"""

import itertools
from collections.abc import Iterable, Mapping
from typing import final

from compiler.architecture.exclusion.formula import EQUAL, LESS, MORE, NONE, Atom
from spec_schema.expressions.bounds import interval_of
from spec_schema.expressions.printers.numerals import numeral
from spec_schema.expressions.printers.postfix import to_postfix
from spec_schema.expressions.tree import Expr, Number


@final
class Order:
    """Terms and what is known of their order; as bits, so that its closure is quick."""

    def __init__(self) -> None:
        self._terms: list[Expr] = []
        self._places: dict[str, int] = {}
        self._at_most: list[int] = []
        self._below: list[int] = []

    def place(self, term: Expr) -> int:
        """The number of a term."""
        key = numeral(term.value + 0.0) if isinstance(term, Number) else to_postfix(term)
        if key not in self._places:
            self._places[key] = len(self._terms)
            self._at_most.append(1 << len(self._terms))
            self._below.append(0)
            self._terms.append(term)
        return self._places[key]

    def add(self, left: Expr, right: Expr, *, strict: bool) -> None:
        """Left is at most right, or below it."""
        a, b = self.place(left), self.place(right)
        self._at_most[a] |= 1 << b
        if strict:
            self._below[a] |= 1 << b

    def close(self) -> bool:
        """Draw every conclusion (Warshall 1962); False where a term is below itself."""
        at_most, below = self._at_most, self._below
        for k in range(len(at_most)):
            bit = 1 << k
            for i in range(len(at_most)):
                if below[i] & bit:
                    below[i] |= at_most[k]
                if at_most[i] & bit:
                    below[i] |= below[k]
                    at_most[i] |= at_most[k]
        return not any(row >> i & 1 for i, row in enumerate(below))

    def are_equal(self, left: Expr, right: Expr) -> bool:
        """Whether each is at most the other."""
        a, b = self.place(left), self.place(right)
        return bool(self._at_most[a] >> b & 1 and self._at_most[b] >> a & 1)

    def equal_terms(self) -> list[tuple[Expr, Expr]]:
        """Pairs of terms that are equal."""
        return [
            (self._terms[i], self._terms[j])
            for i, row in enumerate(self._at_most)
            for j in range(i + 1, len(self._terms))
            if row >> j & 1 and self._at_most[j] >> i & 1
        ]


def order_of(
    atoms: Iterable[Atom], box: Mapping[str, tuple[float, float]]
) -> list[tuple[Expr, Expr]] | None:
    """The terms that the atoms make equal over the box; None where they contradict one another.

    Atoms that allow "no number" say nothing here.
    """
    order = Order()
    known = [atom for atom in atoms if not atom.allowed & NONE]
    for atom in known:
        if atom.allowed == 0:
            return None
        _compare(order, atom)
    _place_between_numbers(order, known, box)
    if not order.close():
        return None
    for atom in known:
        if not atom.allowed & EQUAL and order.are_equal(atom.left, atom.right):
            return None
    return order.equal_terms()


def _compare(order: Order, atom: Atom) -> None:
    if not atom.allowed & MORE:
        order.add(atom.left, atom.right, strict=not atom.allowed & EQUAL)
    if not atom.allowed & LESS:
        order.add(atom.right, atom.left, strict=not atom.allowed & EQUAL)


def _place_between_numbers(
    order: Order, atoms: list[Atom], box: Mapping[str, tuple[float, float]]
) -> None:
    """Each term lies between its bounds, and numbers have their own order."""
    numbers: set[float] = set()
    for term in {to_postfix(t): t for atom in atoms for t in (atom.left, atom.right)}.values():
        if isinstance(term, Number):
            numbers.add(term.value + 0.0)
            continue
        found = interval_of(term, box)
        if found.is_empty or found.is_unbounded:
            continue
        order.add(Number(found.low + 0.0), term, strict=False)
        order.add(term, Number(found.high + 0.0), strict=False)
        numbers |= {found.low + 0.0, found.high + 0.0}
    ordered = sorted(numbers)
    for a, b in itertools.pairwise(ordered):
        order.add(Number(a), Number(b), strict=True)
