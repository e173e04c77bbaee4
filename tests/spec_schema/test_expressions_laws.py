"""Laws that hold for every expression, on random trees and random points."""

import math
import operator
import random
from fractions import Fraction
from itertools import pairwise, product

import pytest
import sympy
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from runtime.code import ARITY as MACHINE_ARITY
from spec_schema.expressions.bounds import bounds
from spec_schema.expressions.derivative import derivative
from spec_schema.expressions.evaluate import evaluate, operate
from spec_schema.expressions.parse import parse
from spec_schema.expressions.printers.postfix import to_postfix
from spec_schema.expressions.printers.text import to_text
from spec_schema.expressions.rewrite import names_in, simplify, substitute
from spec_schema.expressions.tree import ARITY, Apply, Expr, Name, Number, fold, walk
from spec_schema.faults import ExpressionError, Fault

NAMES = ("x", "y", "z")
PLAIN = ("add", "sub", "mul", "div", "neg", "pow", "sqrt", "exp", "log", "sin", "cos", "tan")
SMOOTH = (*PLAIN, "asin", "acos", "atan", "sinh", "cosh", "tanh")
CONTINUOUS = (*SMOOTH, "abs", "min", "max", "clip", "hypot")

LITERALS = st.one_of(
    st.integers(-5, 5).map(float),
    st.sampled_from([0.1, -0.5, 1.5, 2.5, 1e-3, 1e3, math.pi, -math.pi, 1e20, 3.3e-9]),
    st.floats(-10, 10),
)
TAME = st.sampled_from([-3.0, -2.0, -1.0, 0.0, 0.5, 1.0, 1.5, 2.0, 3.0])


def trees(
    ops: tuple[str, ...] = tuple(ARITY),
    literals: st.SearchStrategy[float] = LITERALS,
    leaves: int = 12,
) -> st.SearchStrategy[Expr]:
    """Random trees as `parse` could make them: no literal under `neg`."""
    leaf = st.one_of(st.sampled_from(NAMES).map(Name), literals.map(Number))

    def applied(parts: st.SearchStrategy[Expr]) -> st.SearchStrategy[Expr]:
        return st.sampled_from(ops).flatmap(
            lambda op: st.tuples(*[parts] * ARITY[op]).map(lambda operands: _apply(op, operands))
        )

    # An operation at the root: most of what `recursive` draws is a leaf.
    return applied(st.recursive(leaf, applied, max_leaves=leaves))


def _apply(op: str, operands: tuple[Expr, ...]) -> Expr:
    if op == "neg" and isinstance(operands[0], Number):
        return Number(-operands[0].value)
    return Apply(op, operands)


def same_number(a: float, b: float) -> bool:
    return a == b or (math.isnan(a) and math.isnan(b))


def test_the_operations_are_those_of_the_machine() -> None:
    assert ARITY == MACHINE_ARITY


@given(trees())
def test_text_reads_back_as_the_same_tree(expr: Expr) -> None:
    assert parse(to_text(expr)) == expr
    assert hash(parse(to_text(expr))) == hash(expr)


def test_text_reads_back_for_each_operation_inside_each_other() -> None:
    for outer, inner in product(ARITY, repeat=2):
        parts: list[Expr] = [Name(name) for name in "abc"]
        for place in range(ARITY[outer]):
            operands = list(parts)
            operands[place] = Apply(inner, tuple(parts[: ARITY[inner]]))
            expr = Apply(outer, tuple(operands[: ARITY[outer]]))
            assert parse(to_text(expr)) == expr, to_text(expr)


@given(trees())
def test_text_holds_no_brackets_that_could_go(expr: Expr) -> None:
    text = to_text(expr)
    pairs: list[tuple[int, int]] = []
    opened: list[int] = []
    for at, character in enumerate(text):
        if character == "(":
            opened.append(at)
        elif character == ")":
            pairs.append((opened.pop(), at))
    for start, end in pairs:
        if text[:start][-1:].isalnum() and not text[:start].endswith((" and", " or", "not")):
            continue  # a call's
        if text[start - 1 : start + 2] == "-(-":
            continue  # clearer than two signs in a row
        without = f"{text[:start]} {text[start + 1 : end]} {text[end + 1 :]}"
        try:
            assert parse(without) != expr
        except ExpressionError:
            continue


@given(trees(), st.tuples(*[st.floats(-4, 4)] * 3))
def test_postfix_gives_the_value_on_a_stack(expr: Expr, point: tuple[float, ...]) -> None:
    values = dict(zip(NAMES, point, strict=True))
    stack: list[float] = []
    for token in to_postfix(expr).split(" "):
        if token in ARITY:
            operands = stack[-ARITY[token] :]
            del stack[-ARITY[token] :]
            stack.append(operate(token, *operands))
        else:
            stack.append(values[token] if token in values else float(token))

    assert len(stack) == 1
    assert same_number(stack[0], evaluate(expr, values))


@settings(max_examples=300)
@given(trees(), st.integers(0, 2**32))
def test_sampled_values_lie_in_the_bounds(expr: Expr, seed: int) -> None:
    rng = random.Random(seed)  # noqa: S311  # not a secret
    box = {}
    for name in NAMES:
        reach = rng.choice([1.0, 4.0, 50.0, 1e9])
        ends = (rng.uniform(-reach, reach), rng.choice([0.0, 1.0, rng.uniform(-reach, reach)]))
        box[name] = (min(ends), max(ends))
    low, high = bounds(expr, box)
    for _ in range(12):
        point = {name: rng.choice([a, b, rng.uniform(a, b)]) for name, (a, b) in box.items()}
        value = evaluate(expr, point)
        assert math.isnan(value) or low <= value <= high


@given(trees(("add", "sub", "mul"), TAME), st.tuples(*[st.floats(-4, 4)] * 3))
def test_exact_values_lie_in_the_bounds_of_their_point(
    expr: Expr, point: tuple[float, ...]
) -> None:
    """Without a rounding error that the bounds do not know of."""
    values = {name: Fraction(at) for name, at in zip(NAMES, point, strict=True)}
    exact = {"add": operator.add, "sub": operator.sub, "mul": operator.mul}

    def visit(node: Expr, operands: tuple[Fraction, ...]) -> Fraction:
        if isinstance(node, Apply):
            return exact[node.op](*operands)
        return values[node.name] if isinstance(node, Name) else Fraction(evaluate(node, {}))

    low, high = bounds(expr, {name: (at, at) for name, at in zip(NAMES, point, strict=True)})
    assert Fraction(low) <= fold(expr, visit) <= Fraction(high)


STEADY = ("add", "sub", "mul", "neg", "abs", "min", "max", "clip", "sin", "cos", "atan", "tanh")


@given(trees(STEADY, TAME))
def test_bounds_of_a_point_are_the_point_to_rounding(expr: Expr) -> None:
    point = {"x": 0.7, "y": -1.3, "z": 2.1}
    low, high = bounds(expr, {name: (at, at) for name, at in point.items()})
    # Each operation adds a few units in the last place of the largest part, and magnifies less.
    size = max(map(abs, intermediate(expr, point)))
    assert high - low < 1e-9 * (1 + size) ** 3
    assert low <= evaluate(expr, point) <= high


def intermediate(expr: Expr, point: dict[str, float]) -> list[float]:
    """The values of all parts."""
    found: list[float] = []

    def visit(node: Expr, operands: tuple[float, ...]) -> float:
        value = operate(node.op, *operands) if isinstance(node, Apply) else evaluate(node, point)
        found.append(value)
        return value

    fold(expr, visit)
    return found


@given(trees())
def test_simplifying_twice_is_simplifying_once(expr: Expr) -> None:
    once = simplify(expr)
    assert simplify(once) == once


@given(trees(CONTINUOUS, TAME), st.tuples(*[st.floats(0.1, 3)] * 3))
def test_simplifying_keeps_the_value(expr: Expr, point: tuple[float, ...]) -> None:
    values = dict(zip(NAMES, point, strict=True))
    simpler = simplify(expr)
    parts = [*intermediate(expr, values), *intermediate(simpler, values)]
    assume(all(part == 0 or 1e-5 < abs(part) < 1e5 for part in parts))

    # Re-ordered products differ by some 1e-16 relative; a part may amplify it by 1e5.
    assert evaluate(simpler, values) == pytest.approx(evaluate(expr, values), rel=1e-6, abs=1e-6)


PAIRED = ("add", "sub", "mul", "div", "pow", "min", "max")


def test_simplifying_keeps_the_value_of_each_pair_of_operations() -> None:
    values = {"x": 1.7, "y": 0.6}
    x, y, numbers = Name("x"), Name("y"), [Number(n) for n in (0.0, 1.0, -1.0, 2.0, -3.0)]
    inner = [
        Apply(op, pair)
        for op in PAIRED[:5]
        for pair in ((x, y), (numbers[3], x), (x, numbers[3]), (x, numbers[4]))
    ]
    parts = [x, *numbers, *inner, Apply("neg", (x,)), Apply("abs", (x,))]
    pairs = [Apply(op, pair) for op in PAIRED for pair in product(parts, repeat=2)]
    for expr in [*pairs, *(Apply(op, (part,)) for op in ("neg", "abs") for part in pairs)]:
        value, simpler = evaluate(expr, values), simplify(expr)
        assert simplify(simpler) == simpler, to_text(expr)
        if math.isfinite(value):
            found = evaluate(simpler, values)
            assert math.isclose(found, value, rel_tol=1e-12, abs_tol=1e-12), to_text(expr)


@given(trees())
def test_simplifying_adds_no_operation_and_no_name(expr: Expr) -> None:
    simpler = simplify(expr)
    assert names_in(simpler) <= names_in(expr)
    assert len(list(walk(simpler))) <= len(list(walk(expr)))


@given(trees(SMOOTH, TAME, leaves=6), st.tuples(*[st.floats(0.1, 2)] * 3))
@settings(max_examples=60, deadline=None)
def test_sympy_finds_the_same_derivative(expr: Expr, point: tuple[float, ...]) -> None:
    values = dict(zip(NAMES, point, strict=True))
    ours = derivative(expr, "x")
    parts = [*intermediate(expr, values), *intermediate(ours, values)]
    assume(all(part == 0 or 1e-4 < abs(part) < 1e4 for part in parts))
    judge = sympy.diff(as_sympy(expr), sympy.Symbol("x", real=True))
    theirs = complex(judge.subs({symbol(n): at for n, at in values.items()}).evalf(30))

    assert evaluate(ours, values) == pytest.approx(theirs.real, rel=1e-6, abs=1e-6)


def symbol(name: str) -> sympy.Symbol:
    return sympy.Symbol(name, real=True)


def as_sympy(expr: Expr) -> sympy.Expr:
    """The expression in sympy, by sympy's own meaning of each operation."""
    functions = {
        "add": lambda a, b: a + b,
        "sub": lambda a, b: a - b,
        "mul": lambda a, b: a * b,
        "div": lambda a, b: a / b,
        "neg": lambda a: -a,
        "pow": sympy.Pow,
    }

    def visit(node: Expr, operands: tuple[sympy.Expr, ...]) -> sympy.Expr:
        if isinstance(node, Number):
            return sympy.Rational(node.value)
        if isinstance(node, Name):
            return symbol(node.name)
        assert isinstance(node, Apply)
        function = functions.get(node.op) or getattr(sympy, node.op)
        return function(*operands)

    return fold(expr, visit)


@given(trees(CONTINUOUS, TAME, leaves=8), st.tuples(*[st.floats(0.1, 2)] * 3))
def test_differences_agree_with_the_derivative(expr: Expr, point: tuple[float, ...]) -> None:
    step = 1e-5
    values = dict(zip(NAMES, point, strict=True))
    ours = derivative(expr, "x")
    beside = [{**values, "x": values["x"] + k * step} for k in (-2, -1, 0, 1, 2)]
    rates = [evaluate(ours, at) for at in beside]
    parts = [p for at in beside for p in (*intermediate(expr, at), *intermediate(ours, at))]
    assume(all(part == 0 or 1e-3 < abs(part) < 1e3 for part in parts))
    assume(all(abs(b - a) < 1e-2 for a, b in pairwise(rates)))  # no corner, no wild bend near

    slope = (evaluate(expr, beside[3]) - evaluate(expr, beside[1])) / (2 * step)
    assert slope == pytest.approx(rates[2], rel=1e-3, abs=1e-2)


@given(trees(leaves=6), trees(leaves=4), st.tuples(*[st.floats(-3, 3)] * 3))
def test_substituting_is_evaluating_in_two_steps(
    expr: Expr, inner: Expr, point: tuple[float, ...]
) -> None:
    values = dict(zip(NAMES, point, strict=True))
    in_two = evaluate(expr, {**values, "x": evaluate(inner, values)})
    assert same_number(evaluate(substitute(expr, {"x": inner}), values), in_two)


SCRAPS = st.sampled_from(
    (  # noqa: SIM905  # a hundred quotes less
        "x y theta sin min where pi and or not if else lambda in is True None 0 1 2.5 1e400 1e 0x "
        "07 1j + - * / % ** // ^ & | && || ! = == != < <= <> ~ @ ( ) [ ] { } , . : ; := ? # $ \\ "
        "' \" 'a' f'' b'' ≤ ² π √ \n \t \0 \ud800 \u2028 é"
    ).split(" ")
)
NOISE = st.one_of(*[st.lists(SCRAPS, max_size=12).map(glue.join) for glue in (" ", "")], st.text())


def read(text: str) -> Expr | tuple[Fault, ...]:
    try:
        return parse(text)
    except ExpressionError as error:
        return error.faults


@settings(max_examples=400)
@given(NOISE)
def test_no_text_breaks_the_parser_and_every_fault_has_a_place(text: str) -> None:
    found = read(text)
    if isinstance(found, tuple):
        assert found
        assert all(0 <= fault.start < fault.end <= max(1, len(text)) for fault in found)
        assert list(found) == sorted(found)
    else:
        assert parse(to_text(found)) == found
        leaves = [node for node in walk(found) if not isinstance(node, Apply)]
        assert all(0 <= leaf.start < leaf.end <= len(text) for leaf in leaves)
