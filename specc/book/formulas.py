"""Expressions of a program as people write them, whole or in one mode."""

import re
from collections.abc import Mapping
from typing import Final

from compiler.architecture.codes import tree_of
from runtime.arbiter import Arbiter
from runtime.code import Code
from runtime.program import Program
from spec_schema.expressions.printers.text import to_text
from spec_schema.expressions.rewrite import names_in, rebuilt, simplify, substitute
from spec_schema.expressions.tree import Apply, Expr, Name, Number, Text, fold

POWER: Final = re.compile(r"\*\*(?=[\w(])")
NO_LABELS: Final[Mapping[str, tuple[str, ...]]] = {}


def labels_of(of: Program | Arbiter) -> dict[str, tuple[str, ...]]:
    """The values of each discrete state or read, by its name."""
    parts = of.states if isinstance(of, Program) else of.reads
    return {part.name: part.values for part in parts if part.values}


def written(code: Code, labels: Mapping[str, tuple[str, ...]] = NO_LABELS) -> str:
    """The expression with a real minus and multiplication sign, and values by their labels.

    >>> written(Code("side 1 eq gain neg x mul 0 where"), {"side": ("left", "right")})
    "where(side = 'right', −gain·x, 0)"
    """
    return of_tree(tree_of(code), labels)


def of_tree(tree: Expr, labels: Mapping[str, tuple[str, ...]] = NO_LABELS) -> str:
    """The same of a tree."""
    return plain(to_text(_labelled(tree, labels)))


def plain(text: str) -> str:
    """An expression of the language with the signs of print."""
    text = text.replace("<=", "≤").replace(">=", "≥").replace("==", "=").replace("!=", "≠")
    return POWER.sub("^", text).replace(" * ", "·").replace("*", "·").replace("-", "−")


def in_mode(code: Code, name: str, index: int) -> Expr:
    """The expression where the discrete state `name` has the value of that index."""
    tree = tree_of(code)
    return simplify(substitute(tree, {name: Number(float(index))})) if name else simplify(tree)


def reads(tree: Expr) -> set[str]:
    """The names that an expression depends on."""
    return set(names_in(tree))


def _labelled(tree: Expr, labels: Mapping[str, tuple[str, ...]]) -> Expr:
    """Indices of values as the values' names, where they are compared."""

    def named(node: Expr, operands: tuple[Expr, ...]) -> Expr:
        if not isinstance(node, Apply):
            return node
        known = [labels[p.name] for p in operands if isinstance(p, Name) and p.name in labels]
        if node.op in {"eq", "ne"} and known:
            operands = tuple(_label(part, known[0]) for part in operands)
        return rebuilt(node, operands)

    return fold(tree, named)


def _label(part: Expr, values: tuple[str, ...]) -> Expr:
    is_index = isinstance(part, Number) and part.value in range(len(values))
    return Text(values[int(part.value)]) if is_index and isinstance(part, Number) else part
