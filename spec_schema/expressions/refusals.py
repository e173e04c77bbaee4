"""What the language does not have, in words: what it is called and what to write instead."""

import ast
from collections.abc import Callable

from spec_schema.expressions.tree import FUNCTIONS
from spec_schema.suggest import did_you_mean

LONGEST = 40
"""How many characters of a user's text a message repeats."""

UNLIKE: dict[type[ast.operator], tuple[str, str]] = {
    ast.BitXor: ("^", "write ** for a power"),
    ast.FloorDiv: ("//", "write floor(a / b)"),
    ast.BitAnd: ("&", "write and"),
    ast.BitOr: ("|", "write or"),
    ast.LShift: ("<<", "write *2**n"),
    ast.RShift: (">>", "write /2**n"),
    ast.MatMult: ("@", "write * for a product"),
}
"""Operators of Python that the language does not have."""

UNCOMPARED: dict[type[ast.cmpop], tuple[str, str]] = {
    ast.In: ("in", "write x == 'a' or x == 'b'"),
    ast.NotIn: ("not in", "write x != 'a' and x != 'b'"),
    ast.Is: ("is", "write =="),
    ast.IsNot: ("is not", "write !="),
}
"""Comparisons of Python that the language does not have."""

INSTEAD: dict[str, str] = {
    "ln": "log(x)",
    "log10": "log(x)/log(10)",
    "log2": "log(x)/log(2)",
    "log1p": "log(1 + x)",
    "expm1": "exp(x) - 1",
    "pow": "x**y",
    "power": "x**y",
    "square": "x**2",
    "cbrt": "sign(x)*abs(x)**(1/3)",
    "mod": "x % y",
    "fmod": "x % y",
    "ceil": "-floor(-x)",
    "round": "floor(x + 0.5)",
    "int": "floor(x)",
    "float": "the value itself",
    "fabs": "abs(x)",
    "sgn": "sign(x)",
    "signum": "sign(x)",
    "clamp": "clip(x, low, high)",
    "saturate": "clip(x, low, high)",
    "arcsin": "asin(x)",
    "arccos": "acos(x)",
    "arctan": "atan(x)",
    "arctan2": "atan2(y, x)",
    "minimum": "min(x, y)",
    "maximum": "max(x, y)",
    "norm": "hypot(x, y)",
    "radians": "x*pi/180",
    "deg2rad": "x*pi/180",
    "degrees": "x*180/pi",
    "rad2deg": "x*180/pi",
    "heaviside": "where(x > 0, 1, 0)",
    "step": "where(x > 0, 1, 0)",
    "ifelse": "where(c, a, b)",
    "piecewise": "where(c, a, b)",
    "cot": "1/tan(x)",
    "sec": "1/cos(x)",
    "csc": "1/sin(x)",
    "normalize_angle": "wrap(x)",
    "wrap_angle": "wrap(x)",
}
"""Functions of other languages and what to write for them."""

TRUTH: dict[str, str] = {"true": "1", "false": "0", "True": "1", "False": "0"}

NOUNS: dict[type[ast.AST], str] = {
    ast.Lambda: "a function (lambda)",
    ast.Dict: "a dictionary",
    ast.Set: "a set",
    ast.List: "a list",
    ast.Tuple: "a list of values",
    ast.ListComp: "a loop",
    ast.SetComp: "a loop",
    ast.DictComp: "a loop",
    ast.GeneratorExp: "a loop",
    ast.NamedExpr: "an assignment",
    ast.Await: "await",
    ast.Yield: "yield",
    ast.YieldFrom: "yield",
}


def refuse(node: ast.expr, source: Callable[[ast.expr], str]) -> tuple[str, str]:
    """Message and help for a node that the language does not have."""
    match node:
        case ast.Attribute(attr=attr):
            return f"'.{attr}' is not part of the language", "names have no dots"
        case ast.Subscript():
            return "'[...]' is not part of the language", "values have no parts; give each a name"
        case ast.IfExp(test=test, body=body, orelse=orelse):
            written = ", ".join(source(part) for part in (test, body, orelse))
            return "'if ... else' is not part of the language", f"write where({written})"
        case ast.Constant(value=value):
            return _refuse_constant(value)
    return f"{NOUNS.get(type(node), 'this')} is not part of the language", ""


def refuse_name(name: str) -> tuple[str, str] | None:
    """Message and help for a name that can't stand for a value; None if it can."""
    if name in FUNCTIONS:
        return f"'{name}' is a function and needs its arguments", f"write {name}(...)"
    if name in TRUTH:
        return f"'{name}' is not part of the language", f"write {TRUTH[name]}"
    return None


def refuse_call(called: str) -> tuple[str, str]:
    """Message and help for a call of what is not one of our functions."""
    bare = called.rpartition(".")[2]
    shown = called if len(called) <= LONGEST else f"{called[: LONGEST - 3]}..."
    if not bare.isidentifier():
        return f"'{shown}' is not a function", "write * for a product"
    return f"no function is named '{shown}'", _function_meant(bare)


def _function_meant(bare: str) -> str:
    if bare in FUNCTIONS:
        return f"write {bare}(...)"
    if bare in INSTEAD:
        return f"write {INSTEAD[bare]}"
    return did_you_mean(bare, sorted(FUNCTIONS)) or f"there are {', '.join(sorted(FUNCTIONS))}"


def _refuse_constant(value: object) -> tuple[str, str]:
    if str(value) in TRUTH:
        return f"'{value}' is not part of the language", f"write {TRUTH[str(value)]}"
    return f"'{value}' is not part of the language", ""
