"""A field with modes: another field for each value of a discrete state, and how they change."""

from collections.abc import Mapping
from typing import Annotated, TypeAlias, final

from pydantic import Field, Strict

from spec_schema.value_types import Expression, Name, StrictModel

Rates: TypeAlias = Annotated[Mapping[Name, Expression], Field(min_length=1)]


@final
class Leave(StrictModel):
    """A way out of a mode: when, to which mode, and what jumps on the way."""

    when: Expression = Field(
        description="When the mode is left: comparisons of states, controls and constants, joined "
        "by `and` and `or`. It is left as soon as they hold.",
        examples=["x >= x1"],
    )
    to: Name = Field(description="The mode that follows.", examples=["back"])
    reset: Mapping[Name, Expression] = Field(
        default={},
        description="The values that driven states jump to, worked out before any of them has "
        "jumped; the others stay.",
        examples=[{"v": "-v2"}],
    )


@final
class Mode(StrictModel):
    """The field of one mode, and how the mode is left."""

    formula: Rates = Field(
        description="The rate of each driven state while the mode lasts, as an expression.",
        examples=[{"x": "v", "v": "0"}],
    )
    leave: Annotated[tuple[Leave, ...], Strict(strict=False)] = Field(
        default=(),
        description="The ways out; where two are open at once, the first is taken.",
        examples=[[{"when": "x >= x1", "to": "back", "reset": {"v": "-v2"}}]],
    )


@final
class Modes(StrictModel):
    """A field for each value of a discrete state, which changes where a mode is left."""

    of: Name = Field(
        description="The discrete state whose values are the modes; its role is `both`.",
        examples=["going"],
    )
    each: Annotated[Mapping[Name, Mode], Field(min_length=1)] = Field(
        description="For each value of that state its field, and how it is left.",
        examples=[{"forward": {"formula": {"x": "v"}}, "back": {"formula": {"x": "-v"}}}],
    )
