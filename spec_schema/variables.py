"""The models of a behavior's variables: states, control parameters, constants, outputs."""

from collections.abc import Iterator
from typing import Annotated, Literal, Self, final

from pydantic import Field, Strict, model_validator

from spec_schema.mistake import Mistake, refuse, repeated
from spec_schema.value_types import (
    Domain,
    Expression,
    Limits,
    Name,
    Quantity,
    StrictModel,
    Text,
    UnitText,
)
from spec_schema.wording import listed, number, quoted


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
        description="The rate of a sensed variable that is assumed when the behavior runs alone, "
        "with the dimension of its unit per second (for a step map: its next value).",
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
            role = "sensed and driven" if self.role == "both" else self.role
            message = f"a closure is for a variable that is only sensed; this one is {role}"
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


def outside(value: Quantity | None, domain: Limits | None, key: str) -> Iterator[Mistake]:
    """A plain number that is outside a domain of plain numbers."""
    if domain is None or not isinstance(value, float):
        return
    low, high = domain
    if (isinstance(low, float) and value < low) or (isinstance(high, float) and value > high):
        limits = f"[{_shown(low)}, {_shown(high)}]"
        yield Mistake(
            "S114", f"{number(value)} is outside the domain {limits}", "move one of them", (key,)
        )


def _shown(value: Quantity) -> str:
    return quoted(value) if isinstance(value, str) else number(value)
