"""The tree of an expression, and what each operation means.

A tree is immutable. `start` and `end` are character offsets into the text that it was read from
and `mark` those of its operator or function name; they take no part in `==`, and are 0 in trees
that no text holds (derivatives). All walks use an explicit stack, so depth costs no recursion.

What the operations mean, once for the whole house (IEEE 754 doubles, no exceptions):

* `add sub mul div neg pow sqrt exp log hypot` and the trigonometric ones as in C99's math.h:
  1/0 = inf, 0/0 = nan, sqrt(-1) = nan, log(0) = -inf, (-8)**(1/3) = nan; x**0 = 1 and 1**x = 1
  for every x.
* `mod` is Python's: the remainder has the sign of the divisor; x % 0 = nan.
* `lt le gt ge eq ne` give 1 or 0; with nan all give 0 but `ne`, which gives 1.
* `and or not where` take every number but 0 for true, nan included; the first three give 1 or 0.
  Both operands are always computed: there is no short cut, as there are no effects.
* `min max sign clip` give nan for nan; sign(0) = 0; clip(x, lo, hi) = min(max(x, lo), hi).
* `wrap` maps an angle to (-pi, pi] by the exact remainder of the double nearest to 2*pi.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import TypeAlias, TypeVar, final

ARITY: dict[str, int] = {
    **dict.fromkeys(("add", "sub", "mul", "div", "mod", "pow"), 2),
    **dict.fromkeys(("lt", "le", "gt", "ge", "eq", "ne", "and", "or"), 2),
    **dict.fromkeys(("neg", "not"), 1),
    **dict.fromkeys(("where", "clip"), 3),
    **dict.fromkeys(("min", "max", "hypot", "atan2"), 2),
    **dict.fromkeys(("abs", "sign", "sqrt", "exp", "log", "floor", "wrap"), 1),
    **dict.fromkeys(("sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh"), 1),
}
"""Every operation and how many operands it takes: the operations of the machine's code."""

FUNCTIONS: frozenset[str] = frozenset(
    {"abs", "sign", "min", "max", "clip", "sqrt", "hypot", "exp", "log", "floor", "wrap", "where"}
    | {"sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh"}
)
"""The operations that are written as calls, under their own names."""

COMPARISONS: dict[str, str] = {"lt": "<", "le": "<=", "gt": ">", "ge": ">=", "eq": "==", "ne": "!="}
"""The operations that compare, and how they are written."""

T = TypeVar("T")
N = TypeVar("N")


@final
@dataclass(frozen=True, slots=True)
class Number:
    """A finite literal. `pi` is the literal 3.141592653589793."""

    value: float
    start: int = field(default=0, compare=False, repr=False)
    end: int = field(default=0, compare=False, repr=False)


@final
@dataclass(frozen=True, slots=True)
class Name:
    """A variable, a control, a constant or a signal."""

    name: str
    start: int = field(default=0, compare=False, repr=False)
    end: int = field(default=0, compare=False, repr=False)


@final
@dataclass(frozen=True, slots=True)
class Text:
    """A value of a discrete variable: an operand of `eq` or `ne` beside its `Name`, no more."""

    text: str
    start: int = field(default=0, compare=False, repr=False)
    end: int = field(default=0, compare=False, repr=False)


@final
@dataclass(frozen=True, slots=True, eq=False)
class Apply:
    """An operation of `ARITY` applied to as many operands."""

    op: str
    operands: tuple["Expr", ...]
    start: int = field(default=0, repr=False)
    end: int = field(default=0, repr=False)
    mark: tuple[int, int] = field(default=(0, 0), repr=False)

    def __post_init__(self) -> None:
        assert len(self.operands) == ARITY[self.op], f"{self.op} takes {ARITY[self.op]} operands"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Apply) and same(self, other)

    def __hash__(self) -> int:
        return hash(tuple(node.op if isinstance(node, Apply) else node for node in walk(self)))


Expr: TypeAlias = Number | Name | Text | Apply


def walk(expr: Expr) -> Iterator[Expr]:
    """Every node, each before its operands, operands from left to right."""
    waiting = [expr]
    while waiting:
        node = waiting.pop()
        yield node
        if isinstance(node, Apply):
            waiting.extend(reversed(node.operands))


def same(first: Expr, second: Expr) -> bool:
    """Whether two trees are equal, wherever they stand in their texts."""
    waiting = [(first, second)]
    while waiting:
        a, b = waiting.pop()
        if a is b:
            continue
        if isinstance(a, Apply) and isinstance(b, Apply) and a.op == b.op:
            waiting.extend(zip(a.operands, b.operands, strict=True))
        elif isinstance(a, Apply) or isinstance(b, Apply) or a != b:
            return False
    return True


def fold(expr: Expr, visit: Callable[[Expr, tuple[T, ...]], T]) -> T:
    """`visit(node, results of its operands)` from the leaves to the root, left to right.

    A node that stands in several places of the tree is visited once.
    """
    return bottom_up(expr, operands_of, visit)


def operands_of(expr: Expr) -> tuple[Expr, ...]:
    """The operands of an operation; none for a leaf."""
    return expr.operands if isinstance(expr, Apply) else ()


def bottom_up(
    root: N, parts_of: Callable[[N], Sequence[N]], visit: Callable[[N, tuple[T, ...]], T]
) -> T:
    """What `fold` does, for any tree: each node once, after its parts, however deep."""
    done: dict[int, T] = {}
    waiting = [root]
    while waiting:
        node = waiting[-1]
        parts = parts_of(node)
        missing = [part for part in parts if id(part) not in done]
        if missing:
            waiting.extend(reversed(missing))
            continue
        waiting.pop()
        if id(node) not in done:
            done[id(node)] = visit(node, tuple(done[id(part)] for part in parts))
    return done[id(root)]
