"""Wires: where a node of an architecture gets the value of a variable from."""

import re
from typing import Annotated, Literal, TypeAlias, final

from pydantic import BeforeValidator, Field

from spec_schema.value_types import Number, Quantity, StrictModel, Text

SOURCE = re.compile(r"[A-Za-z_]\w*(\.[A-Za-z_]\w*)+", re.ASCII)


@final
class Wire(StrictModel):
    """One wire: from a signal, or a value that does not change."""

    source: Text | None = Field(
        default=None,
        alias="from",
        description="The signal: `SENSOR.READING`, `NODE.OUTPUT`, or `ARBITER.CHOICE` for how "
        "strongly a choice holds.",
        examples=["left.range"],
    )
    value: Quantity | None = Field(
        default=None, description="A value that does not change.", examples=["0.2 m/s"]
    )
    scale: Number = Field(
        default=1.0, description="What the signal is multiplied with.", examples=[-1]
    )
    outside: Literal["clip", "inhibit"] | None = Field(
        default=None,
        description="What becomes of a signal that is outside the variable's domain: `clip` takes "
        "the domain's edge, `inhibit` keeps the node from acting. Without it, the signal's domain "
        "must lie within the variable's.",
        examples=["clip"],
    )


def _spelled_out(value: object) -> object:
    """A bare source or value as the mapping that it is short for."""
    if isinstance(value, str) and SOURCE.fullmatch(value.strip()):
        return {"from": value.strip()}
    if isinstance(value, str | int | float) and not isinstance(value, bool):
        return {"value": value}
    return value


WireSpec: TypeAlias = Annotated[
    Wire, BeforeValidator(_spelled_out, json_schema_input_type=Text | float | Wire)
]
"""A wire: a bare source, a bare value, or a mapping."""
