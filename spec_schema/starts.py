"""Where a robot starts: a place, or anywhere that is free."""

from dataclasses import replace
from typing import Annotated, Final, Literal, TypeAlias

from pydantic import PlainValidator, WithJsonSchema
from pydantic_core import PydanticCustomError

from spec_schema.mistake import Mistake, carried, refuse, refused
from spec_schema.value_types import as_quantity
from spec_schema.wording import described

REMEDY: Final = "write e.g. 'at: [1 m, 1 m, 90 deg]', or 'at: random'"


def _start(value: object) -> tuple[float | str, ...] | Literal["random"]:
    if value == "random":
        return "random"
    if not isinstance(value, list | tuple):
        raise refused("S103", f"expected a place or random, got {described(value)}", REMEDY)
    if len(value) not in {2, 3}:
        message = f"a place is [x, y] or [x, y, direction]: 2 or 3 values, not {len(value)}"
        raise refused("S262", message, REMEDY)
    mistakes: list[Mistake] = []
    found: list[float | str] = []
    for place, one in enumerate(value):
        try:
            found.append(as_quantity(one))
        except PydanticCustomError as error:
            told = carried(error.context or {})
            mistakes += [replace(mistake, at=(place, *mistake.at)) for mistake in told]
    refuse(mistakes)
    return tuple(found)


StartText: TypeAlias = Annotated[
    tuple[float | str, ...] | Literal["random"],
    PlainValidator(_start),
    WithJsonSchema(
        {
            "anyOf": [
                {
                    "items": {"type": ["number", "string"]},
                    "maxItems": 3,
                    "minItems": 2,
                    "type": "array",
                },
                {"const": "random", "type": "string"},
            ]
        }
    ),
]
"""x, y and perhaps a direction, plain numbers in metres and radians; or `random`."""
