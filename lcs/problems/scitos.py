"""A real robot's arbiter: which of four actions a SCITOS-G5 takes, following walls.

"Wall-Following Robot Navigation Data", UCI Machine Learning Repository (Freire, Veloso and Barreto
2010), CC BY 4.0; `recordings/README.md` tells more.
"""

import dataclasses
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Final

import numpy as np

from lcs.inputs import Input
from lcs.problems.csv_table import read_table
from lcs.problems.table import Table

RANGES: Final = Path(__file__).parent / "recordings" / "scitos_ultrasound.csv"

ARCS: Final[Mapping[str, slice]] = {
    "front": slice(10, 15),
    "left": slice(17, 20),
    "right": slice(4, 9),
    "back": slice(22, 24),
}
"""Which of the 24 ranges an arc is the least of."""

ALL: Final = 24


def scitos(inputs: int) -> Table:
    """The recording with so many inputs: 2 (front and left), 4 (the arcs) or all 24 ranges."""
    table = dataclasses.replace(_recorded(), name=f"scitos_{inputs}")
    if inputs == ALL:
        described = tuple(dataclasses.replace(each, unit="m") for each in table.described)
        return dataclasses.replace(table, described=described)
    arcs = dict(list(ARCS.items())[:inputs])
    x = np.stack([table.x[:, those].min(axis=1) for those in arcs.values()], axis=1)
    described = tuple(
        Input(name, "m", float(column.min()), float(column.max()))
        for name, column in zip(arcs, x.T, strict=True)
    )
    return dataclasses.replace(table, described=described, x=x)


@cache
def _recorded() -> Table:
    """All rows; the file is read once, and its numbers can't be changed."""
    table = read_table(RANGES)
    for values in (table.x, table.right):
        values.setflags(write=False)
    return table
