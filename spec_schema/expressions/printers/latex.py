r"""LaTeX for people: \frac, \sqrt, Greek letters, cases for `where`."""

import math
import re
from collections.abc import Callable

from spec_schema.expressions.printers.numerals import numeral
from spec_schema.expressions.printers.piece import (
    AND,
    ATOM,
    COMPARISON,
    NOT,
    OR,
    POWER,
    SIGN,
    SUM,
    TERM,
    Piece,
)
from spec_schema.expressions.tree import Apply, Expr, Name, Number, Text, fold

GREEK = frozenset(
    {"alpha", "beta", "gamma", "delta", "epsilon", "zeta", "eta", "theta", "iota", "kappa"}
    | {"lambda", "mu", "nu", "xi", "pi", "rho", "sigma", "tau", "upsilon", "phi", "chi", "psi"}
    | {"omega", "Gamma", "Delta", "Theta", "Lambda", "Xi", "Pi", "Sigma", "Phi", "Psi", "Omega"}
)

GROUPED: dict[str, tuple[str, int]] = {
    "or": (r" \lor ", OR),
    "and": (r" \land ", AND),
    "add": (" + ", SUM),
    "sub": (" - ", SUM),
    "mod": (r" \bmod ", TERM),
}

COMPARED: dict[str, str] = {
    "lt": "<",
    "le": r"\le",
    "gt": ">",
    "ge": r"\ge",
    "eq": "=",
    "ne": r"\ne",
}

NAMED: dict[str, str] = {
    "log": r"\ln",
    "asin": r"\arcsin",
    "acos": r"\arccos",
    "atan": r"\arctan",
    "sign": r"\operatorname{sgn}",
    **{op: rf"\operatorname{{{op}}}" for op in ("atan2", "hypot", "clip", "wrap")},
}
"""Functions that have another name in LaTeX; the rest stand after a backslash as they are."""

AROUND: dict[str, str] = {
    "abs": r"\left|%s\right|",
    "floor": r"\left\lfloor %s\right\rfloor",
    "sqrt": r"\sqrt{%s}",
}

LOOSEST = 0


def to_latex(expr: Expr) -> str:
    r"""The expression as LaTeX mathematics, without dollar signs.

    >>> from spec_schema.expressions.parse import parse
    >>> to_latex(parse("v_max*sin(theta)/2"))
    '\\frac{v_{\\mathrm{max}} \\, \\sin\\left(\\theta\\right)}{2}'
    """
    return fold(expr, _piece).text


def _piece(node: Expr, operands: tuple[Piece, ...]) -> Piece:
    match node:
        case Number(value=value):
            return _number(value)
        case Name(name=name):
            return Piece(_name(name))
        case Text(text=text):
            return Piece(rf"\text{{{_escaped(text)}}}")
        case Apply(op=op):
            return _operation(op, operands)


def _number(value: float) -> Piece:
    if abs(value) == math.pi:
        return Piece(r"\pi") if value > 0 else Piece(r"-\pi", SIGN)
    text = numeral(value)
    mantissa, mark, exponent = text.partition("e")
    if mark:
        power = f"10^{{{int(exponent)}}}"
        factor = {"1": "", "-1": "-"}.get(mantissa, mantissa + r" \cdot ")
        return Piece(factor + power, SIGN if value < 0 else TERM)
    return Piece(text, SIGN if value < 0 else ATOM)


def _name(name: str) -> str:
    head, _, tail = name.partition("_")
    if not tail and (numbered := re.fullmatch(r"([^\W\d_]+)(\d+)", name)):
        head, tail = numbered.groups()
    if head in GREEK:
        letters = f"\\{head}"
    else:
        letters = head if len(head) == 1 else rf"\mathit{{{_escaped(head or '_')}}}"
    if not tail:
        return letters
    below = tail if tail.isdigit() else rf"\mathrm{{{_escaped(tail)}}}"
    return f"{letters}_{{{below}}}"


def _escaped(text: str) -> str:
    special = {"\\": r"\textbackslash{}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}"}
    return "".join(special.get(c, f"\\{c}" if c in "#$%&_{}" else c) for c in text)


def _operation(op: str, operands: tuple[Piece, ...]) -> Piece:
    if op in GROUPED:
        symbol, level = GROUPED[op]
        return Piece(f"{_in(operands[0], level)}{symbol}{_in(operands[1], level + 1)}", level)
    if op in COMPARED:
        sides = (_in(part, COMPARISON + 1) for part in operands)
        return Piece(f" {COMPARED[op]} ".join(sides), COMPARISON)
    if op in AROUND:
        return Piece(AROUND[op] % operands[0].text, POWER if op == "sqrt" else ATOM)
    if op in SHAPES:
        return SHAPES[op](*operands)
    name = NAMED.get(op, f"\\{op}")
    return Piece(rf"{name}\left({', '.join(part.text for part in operands)}\right)")


def _negative(a: Piece) -> Piece:
    # A minus before a sum's term reads as part of the sum, so it binds like one.
    return Piece(f"-{_in(a, TERM)}", SUM)


def _where(condition: Piece, a: Piece, b: Piece) -> Piece:
    rows = rf"{a.text} & \text{{if }} {condition.text} \\ {b.text} & \text{{otherwise}}"
    return Piece(rf"\begin{{cases}} {rows} \end{{cases}}", LOOSEST)


def _product(a: Piece, b: Piece) -> Piece:
    left, right = _in(a, TERM), _in(b, TERM + 1)
    dot = r" \cdot " if re.match(r"[-\d]", right) else r" \, "
    return Piece(left + dot + right, TERM)


def _in(part: Piece, least: int) -> str:
    return part.text if part.level >= least else rf"\left({part.text}\right)"


SHAPES: dict[str, Callable[..., Piece]] = {
    "mul": _product,
    "div": lambda a, b: Piece(rf"\frac{{{a.text}}}{{{b.text}}}", POWER),
    "pow": lambda a, b: Piece(f"{_in(a, ATOM)}^{{{b.text}}}", POWER),
    "exp": lambda a: Piece(f"e^{{{a.text}}}", POWER),
    "neg": _negative,
    "not": lambda a: Piece(rf"\lnot {_in(a, COMPARISON + 1)}", NOT),
    "where": _where,
}
"""Operations that mathematics writes in a form of their own."""
