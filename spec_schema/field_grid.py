"""A field given by its rates at the nodes of a grid."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Literal, Self, final

from pydantic import Field, model_validator

from spec_schema.grid_values import Nested
from spec_schema.mistake import Mistake, refuse, repeated
from spec_schema.value_types import Name, Names, StrictModel, Text, Vector
from spec_schema.wording import counted, quoted


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


def _size(shape: tuple[int, ...]) -> str:
    return " x ".join(map(str, shape))
