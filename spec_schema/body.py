"""The model of a body: what of a robot stands in the world, moves and senses."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Final, Literal, Self, TypeAlias, final

from pydantic import Field, Strict, model_validator

from spec_schema.mistake import Mistake, refuse
from spec_schema.shapes import Heights, PoseText, ShapeSpec
from spec_schema.value_types import (
    Identifier,
    Name,
    Number,
    Quantity,
    StrictModel,
    Text,
    Version,
)

OWNERS: Final = {
    "rays": ("range",),
    "of": ("sight",),
    "slip": ("odometry",),
    "reach": ("range", "sight"),
    "width": ("bump", "range", "light", "sight"),
}
"""Which sensors have what only some have."""

LargestSpeed: TypeAlias = Annotated[
    Quantity, Field(description="The largest speed.", examples=["0.5 m/s"])
]
LargestTurn: TypeAlias = Annotated[
    Quantity, Field(description="The largest turn rate.", examples=["3 rad/s"])
]
Acceleration: TypeAlias = Annotated[
    Quantity, Field(description="The largest rate of change of the speed.", examples=[2])
]
Spin: TypeAlias = Annotated[
    Quantity, Field(description="The largest rate of change of the turn rate.", examples=[20])
]


@final
class DifferentialSpec(StrictModel):
    """Two driven wheels; the channels are `base.speed` and `base.turn`."""

    track: Quantity = Field(description="The distance of the wheels.", examples=["20 cm"])
    speed: LargestSpeed
    turn: LargestTurn
    traction: Annotated[Number, Field(gt=0)] = Field(
        default=0.8,
        description="The friction of the wheels on the floor: what can be pushed is limited by it.",
        examples=[0.8],
    )
    acceleration: Acceleration = "2 m/s^2"
    spin: Spin = "20 rad/s^2"


@final
class HolonomicSpec(StrictModel):
    """Driven in any direction; the channels are `base.forward`, `base.left` and `base.turn`."""

    speed: LargestSpeed
    turn: LargestTurn
    traction: Annotated[Number, Field(gt=0)] = Field(
        default=0.8, description="The friction of its feet on the floor.", examples=[0.8]
    )
    acceleration: Acceleration = "2 m/s^2"
    spin: Spin = "20 rad/s^2"


@final
class DriveSpec(StrictModel):
    """What moves the body: exactly one of the two."""

    differential: DifferentialSpec | None = Field(
        default=None,
        description="Two driven wheels.",
        examples=[{"track": "20 cm", "speed": "0.5 m/s", "turn": "3 rad/s"}],
    )
    holonomic: HolonomicSpec | None = Field(
        default=None,
        description="Driven in any direction.",
        examples=[{"speed": "0.5 m/s", "turn": "3 rad/s"}],
    )

    @model_validator(mode="after")
    def _is_one(self) -> Self:
        if (self.differential is None) == (self.holonomic is None):
            help_ = "write 'differential: {...}' or 'holonomic: {...}'"
            refuse([Mistake("S312", "a body has one drive", help_, on_key=True)])
        return self


@final
class SensorSpec(StrictModel):
    """A sensor: what it senses, from where, how often, and how well."""

    senses: Literal["bump", "range", "light", "sight", "odometry", "gyro", "pose"] = Field(
        description="`bump`: whether something touches it (reading `hit`). `range`: the distance "
        "to the nearest thing in its view (`range`). `light`: how bright it is (`light`, lux). "
        "`sight`: where the nearest of some things is (`seen`, `bearing`, `distance`). "
        "`odometry`: how the wheels turned (`x`, `y`, `heading`, `speed`, `turn`). `gyro`: how "
        "fast the body turns, whatever its wheels do (`turn`). `pose`: where it is and how it "
        "moves, without error, which no robot has by itself.",
        examples=["range"],
    )
    at: PoseText = Field(
        default=(0.0, 0.0),
        description="Where it is on the body and where it looks: x ahead, y to the left, and a "
        "direction, 0 ahead.",
        examples=[["10 cm", 0, "90 deg"]],
    )
    width: Quantity | None = Field(
        default=None,
        description="The full angle of its view; without it, 360 deg for bump, light and sight, "
        "and a single ray for range.",
        examples=["60 deg"],
    )
    reach: Quantity | None = Field(
        default=None,
        description="How far it sees: of range and sight. A range that hits nothing says this.",
        examples=["2 m"],
    )
    rays: Annotated[int, Field(ge=1, le=720)] = Field(
        default=1,
        description="Of range: the least of so many rays over its width is what it says.",
        examples=[9],
    )
    height: Quantity | None = Field(
        default=None,
        description="Its height above the floor; without it, half the height of the body.",
        examples=["8 cm"],
    )
    of: Annotated[tuple[Text, ...], Strict(strict=False)] = Field(
        default=(),
        description="Of sight: what it looks for, by name; `NAME_*` for all copies that were "
        "scattered, `light` for any light.",
        examples=[["light"]],
    )
    slip: Annotated[Number, Field(ge=0, le=1)] = Field(
        default=0.0,
        description="Of odometry: the standard deviation of each wheel's scale, drawn once a run.",
        examples=[0.02],
    )
    every: Quantity = Field(
        default="50 ms", description="The time between two samples.", examples=["50 ms"]
    )
    latency: Quantity = Field(
        default=0.0, description="How much later it says what it sampled.", examples=["20 ms"]
    )
    noise: Mapping[Name, Quantity] = Field(
        default={},
        description="For each reading the standard deviation of its noise.",
        examples=[{"range": "1 cm"}],
    )
    resolution: Mapping[Name, Quantity] = Field(
        default={},
        description="For each reading the step in which it is given.",
        examples=[{"range": "1 cm"}],
    )

    @model_validator(mode="after")
    def _parts_fit(self) -> Self:
        refuse(self._mistakes())
        return self

    def _mistakes(self) -> Iterator[Mistake]:
        for key, senses in OWNERS.items():
            if key in self.model_fields_set and self.senses not in senses:
                message = f"a sensor of {self.senses} has no '{key}'"
                yield Mistake("S313", message, f"remove '{key}'", (key,), on_key=True)
        if self.senses in {"range", "sight"} and self.reach is None:
            yield Mistake("S101", "'reach' is missing", "add 'reach: 2 m'")
        if self.senses == "sight" and not self.of:
            yield Mistake("S101", "'of' is missing: what does it look for?", "add 'of: [light]'")


@final
class BodySpec(StrictModel):
    """A body: what of a robot stands in the world, moves and senses."""

    specc: Version = Field(description="The version of the language: 1.", examples=[1])
    kind: Literal["body"] = Field(description="What the file describes.", examples=["body"])
    name: Identifier = Field(description="The body's name.", examples=["courier"])
    about: Text | None = Field(
        default=None, description="What it is, in a sentence.", examples=["A small round robot."]
    )
    shape: ShapeSpec = Field(description="Its footprint.", examples=[{"circle": "12 cm"}])
    height: Heights = Field(
        default=(0.0, "10 cm"),
        description="From which height above the floor to which it reaches.",
        examples=[[0, "10 cm"]],
    )
    mass: Quantity = Field(description="Its mass.", examples=["3 kg"])
    friction: Annotated[Number, Field(ge=0)] = Field(
        default=0.2,
        description="The friction of its sides; that of a contact is the product of both.",
        examples=[0.2],
    )
    drive: DriveSpec = Field(
        description="What moves it.",
        examples=[{"differential": {"track": "20 cm", "speed": "0.5 m/s", "turn": "3 rad/s"}}],
    )
    rest: Mapping[Text, Literal["stop", "hold", "coast"]] = Field(
        default={},
        description="What a channel does when nobody drives it: `stop` brings it to 0, `hold` "
        "keeps the last command, `coast` lets it roll. Without it, `stop`.",
        examples=[{"base.speed": "hold"}],
    )
    sensors: Mapping[Name, SensorSpec] = Field(
        default={},
        description="Its sensors.",
        examples=[{"left": {"senses": "range", "at": [0, 0, "90 deg"], "reach": "2 m"}}],
    )
