"""The model of a behavior spec: a phase space, a field on it, and what verifies it."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Literal, Self, TypeAlias, final

from pydantic import Field, Strict, model_validator

from spec_schema.field_forms import FieldSpec, repeated
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
    UnitText,
    Version,
)
from spec_schema.wording import listed, number, quoted

NodeCount: TypeAlias = Annotated[int, Field(ge=2, le=100_000)]
Share: TypeAlias = Annotated[Number, Field(gt=0, le=1)]


@final
class Relation(StrictModel):
    """What a state variable relates: something of the agent, and something of its environment."""

    agent: Text = Field(
        description="What of the agent it is measured from.", examples=["center of the base"]
    )
    environment: Text = Field(
        description="What of the environment it is measured to.", examples=["midpoint of the line"]
    )


@final
class StateSpec(StrictModel):
    """A state variable: one axis of the phase space."""

    unit: UnitText | None = Field(
        default=None,
        description='The unit of all plain numbers about it; "1" for a number without one. A '
        "discrete variable has none.",
        examples=["m/s"],
    )
    domain: Domain | None = Field(
        default=None,
        description="The lowest and the highest value for which the field is known: numbers in the "
        "variable's unit, quantities or expressions of numbers. A periodic variable wraps from the "
        "one to the other; a discrete one has no domain.",
        examples=[[-2, 2]],
    )
    kind: Literal["continuous", "periodic", "discrete"] = Field(
        default="continuous",
        description="Whether it takes any number, wraps around as an angle does, or takes one of "
        "some named values.",
        examples=["periodic"],
    )
    values: Annotated[tuple[Name, ...], Strict(strict=False), Field(min_length=1)] | None = Field(
        default=None,
        description="The values of a discrete variable, in order.",
        examples=[["open", "closed"]],
    )
    role: Literal["sensed", "driven", "both"] = Field(
        description="Whether the behavior reads it (sensed), moves it (driven), or both. The field "
        "gives a rate for each variable that is driven or both.",
        examples=["both"],
    )
    relates: Relation = Field(
        description="What of the agent and what of the environment it relates.",
        examples=[{"agent": "center of the base", "environment": "midpoint of the line"}],
    )
    hold: Quantity | None = Field(
        default=None,
        description="Where it is held when it is not on show, in its unit; without it, in the "
        "middle of its domain. Of a discrete variable, one of its values.",
        examples=[0],
    )
    closure: Expression | None = Field(
        default=None,
        description="The rate of a sensed variable that is assumed when the behavior runs alone, in "
        "its unit per second (for a step map: its next value).",
        examples=["-speed*cos(bearing)"],
    )
    about: Text | None = Field(
        default=None, description="What it is, in words.", examples=["distance to the wall"]
    )

    @model_validator(mode="after")
    def _parts_fit(self) -> Self:
        refuse(self._mistakes())
        return self

    def _mistakes(self) -> Iterator[Mistake]:
        yield from self._discrete_mistakes() if self.kind == "discrete" else self._number_mistakes()
        if self.closure is not None and self.role != "sensed":
            message = f"a closure is the rate of a variable that is only sensed; this one's role is {quoted(self.role)}"
            yield Mistake(
                "S117",
                message,
                "remove 'closure', or write 'role: sensed'",
                ("closure",),
                on_key=True,
            )

    def _discrete_mistakes(self) -> Iterator[Mistake]:
        if self.values is None:
            yield Mistake(
                "S112",
                "a discrete variable without values",
                "add 'values: [open, closed]'",
                on_key=True,
            )
        else:
            yield from repeated(self.values, "values")
            if self.hold is not None and self.hold not in self.values:
                message = f"{_shown(self.hold)} is none of the values"
                yield Mistake("S114", message, f"write one of {listed(self.values)}", ("hold",))
        for key in ("unit", "domain"):
            if getattr(self, key) is not None:
                message = f"a discrete variable has values, no {key}"
                yield Mistake(
                    "S112",
                    message,
                    f"remove '{key}', or write 'kind: continuous'",
                    (key,),
                    on_key=True,
                )

    def _number_mistakes(self) -> Iterator[Mistake]:
        for key, example in (("unit", "unit: m"), ("domain", "domain: [-2, 2]")):
            if getattr(self, key) is None:
                yield Mistake("S101", f"'{key}' is missing", f"add '{example}'")
        if self.values is not None:
            message = f"a {self.kind} variable has a domain, no values"
            yield Mistake(
                "S112",
                message,
                "remove 'values', or write 'kind: discrete'",
                ("values",),
                on_key=True,
            )
        yield from outside(self.hold, self.domain, "hold")


@final
class ControlSpec(StrictModel):
    """A control parameter: set from outside, constant for the field."""

    unit: UnitText = Field(
        description='The unit of all plain numbers about it; "1" for a number without one.',
        examples=["1/s"],
    )
    domain: Domain = Field(
        description="The lowest and the highest value that may be set, in its unit.",
        examples=[[0.1, 3]],
    )
    default: Quantity = Field(
        description="Its value when nobody sets it, in its unit.", examples=[1]
    )
    about: Text | None = Field(
        default=None, description="What it does, in words.", examples=["how hard it turns"]
    )

    @model_validator(mode="after")
    def _default_fits(self) -> Self:
        refuse(outside(self.default, self.domain, "default"))
        return self


@final
class ConstantSpec(StrictModel):
    """A named number of the behavior."""

    value: Quantity = Field(description="The number, in its unit.", examples=[2])
    unit: UnitText = Field(description='Its unit; "1" for a number without one.', examples=["1/s"])
    about: Text | None = Field(
        default=None, description="What it is, in words.", examples=["stiffness of the tether"]
    )


@final
class OutputSpec(StrictModel):
    """An output parameter: what the behavior tells others about itself."""

    unit: UnitText = Field(
        description='The unit of the expression\'s value; "1" for a number without one.',
        examples=["1"],
    )
    expression: Expression = Field(
        alias="is",
        description="Its value as an expression of states, controls and constants.",
        examples=["(x - x2) / (x1 - x2)"],
    )
    about: Text | None = Field(
        default=None, description="What it tells, in words.", examples=["share of the lap done"]
    )


@final
class TableSpec(StrictModel):
    """How the field is tabulated."""

    tolerance: Mapping[Name, Quantity] = Field(
        default={},
        description="How far the table may be from the field itself, for each driven state: a plain "
        "number in its unit per second. Without it, a tenth of what the fidelity tolerance allows.",
        examples=[{"x": "1e-6 m/s"}],
    )
    method: Literal["cubic", "linear"] = Field(
        default="cubic",
        description="What holds between the nodes: a twice differentiable spline, or straight lines.",
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
    )
    keep: Literal["tables", "code"] = Field(
        default="tables",
        description="What the artifact runs: interpolated tables, or the formula as code (for a "
        "formula over many variables).",
        examples=["code"],
    )


@final
class Feasibility(StrictModel):
    """What is known of whether a real robot can do this."""

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
    """What "the robot does this" means, in the user's units."""

    tolerance: Annotated[Mapping[Name, Quantity], Field(min_length=1)] = Field(
        description="How far the robot may be from the prediction at the horizon, for each driven "
        "state that is judged: a plain number in its unit.",
        examples=[{"x": "0.05 m"}],
    )
    horizon: Quantity = Field(
        description="How far ahead is predicted, a plain number in seconds.", examples=["2 s"]
    )
    region: Mapping[Name, Domain] = Field(
        default={},
        description="Where in phase space it must have been seen; without it, the whole domain.",
        examples=[{"x": [-1.6, 1.6]}],
    )
    coverage: Share = Field(
        default=0.6,
        description="The share of the region's cells that a recording must visit for a PASS, above "
        "0 and at most 1.",
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
    table: TableSpec = Field(
        default=TableSpec(),
        description="How the field is tabulated.",
        examples=[{"tolerance": {"x": "1e-6 m/s"}}],
    )
    realizes: Mapping[Name, ChannelText] = Field(
        default={},
        description="The channel of a body that a driven state acts on: `CHANNEL as rate`, `as "
        "set-point` or `as acceleration`.",
        examples=[{"v": "base.speed as set-point"}],
    )
    feasibility: Feasibility | None = Field(
        default=None,
        description="What is known of whether a real robot can do this.",
        examples=[{"level": "demonstrated", "evidence": "traces/husky.mcap"}],
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


def outside(
    value: float | str | None, domain: tuple[float | str, float | str] | None, key: str
) -> Iterator[Mistake]:
    """A plain number that is outside a domain of plain numbers."""
    if domain is None or not isinstance(value, float):
        return
    low, high = domain
    if (isinstance(low, float) and value < low) or (isinstance(high, float) and value > high):
        limits = f"[{_shown(low)}, {_shown(high)}]"
        yield Mistake(
            "S114", f"{number(value)} is outside the domain {limits}", "move one of them", (key,)
        )


def _shown(value: float | str) -> str:
    return quoted(value) if isinstance(value, str) else number(value)
