"""The values of one driven state at all nodes of a grid, written as nested lists of numbers."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, TypeAlias, final

from pydantic import PlainValidator, WithJsonSchema

from spec_schema.mistake import Mistake, refuse
from spec_schema.wording import described, number

_MOST_AXES = 8


@final
@dataclass(frozen=True, slots=True)
class GridValues:
    """The numbers at all nodes, the last axis fastest; `shape` has one count for each axis."""

    shape: tuple[int, ...]
    numbers: tuple[float, ...]


def _grid_values(value: object) -> GridValues:
    shape = _shape_of(value)
    refuse(_mistakes(value, shape, ()))
    return GridValues(shape, tuple(_numbers(value)))


def _shape_of(value: object) -> tuple[int, ...]:
    """How many items there are at each level, by the first item of each."""
    shape: list[int] = []
    while isinstance(value, list) and value and len(shape) < _MOST_AXES:
        shape.append(len(value))
        value = value[0]
    return tuple(shape)


def _mistakes(value: object, shape: tuple[int, ...], at: tuple[int, ...]) -> Iterator[Mistake]:
    """Where the value differs from nested lists of finite numbers of this shape."""
    if shape and isinstance(value, list):
        if len(value) != shape[0]:
            message = f"this list has {len(value)} items, the first one of its level {shape[0]}"
            yield Mistake("S115", message, "a grid is rectangular", at)
            return
        for index, item in enumerate(value):
            yield from _mistakes(item, shape[1:], (*at, index))
    elif shape or not at or isinstance(value, bool) or not isinstance(value, int | float):
        wanted = "a list" if shape else "a number" if at else "nested lists of numbers"
        got = "an empty list" if value == [] else described(value)
        remedy = "a grid is rectangular" if shape else ""
        yield Mistake("S103", f"expected {wanted}, got {got}", remedy, at)
    elif not math.isfinite(value):
        yield Mistake("S107", f"{number(value)} is no rate", "write a finite number", at)


def _numbers(value: object) -> Iterator[float]:
    if isinstance(value, list):
        for item in value:
            yield from _numbers(item)
    elif isinstance(value, int | float):
        yield float(value)


Nested: TypeAlias = Annotated[
    GridValues, PlainValidator(_grid_values), WithJsonSchema({"type": "array", "minItems": 1})
]
"""Nested lists of numbers, one level for each axis."""
