"""Requirements of a scenario: sentences, their names and dimensions checked, as code."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Final, final

from compiler.findings import Findings
from compiler.guard_sign import signed
from compiler.lower_parts import code_of
from runtime.requirement import TIE, Formula, Operator, Requirement
from spec_schema.dimension import DIMENSIONLESS, Dimension, describe
from spec_schema.expressions.dimensions import dimension_of
from spec_schema.expressions.rewrite import names_in, resolve_texts, substitute
from spec_schema.expressions.tree import Apply, Expr, Name, Number, walk
from spec_schema.faults import Fault
from spec_schema.places import Path
from spec_schema.requirement_comparisons import quantified
from spec_schema.requirement_sentences import (
    Predicate,
    Sentence,
    is_quantity,
    names_of,
    predicates_of,
    read_requirement,
)
from spec_schema.requirement_words import RequirementError
from spec_schema.suggest import did_you_mean, did_you_mean_one_of
from spec_schema.units import Unit, parse_quantity
from spec_schema.wording import number

MOST_NAMED: Final = 6
"""How many quantities a help lists."""


@final
@dataclass(frozen=True, slots=True)
class Measured:
    """A quantity of a run: its dimension, the values of a discrete one, and its unit's name.

    is_periodic: it wraps, as an angle does.
    """

    dimension: Dimension
    values: tuple[str, ...] = ()
    is_discrete: bool = False
    unit: str = ""
    is_periodic: bool = False


def lower_requirement(
    text: str, path: Path, known: Mapping[str, Measured], findings: Findings
) -> Requirement | None:
    """What a run must satisfy; None, and findings, where the sentence can't be used."""
    try:
        sentence = read_requirement(text)
    except RequirementError as error:
        for fault in error.faults:
            findings.fault(path, fault)
        return None
    faults = _unknown(names_of(sentence), known)
    margins: dict[int, Expr] = {}
    dimensions: list[Dimension | None] = []
    for predicate in predicates_of(sentence):
        margin, dimension, more = _margin(predicate, known)
        faults += more
        dimensions.append(dimension)
        if margin is not None:
            margins[id(predicate)] = margin
    for fault in sorted(set(faults)):
        findings.fault(path, fault)
    if faults:
        return None
    unit = _shown_in(sentence, dimensions)
    quantities = dict.fromkeys(n for m in margins.values() for n in sorted(names_in(m)))
    formula = tuple(_postfix(sentence, margins))
    origin = findings.origin(path)
    return Requirement(text, formula, tuple(quantities), unit.text, unit.scale, origin)


def read_quantity(
    text: str, path: Path, known: Mapping[str, Measured], findings: Findings
) -> Expr | None:
    """An expression over a run, in SI; None, and findings, where it can't be used."""
    try:
        expr = quantified(text)
    except RequirementError as error:
        for fault in error.faults:
            findings.fault(path, fault)
        return None
    resolved, quantities, faults = _resolved(expr, known)
    named = [node for node in walk(expr) if isinstance(node, Name) and not is_quantity(node.name)]
    faults += _unknown(named, known)
    for fault in sorted(set(faults)):
        findings.fault(path, fault)
    return None if faults else substitute(resolved, quantities)


def _resolved(
    expr: Expr, known: Mapping[str, Measured]
) -> tuple[Expr, dict[str, Expr], list[Fault]]:
    """An expression with values by name as their index; its numbers with units in SI; its faults.

    Of what is not known nothing is told here.
    """
    names = {node.name for node in walk(expr) if isinstance(node, Name)}
    quantities = {name: parse_quantity(name) for name in names if is_quantity(name)}
    found = dimension_of(expr, _dimensions(names, known))[1]
    faults = [_in_its_unit(fault, expr, known) for fault in found]
    values = {name: known[name].values for name in names if name in known and known[name].values}
    resolved, more = resolve_texts(expr, values)
    if names <= {*known, *quantities}:
        faults += more  # the values of what is not known are not known either
    return resolved, {name: Number(one.value) for name, one in quantities.items()}, faults


def _dimensions(names: Iterable[str], known: Mapping[str, Measured]) -> dict[str, Dimension]:
    """The dimensions of quantities of a run and of numbers with units."""
    found = {name: known[name].dimension for name in names if name in known}
    return found | {
        name: parse_quantity(name).unit.dimension for name in names if is_quantity(name)
    }


def _unknown(names: Iterable[Name], known: Mapping[str, Measured]) -> list[Fault]:
    found = []
    for node in names:
        if node.name not in known:
            message = f"a run has no quantity '{node.name}'"
            found.append(Fault(node.start, node.end, "S371", message, _meant(node.name, known)))
    return found


def _meant(name: str, known: Mapping[str, Measured]) -> str:
    meant = did_you_mean(name, sorted(known))
    if meant:
        return meant
    ending = [other for other in known if other.endswith(f".{name.rpartition('.')[2]}")]
    if ending:
        return did_you_mean_one_of(ending[:MOST_NAMED])
    owner = name.partition(".")[0]
    beside = sorted(other for other in known if other.partition(".")[0] == owner) or sorted(known)
    more = ", ..." if len(beside) > MOST_NAMED else ""
    return f"there are {', '.join(beside[:MOST_NAMED])}{more}"


def _margin(
    predicate: Predicate, known: Mapping[str, Measured]
) -> tuple[Expr | None, Dimension | None, list[Fault]]:
    """Robustness of a comparison in SI: 0 or more where it holds; its dimension; its faults."""
    condition = predicate.condition
    names = {node.name for node in walk(condition) if isinstance(node, Name)}
    resolved, quantities, faults = _resolved(condition, known)
    discrete = {name for name in names if name in known and known[name].is_discrete}
    margin = signed(resolved, discrete)
    if margin is None:
        message = "two numbers are hardly ever equal"
        fault = Fault(predicate.start, predicate.end, "S374", message, "write `abs(a - b) < ...`")
        return None, None, [*faults, *([fault] if names <= {*known, *quantities} else [])]
    dimension = None if faults else dimension_of(margin, _dimensions(names, known))[0]
    sure = signed(resolved, discrete, TIE) or margin
    return substitute(sure, quantities), dimension, faults


def _in_its_unit(fault: Fault, condition: Expr, known: Mapping[str, Measured]) -> Fault:
    """The fault, with what to write where a number has no unit, or another than the quantity's."""
    for node in walk(condition):
        if not isinstance(node, Apply) or node.mark != (fault.start, fault.end):
            continue
        named = [o.name for o in node.operands if isinstance(o, Name) and o.name in known]
        units = [known[name].unit for name in named] or _units_of(node.operands, known)
        if len(units) != 1 or units[0] in {"", "1"}:
            continue
        for operand in node.operands:
            if isinstance(operand, Number):
                remedy = (
                    f"write `{number(operand.value)} {units[0]}`: a plain number has no unit here"
                )
                return replace(fault, help=remedy)
            if isinstance(operand, Name) and is_quantity(operand.name):
                owner = named[0] if named else "the other side"
                return replace(
                    fault, help=f"{owner} is in {units[0]}: write a number in {units[0]}"
                )
    return fault


def _units_of(operands: Iterable[Expr], known: Mapping[str, Measured]) -> list[str]:
    """The units of those that are made of several parts."""
    found = []
    for each in operands:
        if isinstance(each, Apply):
            names = {node.name for node in walk(each) if isinstance(node, Name)}
            dimension = dimension_of(each, _dimensions(names, known))[0]
            found += [] if dimension is None else [describe(dimension)]
    return found


def _shown_in(sentence: Sentence, dimensions: list[Dimension | None]) -> Unit:
    """The unit in which robustness is shown: as written, where all predicates have one."""
    first = dimensions[0]
    if first is None or any(dimension != first for dimension in dimensions):
        return Unit("", 1.0, DIMENSIONLESS)
    for predicate in predicates_of(sentence):
        for node in walk(predicate.condition):
            if isinstance(node, Name) and is_quantity(node.name):
                unit = parse_quantity(node.name).unit
                if unit.dimension == first:
                    return unit
    return Unit(describe(first), 1.0, first)


def _postfix(sentence: Sentence, margins: Mapping[int, Expr]) -> list[Formula]:
    if isinstance(sentence, Predicate):
        return [Formula(Operator.PREDICATE, code_of(margins[id(sentence)]), 0.0, None)]
    parts = [one for part in sentence.parts for one in _postfix(part, margins)]
    return [*parts, Formula(Operator(sentence.operator), None, sentence.first, sentence.last)]
