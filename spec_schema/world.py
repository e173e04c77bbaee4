"""The model of a world: an arena, the things in it, and its lights."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Literal, Self, TypeAlias, final

from pydantic import Field, Strict, model_validator

from spec_schema.mistake import Mistake, refuse
from spec_schema.shapes import Heights, Point, PoseText, ShapeSpec
from spec_schema.value_types import (
    Identifier,
    Name,
    Number,
    Quantity,
    StrictModel,
    Text,
    Version,
)

Fraction: TypeAlias = Annotated[Number, Field(ge=0, le=1)]
NotNegative: TypeAlias = Annotated[Number, Field(ge=0)]


@final
class ArenaSpec(StrictModel):
    """Where everything is: a rectangle, or a polygon. Its edges are walls."""

    box: Point | None = Field(
        default=None,
        description="Length and width of a rectangle whose lower left corner is (0, 0).",
        examples=[["4 m", "3 m"]],
    )
    polygon: Annotated[tuple[Point, ...], Strict(strict=False), Field(min_length=3)] | None = Field(
        default=None,
        description="The corners of a simple polygon, counter-clockwise.",
        examples=[[[0, 0], [4, 0], [4, 3], [0, 3]]],
    )
    friction: NotNegative = Field(
        default=0.4, description="The friction of the walls.", examples=[0.4]
    )

    @model_validator(mode="after")
    def _is_one(self) -> Self:
        if (self.box is None) == (self.polygon is None):
            message = "an arena is a box or a polygon"
            refuse([Mistake("S318", message, "write 'box: [4 m, 3 m]'", on_key=True)])
        return self


class _Object(StrictModel):
    """What things and scattered things have in common."""

    shape: ShapeSpec = Field(description="Its footprint.", examples=[{"box": [0.3, 0.2]}])
    fixed: bool = Field(
        default=False, description="Whether it is fixed to the floor.", examples=[True]
    )
    mass: Quantity = Field(
        default="1 kg", description="Its mass; of no use where it is fixed.", examples=["1 kg"]
    )
    friction: NotNegative = Field(
        default=0.4,
        description="The friction of its sides; that of a contact is the product of both.",
        examples=[0.4],
    )
    floor: NotNegative = Field(
        default=0.4, description="Its friction on the floor.", examples=[0.4]
    )
    height: Heights = Field(
        default=(0.0, "18 cm"),
        description="From which height above the floor to which it reaches.",
        examples=[[0, "18 cm"]],
    )
    transmittance: Fraction = Field(
        default=0.0,
        description="The share of light that passes through it, 0 to 1.",
        examples=[0.3],
    )


@final
class ThingSpec(_Object):
    """One thing, where it stands."""

    at: PoseText = Field(
        description="Where its middle is, and its direction.", examples=[[1, 2, "30 deg"]]
    )


@final
class ScatterSpec(_Object):
    """Copies of a thing, laid at random, anew for each seed."""

    count: Annotated[int, Field(ge=1, le=1000)] = Field(description="How many.", examples=[20])
    sizes: Annotated[tuple[Number, ...], Strict(strict=False)] = Field(
        default=(1.0, 1.0),
        description="From which factor to which each copy is scaled.",
        examples=[[0.7, 1.3]],
    )
    fixed_share: Fraction = Field(
        default=0.0, description="The share of copies that are fixed, 0 to 1.", examples=[0.25]
    )
    gap: Quantity = Field(
        default="5 cm", description="At least so far from all else.", examples=["10 cm"]
    )
    area: Annotated[tuple[Point, ...], Strict(strict=False)] | None = Field(
        default=None,
        description="The lower left and upper right corner of where they lie; without it, all of "
        "the arena.",
        examples=[[[0, 0], [2, 2]]],
    )

    @model_validator(mode="after")
    def _ranges_fit(self) -> Self:
        refuse(self._mistakes())
        return self

    def _mistakes(self) -> Iterator[Mistake]:
        if len(self.sizes) != 2 or not 0 < self.sizes[0] <= self.sizes[-1]:
            message = "sizes are two factors above 0, the smaller first"
            yield Mistake("S319", message, "write 'sizes: [0.7, 1.3]'", ("sizes",))
        if self.area is not None and len(self.area) != 2:
            message = f"an area has two corners, not {len(self.area)}"
            yield Mistake("S319", message, "write 'area: [[0, 0], [2, 2]]'", ("area",))


@final
class LightSpec(StrictModel):
    """A source of light: it shines all round, or in a cone."""

    at: PoseText = Field(
        default=(0.0, 0.0),
        description="Where it is, and the direction of its cone; on a thing: relative to that.",
        examples=[[2, 1, "90 deg"]],
    )
    on: Name | None = Field(
        default=None,
        description="The thing that carries it; without it, it hangs from above.",
        examples=["stand"],
    )
    height: Quantity = Field(
        default="17 cm", description="Its height above the floor.", examples=["17 cm"]
    )
    power: Quantity = Field(description="Its luminous intensity.", examples=["10 cd"])
    cone: Quantity = Field(
        default="360 deg", description="The full angle into which it shines.", examples=["60 deg"]
    )


@final
class WorldSpec(StrictModel):
    """A world: an arena with things and lights in it."""

    specc: Version = Field(description="The version of the language: 1.", examples=[1])
    kind: Literal["world"] = Field(description="What the file describes.", examples=["world"])
    name: Identifier = Field(description="The world's name.", examples=["office"])
    about: Text | None = Field(
        default=None, description="What it is, in a sentence.", examples=["A cluttered floor."]
    )
    arena: ArenaSpec = Field(description="Where everything is.", examples=[{"box": [4, 3]}])
    ambient: Quantity = Field(
        default=0.0, description="The light that is everywhere, in lux.", examples=["1 lx"]
    )
    things: Mapping[Name, ThingSpec] = Field(
        default={},
        description="The things in it.",
        examples=[{"crate": {"shape": {"box": [0.3, 0.2]}, "at": [1, 2]}}],
    )
    scatter: Mapping[Name, ScatterSpec] = Field(
        default={},
        description="Things laid at random, anew for each seed.",
        examples=[{"clutter": {"shape": {"box": [0.2, 0.2]}, "count": 20}}],
    )
    lights: Mapping[Name, LightSpec] = Field(
        default={},
        description="Its lights.",
        examples=[{"bulb": {"at": [2, 1], "power": "10 cd"}}],
    )
