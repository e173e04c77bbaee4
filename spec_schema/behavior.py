"""The model of a behavior spec: a phase space, a field on it, and what verifies it."""

from collections.abc import Mapping
from typing import Annotated, Literal, Self, TypeAlias, final

from pydantic import Field, WithJsonSchema, model_validator

from spec_schema.expect import ClaimSpec
from spec_schema.field_forms import FieldSpec
from spec_schema.mistake import Mistake, refuse
from spec_schema.trace_mapping import TraceSpec
from spec_schema.value_types import (
    Bytes,
    ChannelText,
    Domain,
    Expression,
    Identifier,
    Name,
    Number,
    Quantity,
    StrictModel,
    Text,
    Version,
)
from spec_schema.variables import ConstantSpec, ControlSpec, OutputSpec, StateSpec

NodeCount: TypeAlias = Annotated[int, Field(ge=2, le=100_000)]
Share: TypeAlias = Annotated[
    Number,
    Field(gt=0, le=1),
    WithJsonSchema({"type": "number", "exclusiveMinimum": 0, "maximum": 1}),
]


@final
class TableSpec(StrictModel):
    """How exactly the field is tabulated, with which nodes, in how much memory."""

    tolerance: Mapping[Name, Quantity] = Field(
        default={},
        description="How far the table may be from the field itself, for each driven state: a "
        "plain number in its unit per second. Without it, one is derived from the fidelity "
        "tolerance.",
        examples=[{"x": "1e-6 m/s"}],
    )
    method: Literal["cubic", "linear"] = Field(
        default="cubic",
        description="What holds between the nodes: a twice differentiable spline, or straight "
        "lines.",
        examples=["linear"],
    )
    nodes: Mapping[Name, NodeCount] = Field(
        default={},
        description="A fixed number of nodes for an axis; the others are refined until the "
        "tolerance is met.",
        examples=[{"x": 65}],
    )
    budget: Bytes = Field(
        default=64 * 2**20,
        description="The memory that all tables of the behavior may take.",
        examples=["64 MiB"],
        json_schema_extra={"default": "64 MiB"},
    )
    keep: Literal["tables", "code"] = Field(
        default="tables",
        description="What the artifact runs: interpolated tables, or the formula as code (for a "
        "formula over many variables).",
        examples=["code"],
    )


@final
class Feasibility(StrictModel):
    """A claim that a robot can do this, and what shows it."""

    level: Literal["demonstrated", "plausible", "hypothetical"] = Field(
        description="Whether a robot has done it, could, or nobody knows.", examples=["plausible"]
    )
    evidence: Text | None = Field(
        default=None,
        description="What shows it: a recording, a paper. Only what is hypothetical needs none.",
        examples=["traces/husky.mcap"],
    )

    @model_validator(mode="after")
    def _has_evidence(self) -> Self:
        if self.level != "hypothetical" and self.evidence is None:
            help_ = "add 'evidence: ...', or write 'level: hypothetical'"
            refuse(
                [
                    Mistake(
                        "S101", f"'evidence' is missing: what shows that it is {self.level}?", help_
                    )
                ]
            )
        return self


@final
class Fidelity(StrictModel):
    """When a recording shows the behavior: how close, how far ahead, where."""

    tolerance: Annotated[Mapping[Name, Quantity], Field(min_length=1)] = Field(
        description="How far the robot may be from the prediction at the horizon, for each driven "
        "state that is judged: a plain number in its unit.",
        examples=[{"x": "0.05 m"}],
    )
    scatter: Mapping[Name, Quantity] = Field(
        default={},
        description="By how much (standard deviation) single runs of a restless robot may depart "
        "beside the tolerance: a plain number in the state's unit.",
        examples=[{"x": "0.1 m"}],
    )
    horizon: Quantity = Field(
        description="How far ahead is predicted, a plain number in seconds.", examples=["2 s"]
    )
    region: Mapping[Name, Domain] = Field(
        default={},
        description="Where in phase space it must have been seen; without it, the verdict holds "
        "where the robot was, and the report says how much of the domain that is.",
        examples=[{"x": [-1.6, 1.6]}],
    )
    coverage: Share = Field(
        default=0.6,
        description="The share of the region's cells that a recording must visit for a PASS, above "
        "0 and at most 1. Without a region nothing is asked.",
        examples=[0.6],
    )


@final
class BehaviorSpec(StrictModel):
    """A behavior: a phase space with a vector field on it, and a control interface."""

    specc: Version = Field(description="The version of the language: 1.", examples=[1])
    kind: Literal["behavior"] = Field(description="What the file describes.", examples=["behavior"])
    name: Identifier = Field(description="The behavior's name.", examples=["patrol"])
    about: Text | None = Field(
        default=None,
        description="What the behavior does, in a sentence.",
        examples=["Shuttle along a line between two turning points."],
    )
    state: Annotated[Mapping[Name, StateSpec], Field(min_length=1)] = Field(
        description="The state variables: the axes of the phase space.",
        examples=[
            {
                "x": {
                    "unit": "m",
                    "domain": [-2, 2],
                    "role": "both",
                    "relates": {
                        "agent": "center of the base",
                        "environment": "midpoint of the line",
                    },
                }
            }
        ],
    )
    control: Mapping[Name, ControlSpec] = Field(
        default={},
        description="The control parameters: what can be set from outside.",
        examples=[{"gain": {"unit": "1/s", "domain": [0.1, 3], "default": 1}}],
    )
    constants: Mapping[Name, ConstantSpec] = Field(
        default={},
        description="Named numbers with units.",
        examples=[{"k": {"value": 2, "unit": "1/s"}}],
    )
    output: Mapping[Name, OutputSpec] = Field(
        default={},
        description="The output parameters: what the behavior tells others.",
        examples=[{"lap": {"unit": "1", "is": "(x - x2) / (x1 - x2)"}}],
    )
    field: FieldSpec = Field(
        description="The vector field: where the behavior goes from every point, in exactly one "
        "form.",
        examples=[{"formula": {"x": "-k*x"}}],
    )
    noise: Mapping[Name, Quantity] = Field(
        default={},
        description="How restless it is: for each driven state how far chance moves it in one "
        "second (standard deviation), growing with the square root of time; for a step map, in one "
        "step. A number, a quantity, or an expression in the state's unit.",
        examples=[{"heading": "20 deg"}],
    )
    table: TableSpec = Field(
        default_factory=TableSpec,
        description="How the field is tabulated.",
        examples=[{"tolerance": {"x": "1e-6 m/s"}}],
    )
    realizes: Mapping[Name, ChannelText] = Field(
        default={},
        description="The channel of a body that a driven state acts on: `CHANNEL as rate`, `as "
        "set-point` or `as acceleration`; `-CHANNEL` turns the sign. An output or control acts `as "
        "set-point`.",
        examples=[{"v": "base.speed as set-point"}],
    )
    feasibility: Feasibility | None = Field(
        default=None,
        description="What is known of whether a real robot can do this.",
        examples=[{"level": "demonstrated", "evidence": "traces/husky.mcap"}],
    )
    expect: tuple[ClaimSpec, ...] = Field(
        default=(),
        strict=False,
        description="Claims about the topology of the field, each a sentence; `specc check "
        "--claims` proves or refutes them.",
        examples=[["one stable cycle", "no other attractor"]],
    )
    fidelity: Fidelity | None = Field(
        default=None,
        description='What "the robot does this" means.',
        examples=[{"tolerance": {"x": "0.05 m"}, "horizon": "2 s"}],
    )
    trace: Mapping[Name, TraceSpec] = Field(
        default={},
        description="Where the variables stand in a log; a name that is not declared is a signal "
        "for `judge_when`.",
        examples=[{"x": "/odom.pose.pose.position.x"}],
    )
    judge_when: Expression | None = Field(
        default=None,
        description="When the robot is judged: an expression of states, controls, constants and "
        "signals.",
        examples=["not intervention"],
    )
