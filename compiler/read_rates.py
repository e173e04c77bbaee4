"""The rates of a field that is written as expressions: one for each driven state, in its unit."""

from collections.abc import Collection, Mapping

from compiler.declare import Declarations
from compiler.findings import Findings
from compiler.scope import Scope, checked, wanted_of
from runtime.program import Role
from spec_schema.expressions.rewrite import names_in
from spec_schema.expressions.tree import Expr
from spec_schema.places import Path


def read_rates(
    texts: Mapping[str, str],
    base: Path,
    declared: Declarations,
    scope: Scope,
    findings: Findings,
    *,
    is_map: bool = False,
) -> dict[str, Expr]:
    """The tree of each rate (of a map: next value) under `base` that can be read."""
    _match_names(texts, base, declared, findings)
    found: dict[str, Expr] = {}
    for name, text in texts.items():
        path = (*base, name)
        what = f"the {'next value' if is_map else 'rate'} of '{name}'"
        expr = checked(text, path, scope, wanted_of(name, declared, is_map=is_map), what, findings)
        if expr is not None:
            refuse_unsensed(expr, path, declared, findings)
            found[name] = expr
    return found


def refuse_unsensed(expr: Expr, path: Path, declared: Declarations, findings: Findings) -> None:
    """A finding for each name that the behavior drives but does not sense."""
    blind = {state.name for state in declared.states if state.role is Role.DRIVEN}
    for name in sorted(names_in(expr) & blind):
        findings.error(
            "S206",
            path,
            f"the field reads '{name}', which the behavior drives but does not sense",
            f"write `role: both` for '{name}' if it is sensed as well",
        )


def _match_names(
    given: Collection[str], path: Path, declared: Declarations, findings: Findings
) -> None:
    driven = [state.name for state in declared.driven]
    missing = [name for name in driven if name not in given]
    if missing:
        message = f"the field gives no rate for {_listed(missing)}"
        remedy = f"add `{missing[0]}: ...`, or write `role: sensed` for what it does not move"
        findings.error("S204", path, message, remedy, key=True)
    for name in given:
        if name not in driven:
            why, remedy = "is no state", f"the states: {_listed(driven)}"
            if name in declared.values:
                why, remedy = "is discrete, so it has no rate", "remove it"
            elif name in {state.name for state in declared.states}:
                why = "is only sensed, so the field gives no rate for it"
                remedy = "write `role: both` or a `closure`"
            findings.error("S205", (*path, name), f"'{name}' {why}", remedy, key=True)


def _listed(names: Collection[str]) -> str:
    return ", ".join(f"'{name}'" for name in names)
