"""A field drawn by its features: closed orbits, points, separatrices, and arrows beside them."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal, Self, TypeAlias, final

from pydantic import (
    AfterValidator,
    Field,
    ModelWrapValidatorHandler,
    Strict,
    ValidationError,
    model_validator,
)

from spec_schema.mistake import Mistake, refuse, refused, together
from spec_schema.value_types import Identifier, Name, Number, Quantity, StrictModel
from spec_schema.wording import counted, listed, quoted

Spot: TypeAlias = Annotated[tuple[Quantity, ...], Strict(strict=False), Field(min_length=1)]
"""A point of the plane: for each name in `over` a number in its unit, or an expression."""

Spots: TypeAlias = Annotated[tuple[Spot, ...], Strict(strict=False), Field(min_length=1)]
Quantities: TypeAlias = Annotated[tuple[Quantity, ...], Strict(strict=False), Field(min_length=1)]


def _closed(through: tuple[Spot, ...]) -> tuple[Spot, ...]:
    if 0 < len(through) < LEAST:
        message = f"an orbit has at least {LEAST} vertices (got {len(through)})"
        raise refused("S261", message, "add vertices that it passes, in their order")
    return through


LEAST = 3
"""Fewer vertices enclose nothing."""

Vertices: TypeAlias = Annotated[
    tuple[Spot, ...],
    Strict(strict=False),
    Field(min_length=1, json_schema_extra={"minItems": LEAST}),
    AfterValidator(_closed),
]
Rounding: TypeAlias = Annotated[Number, Field(gt=0, le=1)]


@final
class SketchedOrbit(StrictModel):
    """A closed curve that the behavior goes round."""

    name: Identifier | None = Field(
        default=None, description="What messages and claims call it.", examples=["lap"]
    )
    through: Vertices = Field(
        description="Its vertices, in the order in which they are passed; the last leads back to "
        "the first. Expressions of controls and constants are quantities, plain numbers are in "
        "the units of `over`.",
        examples=[[["x2", "v1"], ["x1", "v1"], ["x1", "-v2"], ["x2", "-v2"]]],
    )
    shape: Literal["smooth", "polygon"] = Field(
        default="smooth",
        description="`smooth`: a curve without corners through all vertices; `polygon`: straight "
        "edges with rounded corners.",
        examples=["polygon"],
    )
    rounding: Rounding = Field(
        default=0.3,
        description="How much of the two edges at a corner of a polygon is rounded off, as seen "
        "from the middle: above 0 and at most 1.",
        examples=[0.2],
    )
    attracts: bool = Field(
        default=True,
        description="Whether the neighborhood comes closer (true) or goes away (false).",
        examples=[True],
    )
    strength: Quantity = Field(
        default=1.0,
        description="How fast a small distance from the orbit shrinks or grows, in 1/s: after one "
        "period it is exp(-strength * period) of what it was.",
        examples=["2 1/s"],
    )
    period: Quantity | None = Field(
        default=None, description="The time once round; in s.", examples=["(x1 - x2) / v1 * 2"]
    )
    times: Quantities | None = Field(
        default=None,
        description="Instead of `period`: the time from each vertex to the next; in s.",
        examples=[["(x1 - x2)/v1", "0.5 s", "(x1 - x2)/v2", "0.5 s"]],
    )
    speed: Quantity | None = Field(
        default=None,
        description="Instead of `period`: the speed along the curve, where both axes have like "
        "units.",
        examples=["0.4 m/s"],
    )

    @model_validator(mode="wrap")
    @classmethod
    def _pace_is_clear(cls, data: Any, handler: ModelWrapValidatorHandler[Self]) -> Self:
        found = tuple(_pace_mistakes(data)) if isinstance(data, dict) else ()
        try:
            orbit = handler(data)
        except ValidationError as error:
            raise together(error, found) from None
        refuse(found)
        return orbit


PACES = ("period", "times", "speed")


def _pace_mistakes(data: Mapping[str, Any]) -> Iterator[Mistake]:
    """What is wrong with the pace of an orbit, whatever else is."""
    given = [name for name in PACES if data.get(name) is not None]
    if not any(name in data for name in PACES):
        message = "an orbit without a pace"
        yield Mistake("S261", message, "add 'period: 4 s', 'times:' or 'speed:'", on_key=True)
    for name in given[1:]:
        message = f"{quoted(given[0])} and {quoted(name)} both say how fast the orbit is"
        yield Mistake("S261", message, "remove one of them", (name,), on_key=True)
    times, through = data.get("times"), data.get("through")
    if isinstance(times, list) and isinstance(through, list) and len(times) != len(through):
        message = f"{counted(len(times), 'time')} for {counted(len(through), 'edge')}"
        help_ = "write one for each vertex: the time to the next one"
        yield Mistake("S261", message, help_, ("times",))


@final
class SketchedPoint(StrictModel):
    """A point where the behavior rests: stably, unstably, or as a saddle."""

    is_: Literal["attractor", "repeller", "saddle"] = Field(
        alias="is", description="What it is.", examples=["attractor"]
    )
    at: Spot = Field(
        description="Where it is: numbers in the units of `over`, or expressions of controls and "
        "constants.",
        examples=[["home", 0]],
    )
    name: Identifier | None = Field(
        default=None, description="What messages and claims call it.", examples=["home"]
    )
    rates: Quantity | Quantities = Field(
        default=1.0,
        description="How fast a small distance shrinks or grows, in 1/s; two values for the two "
        "`directions`. Of a saddle, the first shrinks and the second grows.",
        examples=[[2, 1]],
    )
    directions: Spots | None = Field(
        default=None,
        description="The directions of the two rates, as vectors in the units of `over`; of a "
        "saddle, the way in and the way out. Without it, the way out of a saddle leads to its "
        "neighbors.",
        examples=[[[0, 1], [1, 0]]],
    )
    turns: Quantity = Field(
        default=0.0,
        description="How fast the neighborhood turns around it, in rad/s, from the first axis "
        "to the second: a focus instead of a node.",
        examples=["3 rad/s"],
    )

    @model_validator(mode="after")
    def _rates_fit(self) -> Self:
        refuse(self._mistakes())
        return self

    @property
    def both_rates(self) -> tuple[float | str, float | str]:
        """The rates of the two directions."""
        given = self.rates if isinstance(self.rates, tuple) else (self.rates, self.rates)
        return given[0], given[-1]

    def _mistakes(self) -> Iterator[Mistake]:
        if isinstance(self.rates, tuple) and len(self.rates) != 2:
            message = f"{counted(len(self.rates), 'rate')} for two directions"
            yield Mistake("S262", message, "write one for both, or two", ("rates",))
        if self.directions is not None and len(self.directions) != 2:
            message = f"{counted(len(self.directions), 'direction')}: a plane has two"
            yield Mistake("S262", message, "write two vectors: [[0, 1], [1, 0]]", ("directions",))
        if self.turns != 0.0 and self.is_ == "saddle":
            yield Mistake(
                "S262", "a saddle does not turn", "remove 'turns'", ("turns",), on_key=True
            )
        elif self.turns != 0.0 and self.directions is not None:
            message = "a point that turns has no directions: all are alike"
            help_ = "remove 'turns' or 'directions'"
            yield Mistake("S262", message, help_, ("directions",), on_key=True)
        elif self.turns != 0.0 and isinstance(self.rates, tuple):
            message = "a point that turns has one rate: all its directions are alike"
            yield Mistake("S262", message, "write one rate, or remove 'turns'", ("rates",))


@final
class SketchedSeparatrix(StrictModel):
    """A line that nothing crosses: what starts on either side stays there."""

    name: Identifier | None = Field(
        default=None, description="What messages and claims call it.", examples=["ridge"]
    )
    through: Annotated[tuple[Spot, ...], Strict(strict=False), Field(min_length=2)] = Field(
        description="Points of the line, in order; it goes on straight beyond the last ones.",
        examples=[[[0, -1], [0.3, 0], [0, 1]]],
    )
    saddle: Spot | None = Field(
        default=None,
        description="The saddle on it; without it, halfway between the first and the last point.",
        examples=[[0.3, 0]],
    )
    rates: Quantities = Field(
        default=(1.0, 1.0),
        description="How fast the behavior comes to the saddle along the line, and how fast it "
        "leaves the line; in 1/s.",
        examples=[[1, 2]],
    )

    @model_validator(mode="after")
    def _has_two_rates(self) -> Self:
        if len(self.rates) != 2:
            message = f"{counted(len(self.rates), 'rate')} instead of two"
            help_ = "write how fast it comes in along the line, and how fast it leaves the line"
            refuse([Mistake("S262", message, help_, ("rates",))])
        return self


@final
class SketchedArrow(StrictModel):
    """A vector that the filled field has at a point."""

    at: Spot = Field(description="Where the arrow starts.", examples=[[1, 1]])
    go: Spot = Field(
        description="Where it points and how fast, in the units of `over` per second.",
        examples=[[0.2, "-v1/2"]],
    )


KINDS = ("orbits", "points", "separatrices", "arrows")


@final
class Sketch(StrictModel):
    """A plane with the features of its portrait; the compiler fills the space between them."""

    over: Annotated[tuple[Name, ...], Strict(strict=False), Field(min_length=2, max_length=2)] = (
        Field(description="The two driven states that span the plane.", examples=[["x", "v"]])
    )
    orbits: Annotated[tuple[SketchedOrbit, ...], Strict(strict=False)] = Field(
        default=(),
        description="Closed curves, attracting or repelling.",
        examples=[[{"through": [[1, 0], [0, 1], [-1, 0], [0, -1]], "period": "4 s"}]],
    )
    points: Annotated[tuple[SketchedPoint, ...], Strict(strict=False)] = Field(
        default=(),
        description="Attractors, repellers and saddles.",
        examples=[[{"is": "attractor", "at": [1, 0]}]],
    )
    separatrices: Annotated[tuple[SketchedSeparatrix, ...], Strict(strict=False)] = Field(
        default=(),
        description="Lines that nothing crosses, each with its saddle.",
        examples=[[{"through": [[0, -1], [0.3, 0], [0, 1]]}]],
    )
    arrows: Annotated[tuple[SketchedArrow, ...], Strict(strict=False)] = Field(
        default=(),
        description="Vectors that bend the field between the features.",
        examples=[[{"at": [1, 1], "go": [0.2, 0]}]],
    )

    @model_validator(mode="wrap")
    @classmethod
    def _fits_together(cls, data: Any, handler: ModelWrapValidatorHandler[Self]) -> Self:
        found = tuple(_name_mistakes(data)) if isinstance(data, dict) else ()
        try:
            sketch = handler(data)
        except ValidationError as error:
            raise together(error, found) from None
        refuse((*found, *sketch.mistakes()))
        return sketch

    def mistakes(self) -> Iterator[Mistake]:
        """What does not fit together."""
        if self.over[0] == self.over[1]:
            yield Mistake("S112", f"{quoted(self.over[0])} stands twice in 'over'", at=("over", 1))
        if not (self.orbits or self.points or self.separatrices):
            message = "a sketch without a feature"
            help_ = f"add {listed(KINDS[:3])}; arrows alone are a field of their own: 'arrows:'"
            yield Mistake("S262", message, help_, on_key=True)
        yield from self._length_mistakes()

    def _length_mistakes(self) -> Iterator[Mistake]:
        for at, spot in self.spots():
            if len(spot) != len(self.over):
                message = f"{counted(len(spot), 'number')} for {len(self.over)} axes"
                help_ = f"write one for each of: {', '.join(self.over)}"
                yield Mistake("S262", message, help_, at)

    def spots(self) -> Iterator[tuple[tuple[str | int, ...], Spot]]:
        """Every place and vector of the sketch, with the path to it."""
        for i, orbit in enumerate(self.orbits):
            yield from ((("orbits", i, "through", k), s) for k, s in enumerate(orbit.through))
        for i, point in enumerate(self.points):
            yield ("points", i, "at"), point.at
            for k, spot in enumerate(point.directions or ()):
                yield ("points", i, "directions", k), spot
        for i, line in enumerate(self.separatrices):
            yield from ((("separatrices", i, "through", k), s) for k, s in enumerate(line.through))
            if line.saddle is not None:
                yield ("separatrices", i, "saddle"), line.saddle
        for i, arrow in enumerate(self.arrows):
            yield ("arrows", i, "at"), arrow.at
            yield ("arrows", i, "go"), arrow.go


def _name_mistakes(data: Mapping[str, Any]) -> Iterator[Mistake]:
    """Names that stand twice, whatever else is wrong."""
    seen: set[str] = set()
    for kind in KINDS[:3]:
        features = data.get(kind)
        for i, feature in enumerate(features if isinstance(features, list) else ()):
            name = feature.get("name") if isinstance(feature, dict) else None
            if isinstance(name, str) and name in seen:
                message = f"two features are named {quoted(name)}"
                yield Mistake("S262", message, "rename one of them", (kind, i, "name"))
            seen.update([name] if isinstance(name, str) else [])
