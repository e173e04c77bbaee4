"""The section that says which tables the book has of a behavior, and how they are read."""

from typing import Final

from specc.book.chapters import Block, Listing, Paragraph, Section, Table
from specc.book.contents import Drawn, Shown
from specc.book.gridded import PROBES
from specc.book.naming import Names
from specc.book.tables import Sheet
from specc.book.words.quantities import NOTHING, listed
from specc.figures.quantities import number

EXACT: Final = 1e-12
"""Of the largest value: less is the rounding of numbers."""


def data_section(of: Drawn, shown: Shown, names: Names) -> Section:
    """Which tables there are, over what, and how far they are from the program."""
    if not shown.sheets:
        return Section("The same as numbers", ())
    npz, text = names.data(of.architecture, shown.node)
    rows = tuple(_row(sheet) for sheet in shown.sheets)
    blocks: list[Block] = [
        Paragraph(
            f"[{text}]({text}) and [{npz}]({npz}) hold the field and the outputs as tables, in the"
            " spec's own units, for the values of the controls that this architecture sets."
            " Elsewhere the formulas count. Between the nodes go on linearly, each axis"
            " after the other, as [data/read_table.py](data/read_table.py) does in ten lines:"
        ),
        Listing(_example(npz, shown.sheets[0]), "python"),
        Table(("quantity", "setting", "over", "nodes", "unit", "off by at most"), rows, (3, 5)),
        Paragraph(
            "A discrete state is given as its index (0 for the first of its values). How far a"
            f" table is off was measured at {PROBES} random places; the share is of the largest"
            " value seen there. Beside a jump of the field a table is off by up to its height,"
            " within one interval of its nodes: there the formulas count.",
            is_small=True,
        ),
    ]
    return Section("The same as numbers", tuple(blocks))


def _row(sheet: Sheet) -> tuple[str, ...]:
    grid = sheet.grid
    nodes = " × ".join(str(len(own)) for own in grid.nodes) or "1"
    share = f" ({number(100.0 * grid.error / grid.size, 2)} %)" if grid.size > 0.0 else ""
    unit = NOTHING if sheet.unit in {"", "1"} else sheet.unit
    return (
        f"`{sheet.quantity}`",
        f"`{sheet.setting}`",
        listed((f"`{name}`" for name in sheet.axes), "constant"),
        nodes,
        unit,
        f"{number(grid.error, 2)}{share}" if grid.error > EXACT * grid.size else "rounding",
    )


def _example(npz: str, sheet: Sheet) -> str:
    """A call at a node of the table, and what it gives."""
    third = tuple(len(own) // 3 for own in sheet.grid.nodes)
    at = {n: own[k] for n, own, k in zip(sheet.axes, sheet.grid.nodes, third, strict=True)}
    places = ", ".join(f'"{name}": {value:.6g}' for name, value in at.items())
    file = npz.partition("/")[2]
    setting = "" if sheet.setting == "default" else f', "{sheet.setting}"'
    unit = "" if sheet.unit in {"", "1"} else f" {sheet.unit}"
    return (
        "# run in the folder data/ of this book\n"
        "from read_table import value\n\n"
        f'value("{file}", "{sheet.quantity}", {{{places}}}{setting})'
        f"  # {float(sheet.grid.values[third]):.6g}{unit}"
    )
