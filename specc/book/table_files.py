"""Tables as files: one of numpy's, and one of rows."""

import csv
import io
from collections.abc import Iterable

import numpy as np

from runtime.arrays import Array
from specc.book.tables import Sheet


def as_npz(sheets: Iterable[Sheet]) -> bytes:
    """All tables: `SETTING/QUANTITY`, with its `/axes`, `/unit`, and the nodes of each `/AXIS`."""
    arrays: dict[str, Array] = {}
    for sheet in sheets:
        key = f"{sheet.setting}/{sheet.quantity}"
        arrays[key] = sheet.grid.values
        arrays[f"{key}/axes"] = np.array(sheet.axes, dtype=np.str_)
        arrays[f"{key}/unit"] = np.array(sheet.unit)
        for name, nodes in zip(sheet.axes, sheet.grid.nodes, strict=True):
            arrays[f"{key}/{name}"] = nodes
    buffer = io.BytesIO()
    np.savez_compressed(buffer, **arrays)  # type: ignore[arg-type]
    return buffer.getvalue()


def as_csv(sheets: tuple[Sheet, ...]) -> bytes:
    """The same as one table: a row for each node; what does not matter to a quantity is empty."""
    names = tuple(dict.fromkeys(name for sheet in sheets for name in sheet.axes))
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["setting", "quantity", "unit", *names, "value"])
    for sheet in sheets:
        head = [sheet.setting, sheet.quantity, sheet.unit]
        places = [sheet.axes.index(name) if name in sheet.axes else -1 for name in names]
        written = [[f"{node:.9g}" for node in own] for own in sheet.grid.nodes]
        for index, value in zip(
            np.ndindex(sheet.grid.values.shape), sheet.grid.values.flat, strict=True
        ):
            row = ["" if k < 0 else written[k][index[k]] for k in places]
            writer.writerow([*head, *row, f"{value:.9g}"])
    return text.getvalue().encode()
