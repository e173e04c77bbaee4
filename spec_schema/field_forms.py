"""The forms in which a behavior's vector field can be written: exactly one of them per behavior."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Literal, Self, TypeAlias, final

from pydantic import ConfigDict, Field, RootModel, Strict, model_validator

from spec_schema.field_modes import Modes
from spec_schema.field_sketch import Sketch
from spec_schema.grid_values import Nested
from spec_schema.mistake import Mistake, refuse
from spec_schema.value_types import (
    Callee,
    Expression,
    Name,
    Names,
    Number,
    Quantity,
    StrictModel,
    Text,
)
from spec_schema.wording import counted, listed, quoted

Vector: TypeAlias = Annotated[tuple[Number, ...], Strict(strict=False), Field(min_length=1)]


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
class Grid(StrictModel):
    """Rates given at the nodes of a grid, inline or in a file beside the spec."""

    over: Names = Field(
        description="The variables of the grid's axes, the slowest first.", examples=[["x", "v"]]
    )
    drives: Names | None = Field(
        default=None,
        description="The driven states that the grid moves; without it, all driven states in the "
        "order in which they are declared. In a file they are the last axis (.npy) or the columns "
        "after those of `over` (.csv).",
        examples=[["x", "v"]],
    )
    values: Annotated[Mapping[Name, Nested], Field(min_length=1)] | None = Field(
        default=None,
        description="For each driven state its rate at each node, in its unit per second: nested "
        "lists, one level for each name in `over`.",
        examples=[{"x": [[0, 1], [0, 1]]}],
    )
    file: Text | None = Field(
        default=None,
        description="A .npy or .csv file beside the spec that holds the values instead.",
        examples=["field.npy"],
    )
    nodes: Mapping[Name, Vector] = Field(
        default={},
        description="Where the nodes stand on an axis, increasing, in its unit; without it, evenly "
        "over the domain.",
        examples=[{"x": [-2, -1, 0, 2]}],
    )
    between: Literal["cubic", "linear"] = Field(
        default="cubic",
        description="What holds between the nodes: a twice differentiable spline, or straight "
        "lines.",
        examples=["linear"],
    )

    @model_validator(mode="after")
    def _values_fit(self) -> Self:
        refuse(self._mistakes())
        return self

    def _mistakes(self) -> Iterator[Mistake]:
        yield from repeated(self.over, "over")
        yield from repeated(self.drives or (), "drives")
        yield from self._source_mistakes()
        yield from self._node_mistakes()
        yield from self._shape_mistakes()

    def _source_mistakes(self) -> Iterator[Mistake]:
        if self.values is None and self.file is None:
            yield Mistake(
                "S116",
                "a grid without values",
                "add 'values: {x: [...]}' or 'file: field.npy'",
                on_key=True,
            )
        if self.values is not None and self.file is not None:
            message = "a grid has its values inline or in a file, not both"
            yield Mistake("S116", message, "remove 'values' or 'file'", ("file",), on_key=True)
        if self.file is not None and not self.file.endswith((".npy", ".csv")):
            message = f"a grid's file is a .npy or a .csv file, not {quoted(self.file)}"
            yield Mistake(
                "S116", message, "save it with numpy.save, or as a table of numbers", ("file",)
            )

    def _node_mistakes(self) -> Iterator[Mistake]:
        for name, nodes in self.nodes.items():
            if name not in self.over:
                message = f"{quoted(name)} is no axis of this grid"
                yield Mistake(
                    "S116",
                    message,
                    f"its axes: {', '.join(self.over)}",
                    ("nodes", name),
                    on_key=True,
                )
            for index in range(1, len(nodes)):
                if nodes[index] <= nodes[index - 1]:
                    message = (
                        f"the nodes do not increase: {nodes[index]:g} after {nodes[index - 1]:g}"
                    )
                    yield Mistake("S111", message, "sort them, each once", ("nodes", name, index))
            if len(nodes) < 2:
                yield Mistake("S115", "an axis has at least two nodes", at=("nodes", name))

    def _shape_mistakes(self) -> Iterator[Mistake]:
        shapes = {name: given.shape for name, given in (self.values or {}).items()}
        first = next(iter(shapes), "")
        for name, shape in shapes.items():
            at = ("values", name)
            if len(shape) != len(self.over):
                message = (
                    f"{counted(len(shape), 'level')} of lists for {counted(len(self.over), 'axis')}"
                )
                yield Mistake("S115", message, "one level for each axis, the slowest outside", at)
            elif shape != shapes[first]:
                message = f"{_size(shape)} values here, {_size(shapes[first])} of {quoted(first)}"
                yield Mistake("S115", message, "all values of a grid stand at the same nodes", at)
            else:
                yield from self._count_mistakes(shape, at)

    def _count_mistakes(self, shape: tuple[int, ...], at: tuple[str, ...]) -> Iterator[Mistake]:
        for axis, count in zip(self.over, shape, strict=True):
            if count < 2:
                yield Mistake(
                    "S115", f"the axis {quoted(axis)} has {count} value; it has at least two", at=at
                )
            elif axis in self.nodes and len(self.nodes[axis]) != count:
                message = f"{count} values for the {len(self.nodes[axis])} nodes of {quoted(axis)}"
                yield Mistake("S115", message, "write one value for each node", at)


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


def repeated(names: tuple[str, ...], key: str) -> Iterator[Mistake]:
    """The names that stand twice in the list under `key`."""
    seen: set[str] = set()
    for index, name in enumerate(names):
        if name in seen:
            message = f"{quoted(name)} stands twice in '{key}'"
            yield Mistake("S112", message, "remove one", (key, index))
        seen.add(name)


def _size(shape: tuple[int, ...]) -> str:
    return " x ".join(map(str, shape))
