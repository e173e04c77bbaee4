"""Rules as CSV and JSON: what is read is what was written, to the last bit."""

import json
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lcs.faults import LearnerError
from lcs.inputs import Input
from lcs.rules.as_csv import as_csv, of_csv
from lcs.rules.as_json import as_record, of_record
from lcs.rules.names import Names
from lcs.rules.table import RuleTable
from tests.lcs.rules.tables import WALL, drawn_table, wall_rules

COLUMNS = (
    "action", "lower", "upper", "prediction", "weight", "right", "wrong", "low", "high",
)  # fmt: skip
TEXTS = st.text(st.characters(exclude_categories=("Cs", "Cc")), min_size=1, max_size=12).filter(
    lambda text: "[" not in text and text == text.strip()
)


def assert_equal(found: RuleTable, expected: RuleTable) -> None:
    assert found.actions == expected.actions
    for name in COLUMNS:
        left, right = getattr(found, name), getattr(expected, name)
        assert left.dtype == right.dtype
        np.testing.assert_array_equal(left, right)  # NaN is equal to NaN


def odd_table(seed: int) -> RuleTable:
    """Random rules with numbers that formats stumble over."""
    table = drawn_table(seed, rules=5, inputs=3, actions=4)
    odd = [np.inf, -np.inf, np.nan, 5e-324, 1.7976931348623157e308, -0.0, 0.1 + 0.2]
    chance = np.random.default_rng(seed)
    table.prediction[:] = chance.choice(odd, 5)
    table.lower[:, 1] = chance.choice(odd[:2] + odd[3:], 5)
    table.low[1], table.high[1] = -np.inf, np.inf
    return table


@given(
    seed=st.integers(0, 10_000),
    words=st.lists(TEXTS, min_size=10, max_size=10),
    low=st.none() | st.floats(allow_nan=False),
)
def test_what_was_written_is_read(seed: int, words: list[str], low: float | None) -> None:
    table = odd_table(seed)
    inputs = (
        Input(words[0], words[1], low=low),
        Input(words[2]),
        Input(words[3], values=(words[4], "b"), is_ordered=True),
    )
    names = Names(inputs, tuple(words[5:9]))

    record = json.loads(json.dumps(as_record(table, names), allow_nan=False))
    from_json, json_names = of_record(record)
    from_csv, csv_names = of_csv(as_csv(table, names))

    assert_equal(from_json, table)
    assert json_names == names
    assert_equal(from_csv, table)
    assert csv_names.actions == names.actions
    assert csv_names.inputs == tuple(Input(each.name, each.unit) for each in inputs)


def test_a_table_without_rules_is_written_and_read() -> None:
    table = drawn_table(0, rules=0)
    names = Names((Input("a"), Input("b")), ("go", "stop"))

    assert_equal(of_csv(as_csv(table, names))[0], table)
    assert_equal(of_record(as_record(table, names))[0], table)


def changed(path: list[Any], value: Any) -> dict[str, Any]:
    """The record of the wall follower's rules with one part changed; removed where it is None."""
    record: Any = json.loads(json.dumps(as_record(wall_rules(), WALL)))
    part = record
    for key in path[:-1]:
        part = part[key]
    if value is None:
        del part[path[-1]]
    else:
        part[path[-1]] = value
    return dict(record)


@pytest.mark.parametrize(
    ("path", "value", "said"),
    [
        (["version"], 2, "no 'specc.rules' of version 1"),
        (["inputs"], None, "'inputs' is missing"),
        (["rules"], {}, "'rules' has to be a list"),
        (["rules", 1, "weight"], None, r"'rules\[1\].weight' is missing"),
        (["rules", 1, "weight"], "much", r"'rules\[1\].weight' is unfit: 'much'"),
        (["rules", 2, "lower"], [0.0], r"'rules\[2\].lower' is unfit"),
        (["rules", 0, "action"], 4, r"'rules\[0\].action' is unfit: 4"),
        (["rules", 0, "right"], -1, r"'rules\[0\].right' is unfit: -1"),
    ],
)
def test_a_record_that_is_unfit_is_refused_with_its_place(
    path: list[Any], value: Any, said: str
) -> None:
    with pytest.raises(LearnerError, match=said):
        of_record(changed(path, value))


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda text: text[:0], "the first line"),
        (lambda text: text.replace("front [m] from", "front"), "titled 'NAME"),
        (lambda text: text.replace("range,", "rage,"), "line 2 begins with 'rage'"),
        (lambda text: text.replace("0.5", "half", 1), "line 7: 'half' is no number"),
        (lambda text: text.replace("rule,3", "rule,4"), "line 10: '4' is no action"),
        (lambda text: text + "rule,1\n", "line 11 has 2 values"),
    ],
)
def test_a_csv_that_is_unfit_is_refused_with_its_line(
    change: Callable[[str], str], said: str
) -> None:
    with pytest.raises(LearnerError, match=said):
        of_csv(change(as_csv(wall_rules(), WALL)))
