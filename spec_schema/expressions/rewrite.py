"""What an expression reads, and the same expression with something else in a name's place."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Final

from spec_schema.expressions.algebra import build
from spec_schema.expressions.tree import Apply, Expr, Name, Number, Text, fold, same, walk
from spec_schema.faults import Fault
from spec_schema.suggest import did_you_mean, there_are

MOST_NAMED: Final = 8
"""Of more names none are listed in a help."""
TIMES: Final = frozenset({"t", "time"})
NO_CLOCK: Final = (
    "expressions can't read the time; give the behavior a clock of its own, such as a periodic "
    "state `phase` with a constant rate, or a control that the log tells"
)


def names_in(expr: Expr) -> frozenset[str]:
    """Every name that the expression reads."""
    return frozenset(node.name for node in walk(expr) if isinstance(node, Name))


def unknown_names(expr: Expr, known: Iterable[str]) -> list[Fault]:
    """A fault for each place where a name stands that is not `known`."""
    names = sorted(known)
    found = {
        Fault(node.start, node.end, "S139", _unknown(node.name), _meant(node.name, names))
        for node in walk(expr)
        if isinstance(node, Name) and node.name not in names
    }
    return sorted(found)


def _unknown(name: str) -> str:
    return f"nothing is named '{name if len(name) <= 40 else name[:37] + '...'}'"


def _meant(name: str, known: Sequence[str]) -> str:
    if name in TIMES and name not in known:
        return NO_CLOCK
    meant = did_you_mean(name, known)
    if meant or len(known) > MOST_NAMED:
        return meant
    return there_are(known) if known else "write a number"


def substitute(expr: Expr, mapping: Mapping[str, Expr]) -> Expr:
    """The expression with `mapping[name]` in the place of each such name, all at once."""

    def replaced(node: Expr, operands: tuple[Expr, ...]) -> Expr:
        match node:
            case Name(name=name):
                return mapping.get(name, node)
            case Apply():
                return rebuilt(node, operands)
        return node

    return fold(expr, replaced)


def rebuilt(node: Apply, operands: tuple[Expr, ...]) -> Expr:
    """The operation with other operands; a negated literal stays one literal."""
    if all(new is old for new, old in zip(operands, node.operands, strict=True)):
        return node
    if node.op == "neg" and isinstance(operands[0], Number):
        return Number(-operands[0].value, node.start, node.end)
    return replace(node, operands=operands)


def resolve_texts(expr: Expr, values: Mapping[str, Sequence[str]]) -> tuple[Expr, list[Fault]]:
    """The expression with each text replaced by its index among the `values` of its variable."""
    faults: list[Fault] = []

    def resolved(node: Expr, operands: tuple[Expr, ...]) -> Expr:
        if not isinstance(node, Apply):
            return node
        names = [part.name for part in operands if isinstance(part, Name)]
        texts = [part for part in operands if isinstance(part, Text)]
        if not names or not texts:
            return rebuilt(node, operands)
        number = _index(texts[0], names[0], values, faults)
        return rebuilt(node, tuple(number if part is texts[0] else part for part in operands))

    return fold(expr, resolved), sorted(set(faults))


def _index(
    text: Text, name: str, values: Mapping[str, Sequence[str]], faults: list[Fault]
) -> Number:
    known = values.get(name, ())
    if text.text in known:
        return Number(float(known.index(text.text)), text.start, text.end)
    if known:
        message = f"{name} has no value '{text.text[:40]}'"
        advice = did_you_mean(text.text, known) or f"it has {', '.join(known)}"
    else:
        message, advice = f"{name} is a number and has no values by name", ""
    faults.append(Fault(text.start, text.end, "S138", message, advice))
    return Number(0.0, text.start, text.end)


def simplify(expr: Expr) -> Expr:
    """The same values with fewer operations, by the laws of `algebra`; idempotent.

    Values agree to rounding wherever the expression is finite, and so are its parts. A part that
    changed has no place in the text any more.
    """

    def simplified(node: Expr, operands: tuple[Expr, ...]) -> Expr:
        if not isinstance(node, Apply):
            return node
        result = build(node.op, *operands)
        unchanged = isinstance(result, Apply) and result.op == node.op
        return node if unchanged and same(result, node) else result

    return fold(expr, simplified)
