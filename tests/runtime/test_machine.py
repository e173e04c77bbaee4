"""The machine against Python's and numpy's own arithmetic, bit for bit where both are exact."""

import math
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from runtime.arrays import Array
from runtime.code import ARITY, Code
from runtime.kernels.tape import LANES
from runtime.machine import evaluate
from runtime.tape import OPERATIONS

NAMES = ("x", "y", "z")
ODD = np.array([0.0, -0.0, 1.0, -1.0, 2.5, -3.75, np.inf, -np.inf, np.nan, 1e300, 5e-324, math.pi])
TRIPLES = np.stack(np.meshgrid(ODD, ODD, ODD, indexing="ij"), axis=-1).reshape(-1, 3)


def python_mod(x: Array, y: Array) -> Array:
    pairs = zip(x, y, strict=True)
    return np.array([math.nan if b == 0 or abs(a) == math.inf else a % b for a, b in pairs])


def wrapped(x: Array) -> Array:
    """By IEEE's remainder, which is exact, and the edge moved to pi."""
    rest = np.array([math.remainder(v, math.tau) if math.isfinite(v) else math.nan for v in x])
    return np.where(rest <= -math.pi, rest + math.tau, rest)


REFERENCE = {
    "add": lambda x, y, _: x + y,
    "sub": lambda x, y, _: x - y,
    "mul": lambda x, y, _: x * y,
    "div": lambda x, y, _: x / y,
    "mod": lambda x, y, _: python_mod(x, y),
    "pow": lambda x, y, _: np.power(x, y),
    "neg": lambda x, _y, _z: -x,
    "lt": lambda x, y, _: x < y,
    "le": lambda x, y, _: x <= y,
    "gt": lambda x, y, _: x > y,
    "ge": lambda x, y, _: x >= y,
    "eq": lambda x, y, _: x == y,
    "ne": lambda x, y, _: x != y,
    "and": lambda x, y, _: (x != 0) & (y != 0),
    "or": lambda x, y, _: (x != 0) | (y != 0),
    "not": lambda x, _y, _z: x == 0,
    "where": lambda x, y, z: np.where(x != 0, y, z),
    "abs": lambda x, _y, _z: np.abs(x),
    "sign": lambda x, _y, _z: np.sign(x),
    "min": lambda x, y, _: np.minimum(x, y),
    "max": lambda x, y, _: np.maximum(x, y),
    "clip": lambda x, y, z: np.minimum(np.maximum(x, y), z),
    "sqrt": lambda x, _y, _z: np.sqrt(x),
    "hypot": lambda x, y, _: np.hypot(x, y),
    "exp": lambda x, _y, _z: np.exp(x),
    "log": lambda x, _y, _z: np.log(x),
    "sin": lambda x, _y, _z: np.sin(x),
    "cos": lambda x, _y, _z: np.cos(x),
    "tan": lambda x, _y, _z: np.tan(x),
    "asin": lambda x, _y, _z: np.arcsin(x),
    "acos": lambda x, _y, _z: np.arccos(x),
    "atan": lambda x, _y, _z: np.arctan(x),
    "atan2": lambda x, y, _: np.arctan2(x, y),
    "sinh": lambda x, _y, _z: np.sinh(x),
    "cosh": lambda x, _y, _z: np.cosh(x),
    "tanh": lambda x, _y, _z: np.tanh(x),
    "floor": lambda x, _y, _z: np.floor(x),
    "wrap": lambda x, _y, _z: wrapped(x),
}
ROUNDED = {"pow", "hypot", "exp", "log", "sin", "cos", "tan", "asin", "acos", "atan", "atan2"}
ROUNDED |= {"sinh", "cosh", "tanh"}
"""Libraries may differ in the last bits of these."""


def code_of(operation: str) -> Code:
    return Code(" ".join([*NAMES[: ARITY[operation]], operation]))


def test_every_operation_has_its_own_number_and_a_reference() -> None:
    assert set(REFERENCE) == set(ARITY) == set(OPERATIONS)
    assert len(set(OPERATIONS.values())) == len(ARITY)


@pytest.mark.parametrize("operation", ARITY)
def test_an_operation_does_what_ieee_and_python_say(operation: str) -> None:
    x, y, z = TRIPLES.T
    with np.errstate(all="ignore"):
        expected = REFERENCE[operation](x, y, z).astype(np.float64)

    found = evaluate([code_of(operation)], NAMES, TRIPLES)[:, 0]

    same = (found == expected) | (np.isnan(found) & np.isnan(expected))
    if operation in ROUNDED:
        with np.errstate(all="ignore"):
            same |= np.abs(found - expected) <= 4e-16 * np.abs(expected)
    assert same.all(), (TRIPLES[~same][:5], found[~same][:5], expected[~same][:5])


@given(st.floats(-1e6, 1e6), st.floats(-1e3, 1e3))
def test_mod_and_wrap_agree_with_python(x: float, y: float) -> None:
    found = evaluate([Code("x y mod"), Code("x wrap")], ("x", "y"), np.array([x, y]))

    assert np.array_equal(found[0], python_mod(np.array([x]), np.array([y]))[0], equal_nan=True)
    assert found[1] == wrapped(np.array([x]))[0]
    assert -math.pi < found[1] <= math.pi


@pytest.mark.parametrize("exponent", [1, 2, 3, 4])
def test_small_powers_are_products(exponent: int) -> None:
    x = np.random.default_rng(3).uniform(-3, 3, 500)
    found = evaluate([Code(f"x {exponent} pow")], ("x",), x[:, np.newaxis])[:, 0]

    # Two roundings of a product, against one of a correctly rounded power.
    np.testing.assert_allclose(found, x**exponent, rtol=5e-16)


EXPRESSIONS = st.recursive(
    st.sampled_from(["x", "y", "z", "1", "2.5", "-0.5", "0.0"]),
    lambda inner: st.sampled_from(sorted(set(ARITY) - {"pow"})).flatmap(
        lambda op: st.tuples(*[inner] * ARITY[op]).map(lambda parts: " ".join([*parts, op]))
    ),
    max_leaves=25,
)


def plain_value(text: str, point: Array) -> float:
    """A stack machine in a few lines: the second implementation."""
    stack: list[Array] = []
    for token in text.split(" "):
        if token in ARITY:
            operands = stack[len(stack) - ARITY[token] :]
            del stack[len(stack) - ARITY[token] :]
            padded = [*operands, *[np.zeros(1)] * (3 - len(operands))]
            stack.append(REFERENCE[token](*padded).astype(np.float64))
        elif token in NAMES:
            stack.append(point[NAMES.index(token), np.newaxis])
        else:
            stack.append(np.array([float(token)]))
    return float(stack[0][0])


@settings(deadline=None)
@given(EXPRESSIONS, st.lists(st.floats(-4, 4), min_size=3, max_size=3))
def test_code_means_what_a_plain_stack_machine_says(text: str, values: list[float]) -> None:
    exact = not any(token in ROUNDED for token in text.split(" "))
    with np.errstate(all="ignore"):
        expected = plain_value(text, np.array(values))

    found = evaluate([Code(text)], NAMES, np.array(values))[0]

    if exact:
        assert np.array_equal(found, expected, equal_nan=True)


@settings(deadline=None, max_examples=30)
@given(st.lists(EXPRESSIONS, min_size=1, max_size=6))
def test_codes_evaluated_together_are_those_evaluated_alone(texts: list[str]) -> None:
    codes = [Code(text) for text in texts]
    together = evaluate(codes, NAMES, TRIPLES[:100])
    alone = [evaluate([code], NAMES, TRIPLES[:100])[:, 0] for code in codes]

    np.testing.assert_array_equal(together, np.stack(alone, axis=-1))


HARD = [Code("x sin y exp mul z tanh sub"), Code("x y hypot z atan2"), Code("x y mul z div")]


@pytest.mark.parametrize("size", [1, 7, LANES - 1, LANES, LANES + 1, 3 * LANES + 5])
def test_a_point_gives_the_same_bits_whatever_the_batch(size: int) -> None:
    points = np.random.default_rng(1).normal(size=(size, 3))

    batch = evaluate(HARD, NAMES, points)
    backwards = evaluate(HARD, NAMES, points[::-1])[::-1]
    single = np.stack([evaluate(HARD, NAMES, point) for point in points])

    assert batch.tobytes() == single.tobytes() == np.ascontiguousarray(backwards).tobytes()


def test_threads_do_not_change_the_numbers() -> None:
    points = np.random.default_rng(2).normal(size=(5000, 3))
    with ThreadPoolExecutor(4) as pool:
        parts = list(pool.map(lambda part: evaluate(HARD, NAMES, part), np.split(points, 20)))

    assert np.concatenate(parts).tobytes() == evaluate(HARD, NAMES, points).tobytes()


def test_leading_axes_are_kept() -> None:
    register = np.random.default_rng(0).normal(size=(2, 3, 4, 3))

    assert evaluate(HARD, NAMES, register).shape == (2, 3, 4, 3)
    assert evaluate([], NAMES, register).shape == (2, 3, 4, 0)
    assert evaluate(HARD, NAMES, register[:0]).shape == (0, 3, 4, 3)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("x w add", "'w'"),
        ("x add", "lacks an operand"),
        ("x y", "leaves 2 values"),
        ("", "''"),
        ("nan", "'nan'"),
        ("inf", "'inf'"),
        ("1_0", "'1_0'"),
        ("1e999", "'1e999'"),
        ("x  y add", "''"),
    ],
)
def test_code_that_cannot_run_is_refused_with_the_reason(text: str, reason: str) -> None:
    with pytest.raises(ValueError, match=reason):
        evaluate([Code(text)], NAMES, np.zeros(3))
