"""From text to tree: Python's grammar, a whitelist, and nothing is ever evaluated.

The language: numbers, names, `pi`, + - * / % ** and unary -, comparisons (a chain means `and`),
`and or not`, calls of `FUNCTIONS`, and 'texts' compared with a discrete variable's name by == or
!=. There are no truth literals: a condition is a number, 1 or 0.
"""

import ast
import math
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from functools import reduce
from itertools import pairwise
from typing import final

from spec_schema.expressions.refusals import UNCOMPARED, UNLIKE, refuse, refuse_call, refuse_name
from spec_schema.expressions.scan import scan
from spec_schema.expressions.tree import (
    ARITY,
    FUNCTIONS,
    Apply,
    Expr,
    Name,
    Number,
    Text,
    bottom_up,
    fold,
)
from spec_schema.faults import ExpressionError, Fault

DEEPEST = 200
"""Operations within operations."""

BINARY: dict[type[ast.operator], tuple[str, str]] = {
    ast.Add: ("add", "+"),
    ast.Sub: ("sub", "-"),
    ast.Mult: ("mul", "*"),
    ast.Div: ("div", "/"),
    ast.Mod: ("mod", "%"),
    ast.Pow: ("pow", "**"),
}

COMPARE: dict[type[ast.cmpop], tuple[str, str]] = {
    ast.Lt: ("lt", "<"),
    ast.LtE: ("le", "<="),
    ast.Gt: ("gt", ">"),
    ast.GtE: ("ge", ">="),
    ast.Eq: ("eq", "=="),
    ast.NotEq: ("ne", "!="),
}

N_ARY = frozenset({"min", "max"})
"""Functions of two or more arguments: min(a, b, c) is min(min(a, b), c)."""

NOTHING = Number(0.0)
"""Stands where a fault was found, so that the rest can be read."""


def parse(text: str) -> Expr:
    """The tree of an expression.

    Raises:
        ExpressionError: with every fault that can be told from the text.
    """
    scanned = scan(text)
    if scanned.repaired is None:
        raise ExpressionError(scanned.faults)
    root = _grammar(scanned.repaired)
    if isinstance(root, Fault):
        raise ExpressionError([*scanned.faults, root])
    reading = _Reading(text, scanned.repaired)
    found: list[Fault] = []
    expr = bottom_up(root, _parts, lambda node, parts: _built(reading, node, parts, found))
    found.extend(_misplaced_texts(Apply("neg", (expr,))))
    # A repaired sign is told by the scan; the tree would tell of what stands in for it.
    told = {fault.start for fault in scanned.faults}
    faults = [*scanned.faults, *(fault for fault in found if fault.start not in told)]
    if not faults:
        faults.extend(_too_deep(expr))
    if faults:
        raise ExpressionError(faults)
    return expr


def _grammar(text: str) -> ast.expr | Fault:
    """Python's syntax tree of the (scanned, so bounded) text."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # remarks on texts that the whitelist refuses anyway
            return ast.parse(text.strip(), mode="eval").body
    except SyntaxError as error:
        start = min(len(text), len(text) - len(text.lstrip()) + max(0, (error.offset or 1) - 1))
        return Fault(
            start, min(len(text), start + 1), "S133", "this can't be read as an expression"
        )
    except (ValueError, RecursionError, MemoryError):
        return Fault(0, 1, "S132", "the expression is too large to be read")


def _too_deep(expr: Expr) -> Iterator[Fault]:
    if fold(expr, lambda _, depths: 1 + max(depths, default=0)) > DEEPEST:
        message = f"the expression nests more than {DEEPEST} operations"
        yield Fault(0, 1, "S132", message, "bracket the parts of a long sum: (a + b) + (c + d)")


@final
@dataclass(frozen=True, slots=True)
class _Reading:
    """The text as the user wrote it and as the parser saw it, and places in both."""

    text: str
    repaired: str

    def span(self, node: ast.expr) -> tuple[int, int]:
        """Character offsets of a node; Python's own count UTF-8 bytes."""
        margin = len(self.repaired) - len(self.repaired.lstrip())
        if self.repaired.isascii():
            return node.col_offset + margin, (node.end_col_offset or 0) + margin
        data = self.repaired.strip().encode()
        start, end = data[: node.col_offset], data[: node.end_col_offset]
        return len(start.decode()) + margin, len(end.decode()) + margin

    def source(self, node: ast.expr) -> str:
        """The text of a node."""
        start, end = self.span(node)
        return self.text[start:end]

    def sign(self, symbol: str, left: ast.expr, right: ast.expr) -> tuple[int, int]:
        """Where the operator between two nodes stands (between them are brackets at most)."""
        start = self.repaired.find(symbol, self.span(left)[1], self.span(right)[0])
        return start, start + len(symbol)


def _parts(node: ast.expr) -> list[ast.expr]:  # noqa: PLR0911  # one per kind of node
    """The nodes to read before this one."""
    match node:
        case ast.BinOp(left=left, right=right):
            return [left, right]
        case ast.UnaryOp(operand=operand):
            return [operand]
        case ast.BoolOp(values=values):
            return values
        case ast.Compare(left=left, comparators=comparators):
            return [left, *comparators]
        case ast.Call(args=args):
            return args
        case ast.IfExp(test=test, body=body, orelse=orelse):
            return [test, body, orelse]
    return []


def _built(reading: _Reading, node: ast.expr, parts: tuple[Expr, ...], faults: list[Fault]) -> Expr:
    """The tree of one node; where it is refused, `NOTHING`, and the reason in `faults`."""
    result = _translated(reading, node, parts)
    if isinstance(result, Fault):
        faults.append(result)
        return NOTHING
    faults.extend(_misplaced_texts(result))
    return result


def _translated(  # noqa: PLR0911  # one per kind of node
    reading: _Reading, node: ast.expr, parts: tuple[Expr, ...]
) -> Expr | Fault:
    match node:
        case ast.Constant():
            return _constant(reading, node)
        case ast.Name():
            return _name(reading, node)
        case ast.UnaryOp():
            return _unary(reading, node, parts[0])
        case ast.BinOp():
            return _binary(reading, node, parts)
        case ast.BoolOp():
            return _logic(reading, node, parts)
        case ast.Compare():
            return _comparison(reading, node, parts)
        case ast.Call():
            return _call(reading, node, parts)
    start, end = reading.span(node)
    return Fault(start, end, "S134", *refuse(node, reading.source))


def _constant(reading: _Reading, node: ast.Constant) -> Expr | Fault:
    start, end = reading.span(node)
    value = node.value
    if isinstance(value, str):
        return Text(value, start, end)
    if isinstance(value, bool) or not isinstance(value, int | float):
        return Fault(start, end, "S134", *refuse(node, reading.source))
    try:
        number = float(value)
    except OverflowError:
        number = math.inf
    if math.isinf(number):
        message = f"the number {_short(reading.source(node))} is too large"
        return Fault(start, end, "S135", message, "numbers reach up to 1.797e308")
    return Number(number, start, end)


def _short(text: str) -> str:
    return text if len(text) <= 20 else f"{text[:17]}..."


def _name(reading: _Reading, node: ast.Name) -> Expr | Fault:
    start, end = reading.span(node)
    if node.id == "pi":
        return Number(math.pi, start, end)
    refused = refuse_name(node.id)
    return Fault(start, end, "S134", *refused) if refused else Name(node.id, start, end)


def _unary(reading: _Reading, node: ast.UnaryOp, part: Expr) -> Expr | Fault:
    start, end = reading.span(node)
    match node.op, part:
        case ast.UAdd(), _:
            return part
        case ast.USub(), Number(value=value):
            return Number(-value, start, end)
        case ast.USub(), _:
            return Apply("neg", (part,), start, end, (start, start + 1))
        case ast.Not(), _:
            return Apply("not", (part,), start, end, (start, start + 3))
    return Fault(start, start + 1, "S134", "'~' is not part of the language", "write not")


def _binary(reading: _Reading, node: ast.BinOp, parts: tuple[Expr, ...]) -> Expr | Fault:
    if type(node.op) not in BINARY:
        symbol, advice = UNLIKE[type(node.op)]
        mark = reading.sign(symbol, node.left, node.right)
        return Fault(*mark, "S134", f"'{symbol}' is not part of the language", advice)
    op, symbol = BINARY[type(node.op)]
    return Apply(op, parts, *reading.span(node), reading.sign(symbol, node.left, node.right))


def _logic(reading: _Reading, node: ast.BoolOp, parts: tuple[Expr, ...]) -> Expr:
    op = "and" if isinstance(node.op, ast.And) else "or"
    tree = parts[0]
    for (left, right), part in zip(pairwise(node.values), parts[1:], strict=True):
        mark = reading.sign(op, left, right)
        tree = Apply(op, (tree, part), reading.span(node)[0], reading.span(right)[1], mark)
    return tree


def _comparison(reading: _Reading, node: ast.Compare, parts: tuple[Expr, ...]) -> Expr | Fault:
    nodes = [node.left, *node.comparators]
    links: list[Expr] = []
    for kind, (left, right), operands in zip(
        node.ops, pairwise(nodes), pairwise(parts), strict=True
    ):
        start, end = reading.span(left)[0], reading.span(right)[1]
        if type(kind) not in COMPARE:
            word, advice = UNCOMPARED[type(kind)]
            return Fault(start, end, "S134", f"'{word}' is not part of the language", advice)
        op, symbol = COMPARE[type(kind)]
        links.append(Apply(op, operands, start, end, reading.sign(symbol, left, right)))
    start, end = reading.span(node)
    return reduce(lambda a, b: Apply("and", (a, b), start, end, (start, end)), links)


def _call(reading: _Reading, node: ast.Call, parts: tuple[Expr, ...]) -> Expr | Fault:
    start, end = reading.span(node)
    mark = reading.span(node.func)
    if not isinstance(node.func, ast.Name) or node.func.id not in FUNCTIONS:
        return Fault(*mark, "S136", *refuse_call(reading.source(node.func)))
    op = node.func.id
    wanted = ARITY[op]
    if len(parts) < wanted or (len(parts) > wanted and op not in N_ARY):
        least = "at least " if op in N_ARY else ""
        message = f"{op} takes {least}{wanted} argument{'s' * (wanted > 1)} (got {len(parts)})"
        return Fault(start, end, "S137", message)
    if op not in N_ARY:
        return Apply(op, parts, start, end, mark)
    return reduce(lambda a, b: Apply(op, (a, b), start, end, mark), parts)


def _misplaced_texts(expr: Expr) -> Iterator[Fault]:
    """A text means something only beside the name of a discrete variable."""
    if not isinstance(expr, Apply):
        return
    beside_name = expr.op in {"eq", "ne"} and any(isinstance(p, Name) for p in expr.operands)
    for part in expr.operands:
        if isinstance(part, Text) and not beside_name:
            message = "a text can only be compared with a discrete variable, by == or !="
            yield Fault(part.start, part.end, "S138", message)
