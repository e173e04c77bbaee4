"""Tables of rules that tests draw or write by hand."""

import numpy as np
import numpy.typing as npt

from lcs.arrays import Array
from lcs.inputs import Input
from lcs.rules.names import Names
from lcs.rules.table import RuleTable

LEVELS = np.array([-1000.0, 1000.0])

WALL = Names(
    (Input("front", "m"), Input("left", "m")),
    ("forward", "slight right", "sharp right", "slight left"),
)


def table_of(
    rules: list[tuple[int, list[float], list[float], float]], range_to: float
) -> RuleTable:
    """Rules (action, lower, upper, prediction) over inputs from 0 to `range_to`, never tried."""
    action, lower, upper, prediction = zip(*rules, strict=True)
    n, count = len(lower[0]), len(rules)
    return RuleTable(
        actions=max(action) + 1,
        action=np.array(action),
        lower=np.array(lower, np.float64),
        upper=np.array(upper, np.float64),
        prediction=np.array(prediction, np.float64),
        weight=np.ones(count),
        right=np.zeros(count, np.int64),
        wrong=np.zeros(count, np.int64),
        low=np.zeros(n),
        high=np.full(n, range_to),
    )


def drawn_table(
    seed: int, rules: int, inputs: int = 2, actions: int = 2, grid: int = 0
) -> RuleTable:
    """Random rules in [0, 1]^n; on a grid of so many steps, so that bounds and inputs meet."""
    chance = np.random.default_rng(seed)
    ends = drawn_inputs(chance, 2 * rules, inputs, grid).reshape(rules, 2, inputs)
    lower, upper = ends.min(axis=1), ends.max(axis=1)
    return RuleTable(
        actions=actions,
        action=chance.integers(actions, size=rules),
        lower=lower,
        upper=np.where(upper > lower, upper, 1.0),
        prediction=LEVELS[chance.integers(2, size=rules)],
        weight=chance.random(rules) + 0.01,
        right=chance.integers(100, size=rules),
        wrong=chance.integers(100, size=rules),
        low=np.zeros(inputs),
        high=np.ones(inputs),
    )


def drawn_inputs(chance: np.random.Generator, count: int, inputs: int, grid: int) -> Array:
    """Inputs in [0, 1]^n, on a grid or not."""
    x = chance.random((count, inputs))
    return np.round(x * grid) / grid if grid else x


def holds(table: RuleTable, rule: int, x: npt.ArrayLike) -> bool:
    """Whether a rule holds on x (n,), as the table's docstring says it."""
    bounds = zip(table.lower[rule], np.asarray(x), table.upper[rule], table.high, strict=True)
    return all(low <= at and (at < up or at == up == end) for low, at, up, end in bounds)


def wall_rules() -> RuleTable:
    """What the SCITOS-G5's arbiter did, by hand: three thresholds, 0.9, 0.9 and 0.5."""
    beyond = float(np.nextafter(0.9, 1.0))
    return table_of(
        [
            (0, [beyond, 0.5], [5.0, beyond], 1000.0),
            (1, [beyond, 0.0], [5.0, 0.5], 1000.0),
            (2, [0.0, 0.0], [beyond, 5.0], 1000.0),
            (3, [beyond, beyond], [5.0, 5.0], 1000.0),
        ],
        range_to=5.0,
    )
