"""The model of an arbiter: a control module that says which behaviors act."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Literal, Self, TypeAlias, final

from pydantic import Field, Strict, model_validator

from spec_schema.mistake import Mistake, refuse, repeated
from spec_schema.trace_mapping import TraceSpec
from spec_schema.value_types import (
    Callee,
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
from spec_schema.variables import ConstantSpec, ControlSpec, OutputSpec

PARADIGMS = (
    "rules",
    "subsumption",
    "weights",
    "competition",
    "plan",
    "module",
    "alcsr",
    "xcsr",
)


@final
class ReadSpec(StrictModel):
    """A quantity that the arbiter reads."""

    unit: UnitText | None = Field(
        default=None,
        description='Its unit; "1" for a number without one. A discrete one has none.',
        examples=["m"],
    )
    domain: Domain | None = Field(
        default=None, description="The lowest and the highest value.", examples=[[0, 5]]
    )
    kind: Literal["continuous", "periodic", "discrete"] = Field(
        default="continuous",
        description="Whether it is any number, wraps as an angle does, or is one of some values.",
        examples=["continuous"],
    )
    values: Annotated[tuple[Name, ...], Strict(strict=False), Field(min_length=1)] | None = Field(
        default=None, description="The values of a discrete one.", examples=[["open", "closed"]]
    )
    about: Text | None = Field(
        default=None, description="What it is.", examples=["distance to what is ahead"]
    )

    @model_validator(mode="after")
    def _parts_fit(self) -> Self:
        refuse(self._mistakes())
        return self

    def _mistakes(self) -> Iterator[Mistake]:
        wanted = ("values",) if self.kind == "discrete" else ("unit", "domain")
        for key in ("unit", "domain", "values"):
            given = getattr(self, key) is not None
            if given and key not in wanted:
                message = f"a {self.kind} quantity has no {key}"
                yield Mistake("S112", message, f"remove '{key}'", (key,), on_key=True)
            if not given and key in wanted:
                yield Mistake("S101", f"'{key}' is missing", f"add '{key}: ...'")


@final
class RuleSpec(StrictModel):
    """A rule, or a layer: what is chosen, and when."""

    choose: Name = Field(description="The choice.", examples=["avoid"])
    when: Expression | None = Field(
        default=None,
        description="When it is wanted: an expression of what is read; without it, always.",
        examples=["ahead < near"],
    )
    until: Expression | None = Field(
        default=None,
        description="Once it holds, it goes on until this does (hysteresis).",
        examples=["ahead > far"],
    )
    lasts: Quantity = Field(
        default=0.0, description="It holds for at least so long.", examples=["0.5 s"]
    )


@final
class CompetitionSpec(StrictModel):
    """Competing activations: a field of their own (Large, Christensen, Bajcsy 1999)."""

    advantage: Annotated[Mapping[Name, Expression], Field(min_length=1)] = Field(
        description="For each choice an expression from -1 to 1: how much the situation favors it.",
        examples=[{"seek": "1 - 2 * near", "avoid": "2 * near - 1"}],
    )
    suppresses: Mapping[Name, Mapping[Name, Expression]] = Field(
        default={},
        description="For a choice the choices that it suppresses, and how strongly.",
        examples=[{"avoid": {"seek": 2}}],
    )
    time: Quantity = Field(
        default="0.1 s", description="The time scale of the competition.", examples=["0.1 s"]
    )
    noise: Annotated[Number, Field(gt=0)] = Field(
        default=0.01,
        description="The noise that lets a choice leave the balance, per square root of a second.",
        examples=[0.01],
    )


Count: TypeAlias = Annotated[int, Field(ge=0)]


@final
class LearnedRuleSpec(StrictModel):
    """A rule that was learned: what is chosen in a box of what is read."""

    choose: Name = Field(description="The choice.", examples=["avoid"])
    when: Expression | None = Field(
        default=None,
        description="The box: comparisons of single reads with numbers in SI (without units), "
        "joined by `and`; of a discrete read, whether it is one of its values. Without it, always.",
        examples=["ahead < 0.31 and used > 0.5"],
    )
    right: Count = Field(
        default=0, description="How often its choice was right in training.", examples=[412]
    )
    wrong: Count = Field(
        default=0, description="How often its choice was wrong in training.", examples=[3]
    )


@final
class LearnedSpec(StrictModel):
    """What was learned: rules, and what is chosen where none of them holds."""

    otherwise: Name | None = Field(
        default=None,
        description="The choice where no rule holds; without it, the first of `choices`.",
        examples=["look"],
    )
    rules: Annotated[tuple[LearnedRuleSpec, ...], Strict(strict=False)] = Field(
        default=(),
        description="Written by `specc train`: the first rule that holds is chosen.",
        examples=[[{"choose": "avoid", "when": "ahead < 0.31", "right": 412, "wrong": 3}]],
    )


Rules: TypeAlias = Annotated[tuple[RuleSpec, ...], Strict(strict=False), Field(min_length=1)]


@final
class BySpec(StrictModel):
    """How the arbiter decides: exactly one paradigm."""

    rules: Rules | None = Field(
        default=None,
        description="Exclusive choice: the first rule that holds.",
        examples=[[{"choose": "avoid", "when": "ahead < near"}, {"choose": "seek"}]],
    )
    subsumption: Rules | None = Field(
        default=None,
        description="Layers, the highest first: on each channel the highest layer acts that wants "
        "to; it suppresses the layers below there, and nowhere else (Brooks 1986).",
        examples=[[{"choose": "avoid", "when": "ahead < near"}, {"choose": "wander"}]],
    )
    weights: Annotated[Mapping[Name, Expression], Field(min_length=1)] | None = Field(
        default=None,
        description="For each choice an expression of 0 or more: how much it counts in a blend.",
        examples=[{"seek": "1 - near", "avoid": "near"}],
    )
    competition: CompetitionSpec | None = Field(
        default=None,
        description="A dynamical system in which choices compete.",
        examples=[{"advantage": {"seek": "1", "avoid": "2 * near - 1"}}],
    )
    plan: Text | None = Field(
        default=None,
        description="A behavior with modes, one level up: its mode is the choice, and its sensed "
        "states are what is read. A path from this file.",
        examples=["errand.yaml"],
    )
    module: Callee | None = Field(
        default=None,
        description="A Python function of yours; it is run only where you allow it.",
        examples=["arbiters:choose"],
    )

    alcsr: LearnedSpec | None = Field(
        default=None,
        description="Rules that `specc train` learns by ALCSR (thesis, section 4).",
        examples=[{"otherwise": "look"}],
    )
    xcsr: LearnedSpec | None = Field(
        default=None,
        description="Rules that `specc train` learns by XCSR (Wilson 2000).",
        examples=[{"otherwise": "look"}],
    )

    @model_validator(mode="after")
    def _is_one(self) -> Self:
        given = [key for key in PARADIGMS if getattr(self, key) is not None]
        if len(given) != 1:
            what = " and ".join(given) if given else "nothing"
            message = f"an arbiter decides in one way; this one by {what}"
            refuse([Mistake("S314", message, f"write one of: {', '.join(PARADIGMS)}", on_key=True)])
        return self


@final
class AgreementSpec(StrictModel):
    """What it means that a robot decides as the spec says."""

    share: Annotated[Number, Field(gt=0, le=1)] = Field(
        default=0.98,
        description="The share of its decisions that must agree, above 0 and at most 1.",
        examples=[0.98],
    )


@final
class ArbiterSpec(StrictModel):
    """An arbiter: what it reads, what it may choose, and how it decides."""

    specc: Version = Field(description="The version of the language: 1.", examples=[1])
    kind: Literal["arbiter"] = Field(description="What the file describes.", examples=["arbiter"])
    name: Identifier = Field(description="The arbiter's name.", examples=["keep_left"])
    about: Text | None = Field(
        default=None, description="What it does, in a sentence.", examples=["Avoid first."]
    )
    reads: Mapping[Name, ReadSpec] = Field(
        default={},
        description="The quantities that it reads.",
        examples=[{"ahead": {"unit": "m", "domain": [0, 2]}}],
    )
    control: Mapping[Name, ControlSpec] = Field(
        default={},
        description="What a module above it can set.",
        examples=[{"near": {"unit": "m", "domain": [0.1, 1], "default": 0.3}}],
    )
    constants: Mapping[Name, ConstantSpec] = Field(
        default={},
        description="Named numbers with units.",
        examples=[{"near": {"value": 0.3, "unit": "m"}}],
    )
    output: Mapping[Name, OutputSpec] = Field(
        default={},
        description="What it tells others: expressions of what it reads.",
        examples=[{"urgent": {"unit": "1", "is": "ahead < near"}}],
    )
    choices: Annotated[tuple[Name, ...], Strict(strict=False), Field(min_length=1)] = Field(
        description="What it can choose. What a choice means is said by the architecture.",
        examples=[["seek", "avoid"]],
    )
    by: BySpec = Field(
        description="How it decides.",
        examples=[{"rules": [{"choose": "avoid", "when": "ahead < near"}, {"choose": "seek"}]}],
    )
    agreement: AgreementSpec = Field(
        default_factory=AgreementSpec,
        description='What "the robot decides so" means.',
        examples=[{"share": 0.98}],
    )
    trace: Mapping[Name, TraceSpec] = Field(
        default={},
        description="Where what it reads, and its `choice`, stand in a log.",
        examples=[{"ahead": "front", "choice": {"path": "action", "values": ["seek", "avoid"]}}],
    )
    judge_when: Expression | None = Field(
        default=None,
        description="When its decisions are judged: an expression of what it reads and of signals.",
        examples=["not intervention"],
    )

    @model_validator(mode="after")
    def _choices_fit(self) -> Self:
        refuse(self._mistakes())
        return self

    def _mistakes(self) -> Iterator[Mistake]:
        yield from repeated(self.choices, "choices")
        if "choice" in {*self.reads, *self.control, *self.constants, *self.output}:
            message = "'choice' is what the arbiter chose, and can name nothing else"
            yield Mistake("S109", message, "take another name")
