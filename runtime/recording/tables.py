"""Columns of numbers as JSON objects: one message a row, in the user's own units."""

import json
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Booleans
from runtime.program import Unit
from runtime.recording.messages import Messages

BARE: Final = Unit("1", 1.0)


@final
@dataclass(frozen=True, slots=True)
class Field:
    """A column: what it is called, its unit, and the names of its values where it has such.

    is_flag: it is true or false.
    """

    name: str
    unit: Unit = BARE
    labels: tuple[str, ...] = ()
    about: str = ""
    is_flag: bool = False


def tell_rows(
    messages: Messages, topic: str, fields: Sequence[Field], times: Array, rows: Array | Booleans
) -> None:
    """A message for each of `times` (T,) with the row of `rows` (T, k); nothing for no fields."""
    if not fields:
        return
    channel = messages.json_topic(topic, {field.name: _property(field) for field in fields})
    texts = [_texts(field, rows[:, i]) for i, field in enumerate(fields)]
    for time, *cells in zip(times.tolist(), *texts, strict=True):
        messages.tell(channel, time, ("{" + ",".join(cells) + "}").encode())


def _texts(field: Field, column: Array | Booleans) -> list[str]:
    key = json.dumps(field.name) + ":"
    if field.is_flag:
        return [key + ("true" if value else "false") for value in column.tolist()]
    if field.labels:
        names = [json.dumps(label, ensure_ascii=False) for label in field.labels]
        whole = np.nan_to_num(column, nan=-1.0).astype(np.int64).tolist()
        return [key + (names[i] if 0 <= i < len(names) else "null") for i in whole]
    own = column / field.unit.scale
    finite = np.isfinite(own).tolist()
    return [
        key + (repr(value) if is_finite else "null")
        for value, is_finite in zip(own.tolist(), finite, strict=True)
    ]


def _property(field: Field) -> dict[str, object]:
    if field.is_flag:
        return {"type": "boolean", "description": field.about}
    if field.labels:
        return {"enum": [*field.labels, None], "description": field.about}
    about = [field.about] if field.about else []
    unit = [f"unit: {field.unit.text}"]
    return {"type": "number", "description": "; ".join([*about, *unit])}
