"""Rules as a record for JSON, and back, bit for bit; `docs/rules.md` says what the keys mean."""

from collections.abc import Callable, Mapping
from typing import Any, Final, TypeVar

import numpy as np

from lcs.faults import LearnerError
from lcs.inputs import Input
from lcs.rules.names import Names, names_for
from lcs.rules.table import RuleTable
from lcs.rules.words import in_words

VERSION: Final = 1
SCHEMA: Final = "specc.rules"
NO_NUMBERS: Final = {"inf", "-inf", "nan"}
"""JSON has no such numbers, so they are texts."""

T = TypeVar("T")


def as_record(table: RuleTable, names: Names) -> dict[str, Any]:
    """A record that `json.dumps(..., allow_nan=False)` takes."""
    said = {each.rule: str(each) for each in in_words(table, names)}
    return {
        "schema": SCHEMA,
        "version": VERSION,
        "inputs": [
            {
                "name": each.name,
                "unit": each.unit,
                "declared": [_plain(each.low), _plain(each.high)],
                "values": list(each.values),
                "is_ordered": each.is_ordered,
                "known": [_plain(float(table.low[i])), _plain(float(table.high[i]))],
            }
            for i, each in enumerate(names.inputs)
        ],
        "actions": list(names.actions),
        "rules": [
            {
                "text": said[r],
                "action": int(table.action[r]),
                "lower": [_plain(value) for value in table.lower[r].tolist()],
                "upper": [_plain(value) for value in table.upper[r].tolist()],
                "prediction": _plain(float(table.prediction[r])),
                "weight": _plain(float(table.weight[r])),
                "right": int(table.right[r]),
                "wrong": int(table.wrong[r]),
            }
            for r in range(len(table))
        ],
    }


def of_record(record: Any) -> tuple[RuleTable, Names]:
    """The rules of a record that `as_record` made; "text" is not read.

    Raises:
        LearnerError: the record has another schema or version, or a part is missing or unfit; the
            message says which.
    """
    if _part(record, "schema", "") != SCHEMA or _part(record, "version", "") != VERSION:
        raise LearnerError(f"this is no '{SCHEMA}' of version {VERSION}")
    inputs = [_input(each, f"inputs[{i}].") for i, each in enumerate(_list(record, "inputs", ""))]
    known = [_pair(e, "known", f"inputs[{i}].") for i, e in enumerate(record["inputs"])]
    actions = [str(each) for each in _list(record, "actions", "")]
    rules = _list(record, "rules", "")
    n = len(inputs)

    def column(key: str, read: Callable[[Any], T]) -> list[T]:
        return [_read(rule, key, f"rules[{r}].", read) for r, rule in enumerate(rules)]

    def bounds(key: str) -> Any:
        return np.array(column(key, lambda row: _numbers(row, n)), np.float64).reshape(-1, n)

    table = RuleTable(
        actions=len(actions),
        action=np.array(column("action", lambda a: _index(a, len(actions))), np.int64),
        lower=bounds("lower"),
        upper=bounds("upper"),
        prediction=np.array(column("prediction", _number), np.float64),
        weight=np.array(column("weight", _number), np.float64),
        right=np.array(column("right", _count), np.int64),
        wrong=np.array(column("wrong", _count), np.int64),
        low=np.array([low for low, _ in known], np.float64),
        high=np.array([high for _, high in known], np.float64),
    )
    return table, names_for(table, inputs, actions)


def _input(record: Any, place: str) -> Input:
    low, high = _read(record, "declared", place, lambda pair: [_given(each) for each in pair])
    return Input(
        name=str(_part(record, "name", place)),
        unit=str(_part(record, "unit", place)),
        low=low,
        high=high,
        values=tuple(str(each) for each in _list(record, "values", place)),
        is_ordered=bool(_part(record, "is_ordered", place)),
    )


def _plain(value: float | None) -> float | str | None:
    """A number as JSON can hold it."""
    return value if value is None or np.isfinite(value) else str(value)


def _part(record: Any, key: str, place: str) -> Any:
    if not isinstance(record, Mapping) or key not in record:
        raise LearnerError(f"'{place}{key}' is missing from these rules")
    return record[key]


def _list(record: Any, key: str, place: str) -> list[Any]:
    found = _part(record, key, place)
    if not isinstance(found, list):
        raise LearnerError(f"'{place}{key}' has to be a list")
    return found


def _read(record: Any, key: str, place: str, read: Callable[[Any], T]) -> T:
    """A part of a record, read; with its place where it can't be."""
    part = _part(record, key, place)
    try:
        return read(part)
    except (TypeError, ValueError) as error:
        raise LearnerError(f"'{place}{key}' is unfit: {part!r}") from error


def _pair(record: Any, key: str, place: str) -> list[float]:
    return _read(record, key, place, lambda row: _numbers(row, 2))


def _numbers(row: Any, count: int) -> list[float]:
    if not isinstance(row, list) or len(row) != count:
        raise ValueError(count)
    return [_number(each) for each in row]


def _number(value: Any) -> float:
    if isinstance(value, bool) or not (isinstance(value, int | float) or value in NO_NUMBERS):
        raise TypeError(value)
    return float(value)


def _given(value: Any) -> float | None:
    return None if value is None else _number(value)


def _count(value: Any) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or value < 0:
        raise TypeError(value)
    return value


def _index(value: Any, count: int) -> int:
    if _count(value) >= count:
        raise ValueError(value)
    return int(value)
