"""The forms in which a behavior's vector field can be written: exactly one of them per behavior."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Literal, Self, TypeAlias, final

from pydantic import ConfigDict, Field, RootModel, Strict, model_validator

from spec_schema.field_grid import Grid
from spec_schema.field_modes import Modes
from spec_schema.field_sketch import Sketch
from spec_schema.mistake import Mistake, refuse, repeated
from spec_schema.value_types import (
    Callee,
    Expression,
    Name,
    Names,
    Number,
    Quantity,
    StrictModel,
    Vector,
)
from spec_schema.wording import counted, listed, quoted


@final
class Formula(RootModel[Annotated[Mapping[Name, Expression], Field(min_length=1)]]):
    """The rate of each driven state as an expression of states, controls and constants."""

    model_config = ConfigDict(strict=True, frozen=True)

    @property
    def rates(self) -> Mapping[str, str]:
        """The expression of each driven state's rate; quantities with units, worked out in SI."""
        return self.root


@final
class Arrow(StrictModel):
    """One sketched vector."""

    at: Vector = Field(
        description="Where the arrow starts, one number for each name in `over`, in its unit.",
        examples=[[0, 1]],
    )
    go: Vector = Field(
        description="Where it points and how fast, one number for each name in `drives`, in its "
        "unit per second.",
        examples=[[0.5, 0]],
    )
    weight: Annotated[Number, Field(gt=0)] | None = Field(
        default=None,
        description="How much its squared misfit counts in `fill: least_squares`; without it, 1.",
        examples=[4],
    )


@final
class Arrows(StrictModel):
    """A sketched field: vectors at points, and how the space between them is filled."""

    over: Names = Field(
        description="The variables that the sketch is drawn over: its axes.", examples=[["x", "y"]]
    )
    drives: Names | None = Field(
        default=None,
        description="The driven states that the arrows move, in the order of `go`; without it, all "
        "driven states in the order in which they are declared.",
        examples=[["x", "y"]],
    )
    fill: Literal["thin_plate", "linear", "least_squares"] = Field(
        default="thin_plate",
        description="How the space between the arrows is filled: `thin_plate` bends smoothly "
        "through all arrows and continues beyond them; `linear` takes the triangle around a point; "
        "`least_squares` is the polynomial nearest to all arrows, for more of them than it takes.",
        examples=["linear"],
    )
    degree: Annotated[int, Field(ge=1, le=12)] | None = Field(
        default=None,
        description="Of `fill: least_squares`, the degree of the polynomial; along a periodic "
        "axis, the highest harmonic. Without it, the highest up to 3 that the arrows determine "
        "well: two arrows for each number.",
        examples=[2],
    )
    sketch: Annotated[tuple[Arrow, ...], Strict(strict=False), Field(min_length=1)] = Field(
        description="The arrows.", examples=[[{"at": [0, 1], "go": [0.5, 0]}]]
    )

    @model_validator(mode="after")
    def _arrows_fit(self) -> Self:
        refuse(self._mistakes())
        return self

    def _mistakes(self) -> Iterator[Mistake]:
        yield from repeated(self.over, "over")
        yield from repeated(self.drives or (), "drives")
        yield from self._fit_mistakes()
        for index, arrow in enumerate(self.sketch):
            lengths = [("at", arrow.at, "over", self.over), ("go", arrow.go, "drives", self.drives)]
            for key, vector, names_key, names in lengths:
                if names is not None and len(vector) != len(names):
                    count = counted(len(vector), "number")
                    message = f"{count} for {counted(len(names), 'name')} in '{names_key}'"
                    remedy = f"write one number for each of: {', '.join(names)}"
                    yield Mistake("S115", message, remedy, ("sketch", index, key))

    def _fit_mistakes(self) -> Iterator[Mistake]:
        """What only curve fitting reads, beside another fill."""
        if self.fill == "least_squares":
            return
        remedy = "write 'fill: least_squares', or remove it"
        if self.degree is not None:
            message = f"'fill: {self.fill}' has no degree: it goes through all arrows"
            yield Mistake("S234", message, remedy, ("degree",), on_key=True)
        for index, arrow in enumerate(self.sketch):
            if arrow.weight is not None:
                message = f"'fill: {self.fill}' weighs no arrows: it goes through all of them"
                yield Mistake("S234", message, remedy, ("sketch", index, "weight"), on_key=True)


@final
class Module(StrictModel):
    """A Python function of the user's, run by `specc compile` alone."""

    call: Callee = Field(
        description="The function, as `package.module:function`. It takes arrays by keyword, in SI "
        "units, and returns a dict of arrays: the rates in SI units per second.",
        examples=["my_robot.fields:avoid"],
    )
    over: Names | None = Field(
        default=None,
        description="The states and controls that the function takes; without it, all of them.",
        examples=[["x", "gain"]],
    )

    @model_validator(mode="after")
    def _names_differ(self) -> Self:
        refuse(repeated(self.over or (), "over"))
        return self


@final
class Step(StrictModel):
    """A discrete-time map: where the system is one step later."""

    every: Quantity = Field(
        description="The time of one step, a plain number in seconds.", examples=["0.1 s"]
    )
    next: Annotated[Mapping[Name, Expression], Field(min_length=1)] = Field(
        description="For each driven state its value one step later, as an expression.",
        examples=[{"x": "x + 0.1*v"}],
    )


Form: TypeAlias = Formula | Arrows | Grid | Module | Step | Modes | Sketch

FORMS = ("formula", "arrows", "grid", "module", "step", "modes", "sketch")


@final
class FieldSpec(StrictModel):
    """The vector field, in exactly one of its forms."""

    model_config = ConfigDict(json_schema_extra={"minProperties": 1, "maxProperties": 1})

    formula: Formula | None = Field(
        default=None,
        description="The rate of each driven state as an expression. Every name in it is a "
        "quantity with its unit, worked out in SI; the result must be of the kind of the state's "
        "unit per second.",
        examples=[{"x": "v", "v": "-k*x - d*v"}],
    )
    arrows: Arrows | None = Field(
        default=None,
        description="Vectors sketched at points; the compiler fills the space between them.",
        examples=[{"over": ["x", "y"], "sketch": [{"at": [0, 1], "go": [0.5, 0]}]}],
    )
    grid: Grid | None = Field(
        default=None,
        description="Rates at the nodes of a grid, inline or in a file.",
        examples=[{"over": ["x"], "values": {"x": [0.5, 0, -0.5]}}],
    )
    module: Module | None = Field(
        default=None,
        description="A Python function of your own, run at compile time.",
        examples=[{"call": "my_robot.fields:avoid"}],
    )
    step: Step | None = Field(
        default=None,
        description="A discrete-time map instead of rates: where the system is one step later.",
        examples=[{"every": "0.1 s", "next": {"x": "x + 0.1*v"}}],
    )
    modes: Modes | None = Field(
        default=None,
        description="A field for each value of a discrete state, and when one follows another.",
        examples=[{"of": "going", "each": {"on": {"formula": {"x": "v"}}}}],
    )

    sketch: Sketch | None = Field(
        default=None,
        description="Features drawn in a plane: closed orbits, attractors, repellers, saddles, "
        "separatrices. The compiler fills the rest, and adds what index theory requires.",
        examples=[{"over": ["x", "y"], "points": [{"is": "attractor", "at": [0, 0]}]}],
    )

    @property
    def form(self) -> Form:
        """The form that is given."""
        return self._given()[0][1]

    @model_validator(mode="after")
    def _has_one_form(self) -> Self:
        refuse(self._mistakes())
        return self

    def _given(self) -> tuple[tuple[str, Form], ...]:
        forms = ((name, getattr(self, name)) for name in FORMS)
        return tuple((name, form) for name, form in forms if form is not None)

    def _mistakes(self) -> Iterator[Mistake]:
        given = [name for name, _ in self._given()]
        if not given:
            message = "a field without a form"
            yield Mistake(
                "S113",
                message,
                f"add one of {listed(FORMS)}: 'formula: {{x: \"-k*x\"}}'",
                on_key=True,
            )
        for name in given[1:]:
            message = f"a field has exactly one form: {quoted(given[0])} and {quoted(name)} are two"
            yield Mistake("S113", message, "remove one of them", (name,), on_key=True)
