"""The model of a project file, `specc.yaml`: its specs, and which of them judges which trace."""

from collections.abc import Mapping
from typing import Annotated, Literal, final

from pydantic import Field, Strict

from spec_schema.value_types import Identifier, StrictModel, Text, Version


@final
class ProjectSpec(StrictModel):
    """A project: what `specc verify trace.mcap` finds without being told more."""

    specc: Version = Field(description="The version of the language: 1.", examples=[1])
    kind: Literal["project"] = Field(description="What the file describes.", examples=["project"])
    name: Identifier = Field(description="The project's name.", examples=["patrol_robot"])
    specs: Annotated[tuple[Text, ...], Strict(strict=False)] = Field(
        default=(),
        description="The specs of the project, as paths from this file.",
        examples=[["specs/patrol.yaml"]],
    )
    traces: Mapping[Text, Text] = Field(
        default={},
        description="For each pattern of file names the spec that its traces are judged by, both "
        "as paths from this file; the first pattern that matches counts.",
        examples=[{"traces/patrol_*.mcap": "specs/patrol.yaml"}],
    )
