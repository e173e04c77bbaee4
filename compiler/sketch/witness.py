"""A setting of the controls at which a sketch goes wrong, as people are told of it."""

from collections.abc import Mapping, Sequence

from compiler.declare import Declarations
from spec_schema.expressions.rewrite import names_in
from spec_schema.expressions.tree import Expr


def controls_in(exprs: Sequence[Expr], declared: Declarations) -> tuple[str, ...]:
    """The controls that expressions read, in the order of their declaration."""
    found = {name for expr in exprs for name in names_in(expr)}
    return tuple(control.name for control in declared.controls if control.name in found)


def at_setting(exprs: Sequence[Expr], setting: Mapping[str, float], declared: Declarations) -> str:
    """` at r = 0 m`: the setting as far as expressions read it; empty where they read none."""
    units = declared.units
    pairs = [
        f"{name} = {setting[name] / units[name].scale:.4g}"
        + ("" if units[name].text == "1" else f" {units[name].text}")
        for name in controls_in(exprs, declared)
    ]
    return f" at {', '.join(pairs)}" if pairs else ""
