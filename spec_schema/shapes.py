"""Footprints and poses: what stands where on the floor."""

from collections.abc import Iterator
from typing import Annotated, Self, TypeAlias, final

from pydantic import Field, Strict, model_validator

from spec_schema.mistake import Mistake, refuse
from spec_schema.value_types import Quantity, StrictModel

Point: TypeAlias = Annotated[
    tuple[Quantity, ...], Strict(strict=False), Field(min_length=2, max_length=2)
]
"""x and y; plain numbers are metres."""

PoseText: TypeAlias = Annotated[
    tuple[Quantity, ...], Strict(strict=False), Field(min_length=2, max_length=3)
]
"""x, y and perhaps a direction; plain numbers are metres and radians."""

Heights: TypeAlias = Annotated[
    tuple[Quantity, ...], Strict(strict=False), Field(min_length=2, max_length=2)
]
"""From which height to which; plain numbers are metres."""


class _Outline(StrictModel):
    """What a footprint and a part of one have in common: at most one of these."""

    circle: Quantity | None = Field(
        default=None, description="The radius of a circle.", examples=["12 cm"]
    )
    box: Point | None = Field(
        default=None,
        description="Length (ahead) and width of a rectangle around the middle.",
        examples=[["30 cm", "20 cm"]],
    )
    polygon: Annotated[tuple[Point, ...], Strict(strict=False), Field(min_length=3)] | None = Field(
        default=None,
        description="The corners of a convex polygon, counter-clockwise.",
        examples=[[[0, 0], [0.2, 0], [0.1, 0.2]]],
    )


@final
class PartSpec(_Outline):
    """A part of a footprint: a circle, a box, or a convex polygon."""

    at: PoseText = Field(
        default=(0.0, 0.0),
        description="Where the part's middle is on the whole: x ahead, y to the left, a direction.",
        examples=[["5 cm", 0]],
    )

    @model_validator(mode="after")
    def _is_one(self) -> Self:
        refuse(_not_one(self, ("circle", "box", "polygon")))
        return self


@final
class ShapeSpec(_Outline):
    """A footprint: one circle, box or convex polygon, or several that are rigidly joined."""

    parts: Annotated[tuple[PartSpec, ...], Strict(strict=False), Field(min_length=1)] | None = (
        Field(
            default=None,
            description="The parts of a footprint that is no single circle, box or polygon.",
            examples=[[{"box": [0.3, 0.1]}, {"circle": 0.1, "at": [0.15, 0]}]],
        )
    )

    @model_validator(mode="after")
    def _is_one(self) -> Self:
        refuse(_not_one(self, ("circle", "box", "polygon", "parts")))
        return self


def _not_one(outline: StrictModel, keys: tuple[str, ...]) -> Iterator[Mistake]:
    given = [key for key in keys if getattr(outline, key) is not None]
    if len(given) != 1:
        what = " and ".join(given) if given else "nothing"
        message = f"a footprint is one of {', '.join(keys)}; this one is {what}"
        yield Mistake("S311", message, "write one of them: 'circle: 12 cm'", on_key=True)
