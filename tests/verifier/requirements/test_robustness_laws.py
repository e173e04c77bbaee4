"""Robustness against its definition, and the laws of temporal logic."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from runtime.code import Code
from runtime.requirement import Formula, Operator, Requirement
from tests.verifier.requirements.robustness_by_definition import ByDefinition
from verifier.requirements.course import BEYOND
from verifier.requirements.robustness import robustness
from verifier.requirements.signals import Signal, Span

TEMPORAL = (Operator.ALWAYS, Operator.EVENTUALLY)
LOGIC = (Operator.AND, Operator.OR, Operator.IMPLIES)
LENGTH = 8


def predicate(code: str) -> Formula:
    """A predicate with that margin."""
    return Formula(Operator.PREDICATE, Code(code), 0.0, None)


def windowed(operator: Operator, first: float, last: float | None) -> Formula:
    """A temporal operator."""
    return Formula(operator, None, float(first), None if last is None else float(last))


def bounds(formula: tuple[Formula, ...], signals: dict[str, Signal], end: float) -> tuple:
    """The robustness at the beginning, with real infinities."""
    requirement = Requirement("", formula, tuple(signals), "", 1.0, "")
    part = robustness(requirement, signals, Span(0.0, end))
    found = (float(part.lower.after[0]), float(part.upper.after[0]))
    return tuple(math.copysign(math.inf, v) if abs(v) >= BEYOND else v for v in found)


@st.composite
def windows(draw: st.DrawFn) -> tuple[float, float | None]:
    """A window in whole seconds, or the rest of the run."""
    first = draw(st.integers(0, 2))
    last = draw(st.none() | st.integers(first, first + 4))
    return first, last


PREDICATES = st.sampled_from(["x", "y", "1 x sub", "y 2 sub"]).map(lambda code: (predicate(code),))


def formulas(operands: st.SearchStrategy) -> st.SearchStrategy:
    """Formulas one operator higher."""
    negated = operands.map(lambda f: (*f, Formula(Operator.NOT, None, 0.0, None)))
    both = st.tuples(operands, operands, st.sampled_from(LOGIC)).map(
        lambda p: (*p[0], *p[1], Formula(p[2], None, 0.0, None))
    )
    temporal = st.tuples(operands, st.sampled_from(TEMPORAL), windows()).map(
        lambda p: (*p[0], windowed(p[1], *p[2]))
    )
    until = st.tuples(operands, operands, windows()).map(
        lambda p: (*p[0], *p[1], windowed(Operator.UNTIL, *p[2]))
    )
    return negated | both | temporal | until


ONE_HIGH = formulas(PREDICATES)
TWO_HIGH = formulas(PREDICATES | ONE_HIGH)
FORMULAS = ONE_HIGH | TWO_HIGH | formulas(TWO_HIGH)
SAMPLES = st.lists(st.integers(-3, 3), min_size=LENGTH + 1, max_size=LENGTH + 1)


def sampled(x: list[int], y: list[int], *, is_held: bool) -> dict[str, Signal]:
    """Two quantities, one sample a second."""
    times = np.arange(LENGTH + 1.0)
    return {
        name: Signal(name, times, np.array(values, dtype=float), is_held=is_held)
        for name, values in (("x", x), ("y", y))
    }


def margin(code: str, x: float, y: float) -> float:
    """What the margins of PREDICATES are."""
    return {"x": x, "y": y, "1 x sub": 1 - x, "y 2 sub": y - 2}[code]


@settings(max_examples=100, deadline=None)
@given(FORMULAS, SAMPLES, SAMPLES)
def test_held_quantities_have_the_robustness_of_the_definition(
    formula: tuple[Formula, ...], x: list[int], y: list[int]
) -> None:
    def value(part: Formula, time: float) -> float:
        return margin(part.margin.text, x[int(time)], y[int(time)])

    by_definition = ByDefinition(formula, value, LENGTH, 0.5, 40.0)
    expected = by_definition.at(by_definition.root, 0.0)

    assert bounds(formula, sampled(x, y, is_held=True), LENGTH) == pytest.approx(expected)


@settings(max_examples=40, deadline=None)
@given(ONE_HIGH | TWO_HIGH, SAMPLES, SAMPLES)
def test_moving_quantities_come_as_close_to_the_definition_as_its_grid_is_fine(
    formula: tuple[Formula, ...], x: list[int], y: list[int]
) -> None:
    step = 1 / 8

    def value(part: Formula, time: float) -> float:
        seconds = range(LENGTH + 1)
        return margin(part.margin.text, np.interp(time, seconds, x), np.interp(time, seconds, y))

    by_definition = ByDefinition(formula, value, LENGTH, step, 40.0)
    expected = by_definition.at(by_definition.root, 0.0)
    steepest = max(np.abs(np.diff(x)).max(), np.abs(np.diff(y)).max())

    found = bounds(formula, sampled(x, y, is_held=False), LENGTH)

    assert found == pytest.approx(expected, abs=step * steepest + 1e-6)
