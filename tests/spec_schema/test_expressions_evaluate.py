"""What each operation means: numpy and Python agree, also at the edges of doubles."""

import math
import operator
from collections.abc import Callable
from itertools import product

import numpy as np
import pytest

from spec_schema.expressions.evaluate import evaluate, operate
from spec_schema.expressions.parse import parse
from spec_schema.expressions.tree import ARITY

EDGES = (
    -math.inf,
    -1e300,
    -3.0,
    -2.0,
    -1.0,
    -0.5,
    0.0,
    0.3,
    1.0,
    2.0,
    2.5,
    700.0,
    math.inf,
    math.nan,
)

NUMPY: dict[str, Callable[..., object]] = {
    "add": np.add,
    "sub": np.subtract,
    "mul": np.multiply,
    "div": np.divide,
    "mod": np.mod,
    "pow": np.power,
    "neg": np.negative,
    "lt": operator.lt,
    "le": operator.le,
    "gt": operator.gt,
    "ge": operator.ge,
    "eq": operator.eq,
    "ne": operator.ne,
    "and": np.logical_and,
    "or": np.logical_or,
    "not": np.logical_not,
    "where": np.where,
    "clip": lambda x, low, high: np.minimum(np.maximum(x, low), high),
    "min": np.minimum,
    "max": np.maximum,
    "hypot": np.hypot,
    "atan2": np.arctan2,
    "abs": np.abs,
    "sign": np.sign,
    "sqrt": np.sqrt,
    "exp": np.exp,
    "log": np.log,
    "floor": np.floor,
    "sin": np.sin,
    "cos": np.cos,
    "tan": np.tan,
    "asin": np.arcsin,
    "acos": np.arccos,
    "atan": np.arctan,
    "sinh": np.sinh,
    "cosh": np.cosh,
    "tanh": np.tanh,
}


@pytest.mark.parametrize("op", [op for op in ARITY if op != "wrap"])
def test_numpy_gives_the_same_at_every_edge(op: str) -> None:
    for operands in product(EDGES, repeat=ARITY[op]):
        with np.errstate(all="ignore"):
            theirs = float(np.asarray(NUMPY[op](*map(np.float64, operands))).item())
        assert operate(op, *operands) == pytest.approx(theirs, rel=1e-14, nan_ok=True), operands


@pytest.mark.parametrize("turns", [-1000, -2, -1, 0, 1, 2, 1000])
@pytest.mark.parametrize("angle", [-3.0, -1.0, 0.0, 1e-9, 1.0, 3.0])
def test_wrap_takes_whole_turns_away(angle: float, turns: int) -> None:
    assert operate("wrap", angle + turns * math.tau) == pytest.approx(angle, abs=1e-12)


def test_wrap_maps_to_the_half_open_turn() -> None:
    assert operate("wrap", -math.pi) == math.pi
    assert operate("wrap", math.pi) == math.pi
    assert operate("wrap", math.nextafter(-math.pi, 0.0)) == math.nextafter(-math.pi, 0.0)
    assert operate("wrap", 1e-300) == 1e-300
    assert math.isnan(operate("wrap", math.inf))


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("-pi", -math.pi),
        ("2*pi/3", 2 * math.pi / 3),
        ("1/0", math.inf),
        ("where(1 > 0, 2, 3)", 2.0),
        ("where(0, 2, 3)", 3.0),
        ("1 < 2 < 3", 1.0),
        ("1 < 3 < 2", 0.0),
        ("not 0 and 2 or 0", 1.0),
        ("-7 % 3", 2.0),
        ("7 % -3", -2.0),
        ("clip(5, 0, 1)", 1.0),
        ("(-8)**(1/3)", math.nan),
        ("2**3**2", 512.0),
    ],
)
def test_a_constant_expression_has_this_value(text: str, value: float) -> None:
    assert evaluate(parse(text), {}) == pytest.approx(value, rel=1e-15, nan_ok=True)
