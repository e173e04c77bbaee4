"""The model of a scenario: robots in a world, for a while, and what is required of the run."""

from collections.abc import Mapping
from typing import Annotated, Literal, TypeAlias, final

from pydantic import Field, Strict

from spec_schema.starts import StartText
from spec_schema.training import TrainingSpec
from spec_schema.value_types import (
    Identifier,
    Name,
    Quantity,
    StrictModel,
    Text,
    Version,
)

Seed: TypeAlias = Annotated[int, Field(ge=0, lt=2**63)]


@final
class RobotSpec(StrictModel):
    """A robot: its architecture, which names its body, and where it starts."""

    architecture: Text = Field(
        description="What controls it: a spec, as a path from this file.",
        examples=["find_light.yaml"],
    )
    at: StartText = Field(
        default="random",
        description="Where it starts, and its direction; or `random`: anywhere that is free, anew "
        "for each seed.",
        examples=[[1, 1, "90 deg"]],
    )
    start: Mapping[Text, Quantity] = Field(
        default={},
        description="Where internal states of its nodes start from, as NODE.STATE.",
        examples=[{"patrol.going": "back"}],
    )


@final
class ScenarioSpec(StrictModel):
    """A scenario: what `specc simulate` runs."""

    specc: Version = Field(description="The version of the language: 1.", examples=[1])
    kind: Literal["scenario"] = Field(description="What the file describes.", examples=["scenario"])
    name: Identifier = Field(description="The scenario's name.", examples=["first_light"])
    about: Text | None = Field(
        default=None, description="What it shows, in a sentence.", examples=["One robot, one bulb."]
    )
    world: Text = Field(
        description="The world: a spec, as a path from this file.", examples=["office.yaml"]
    )
    robots: Annotated[Mapping[Name, RobotSpec], Field(min_length=1)] = Field(
        description="The robots in it.", examples=[{"r": {"architecture": "find_light.yaml"}}]
    )
    duration: Quantity = Field(
        description="How long it runs, a plain number in seconds.", examples=["60 s"]
    )
    step: Quantity = Field(
        default=1 / 240,
        description="The longest step of the physics, a plain number in seconds; the step that is "
        "taken divides every period, response time, rate and latency. Without it, 1/240 s.",
        examples=["4 ms"],
    )
    seed: Seed = Field(default=0, description="What all chance follows from.", examples=[7])
    require: Annotated[tuple[Text, ...], Strict(strict=False)] = Field(
        default=(),
        description="What the run must satisfy, each a sentence of signal temporal logic.",
        examples=[["always r.clearance > 1 cm", "eventually within 60 s r.lamp.light > 5 lx"]],
    )
    train: TrainingSpec | None = Field(
        default=None,
        description="How `specc train` trains an arbiter in it.",
        examples=[
            {
                "arbiter": "r.choose",
                "reward": "progress - 10 * contact",
                "measures": {
                    "progress": {"fall": "hypot(r.x - 5 m, r.y - 3 m)"},
                    "contact": {"most": "r.contacts"},
                },
            }
        ],
    )
