"""Where the variables of a behavior stand in a log: the spec's `trace:` block."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Self, TypeAlias, final

from pydantic import BeforeValidator, Field, WithJsonSchema, model_validator

from spec_schema.mistake import Mistake, refuse
from spec_schema.value_types import Number, Quantity, StrictModel, Text, UnitText
from spec_schema.wording import quoted


def _by_itself(value: object) -> object:
    """A list of texts as a mapping of each to itself."""
    if isinstance(value, list) and value and all(isinstance(item, str) for item in value):
        return dict.fromkeys(value) | {item: item for item in value}
    return value


def _spelled_out(value: object) -> object:
    """A bare path as the mapping that it is short for."""
    return {"path": value} if isinstance(value, str) else value


RawValues: TypeAlias = Annotated[
    Mapping[Text, Text],
    BeforeValidator(_by_itself),
    Field(min_length=1),
    WithJsonSchema(
        {
            "anyOf": [
                {"type": "object", "additionalProperties": {"type": "string"}, "minProperties": 1},
                {"type": "array", "items": {"type": "string"}, "minItems": 1},
            ]
        }
    ),
]
"""Which text in the log means which declared value; for a signal, the texts that it can have."""


@final
class TraceEntry(StrictModel):
    """Where one variable stands in a log: `value = scale * raw [unit] + offset`, `delay` ago."""

    path: Text | None = Field(
        default=None,
        description="Topic and field as Foxglove writes them, or the column of a CSV file.",
        examples=["/odom.twist.twist.linear.x"],
    )
    delay: Quantity = Field(
        default=0.0,
        description="How late the log speaks: what stands at time t was true at t - delay. A plain "
        "number in seconds.",
        examples=["0.1 s"],
    )
    scale: Number = Field(
        default=1.0, description="The factor from the logged number to the variable.", examples=[-1]
    )
    offset: Quantity = Field(
        default=0.0,
        description="What is added after scaling, a plain number in the variable's unit.",
        examples=["0.1 m"],
    )
    unit: UnitText | None = Field(
        default=None,
        description="The unit of the logged number; without it, the SI unit: m, m/s, rad.",
        examples=["deg"],
    )
    noise: Quantity | None = Field(
        default=None,
        description="The standard deviation of the sensor's noise, a plain number in the "
        "variable's unit; without it, it is estimated from the log.",
        examples=["0.01 m"],
    )
    values: RawValues | None = Field(
        default=None,
        description="Of a discrete variable: which text in the log means which declared value. Of "
        "a signal: the texts that it can have.",
        examples=[{"Move-Forward": "forward"}],
    )
    constant: Quantity | None = Field(
        default=None,
        description="The value of a variable that was not logged and did not change, a plain "
        "number in its unit.",
        examples=[0.5],
    )

    @model_validator(mode="after")
    def _has_one_source(self) -> Self:
        refuse(self._mistakes())
        return self

    def _mistakes(self) -> Iterator[Mistake]:
        if self.path is None and self.constant is None:
            yield Mistake(
                "S118",
                "neither a path in the log nor a constant",
                "add 'path: /topic.field' or 'constant: 0.5'",
                on_key=True,
            )
        if self.constant is not None:
            for key in ("path", "delay", "scale", "offset", "unit", "noise", "values"):
                if key in self.model_fields_set:
                    message = f"a constant was not logged, so it has no {quoted(key)}"
                    yield Mistake(
                        "S118", message, f"remove 'constant' or {quoted(key)}", (key,), on_key=True
                    )
        if self.scale == 0:
            yield Mistake(
                "S106",
                "a scale of 0 makes everything 0",
                "write 'constant: 0' if that is meant",
                ("scale",),
            )


TraceSpec: TypeAlias = Annotated[
    TraceEntry, BeforeValidator(_spelled_out, json_schema_input_type=Text | TraceEntry)
]
"""An entry of `trace:`: a bare path, or a mapping."""
