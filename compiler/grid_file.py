"""The values of a grid from a file beside the spec: .npy, or .csv with named columns."""

import math
from pathlib import Path

import numpy as np

from compiler.declare import Declarations
from compiler.ranges import range_of
from runtime.arrays import Array, frozen
from spec_schema.field_grid import Grid


def read_grid(path: Path, form: Grid, declared: Declarations, drives: tuple[str, ...]) -> Array:
    """The array (n1, ..., nd, m) in the user's units.

    Raises:
        ValueError, OSError, EOFError, IndexError: the file is not what the spec says.
    """
    if path.suffix == ".npy":
        return _read_npy(path)
    return _read_csv(path, form, declared, drives)


def _read_npy(path: Path) -> Array:
    # Mapped, so that a header that lies about the size is found out before memory is taken.
    try:
        data = np.load(path, mmap_mode="r", allow_pickle=False)
    except ValueError as error:
        raise ValueError("it is no array as numpy.save writes it") from error
    if not isinstance(data, np.ndarray):
        raise ValueError("it holds several arrays")  # noqa: TRY004  told like any wrong content
    if not np.issubdtype(data.dtype, np.number) or np.iscomplexobj(data):
        raise ValueError(f"it holds {data.dtype}, not numbers")
    return _finite(np.array(data, dtype=np.float64))


def _finite(data: Array) -> Array:
    if data.size == 0:
        raise ValueError("it is empty")
    if not np.isfinite(data).all():
        raise ValueError("it holds NaN or infinity")
    return data


def _read_csv(path: Path, form: Grid, declared: Declarations, drives: tuple[str, ...]) -> Array:
    """A table with a column for each variable of `over`, then one for each driven state.

    Its rows may stand in any order, one for each node.
    """
    rows = _csv_rows(path, [*form.over, *drives])
    nodes = _csv_nodes(rows, form, declared)
    index = []
    for column, (name, at) in enumerate(zip(form.over, nodes, strict=True)):
        nearest = np.abs(rows[:, column, None] - at).argmin(axis=1)
        off = np.abs(rows[:, column] - at[nearest]) > 1e-6 * (at[-1] - at[0])
        if off.any():
            raise ValueError(f"{name} = {rows[off.argmax(), column]:g} is none of the axis's nodes")
        index.append(nearest)
    shape = tuple(len(at) for at in nodes)
    place = np.ravel_multi_index(tuple(index), shape)
    if len(np.unique(place)) != len(rows) or len(rows) != math.prod(shape):
        raise ValueError(f"{len(rows)} rows don't fill a grid of {' x '.join(map(str, shape))}")
    values: Array = rows[place.argsort()][:, len(form.over) :].reshape(*shape, len(drives))
    return values


def _csv_rows(path: Path, wanted: list[str]) -> Array:
    """The numbers (rows, columns) below a header that must name the columns as wanted."""
    with path.open(encoding="utf-8") as file:
        header = [name.strip() for name in file.readline().split(",")]
        lines = [line for line in file if line.strip()]
    if header != wanted:
        raise ValueError(f"its header must be {','.join(wanted)} (got {','.join(header)})")
    if not lines:
        raise ValueError("it has no rows")
    return _finite(np.loadtxt(lines, delimiter=",", ndmin=2))


def _csv_nodes(rows: Array, form: Grid, declared: Declarations) -> tuple[Array, ...]:
    """The nodes that a .csv means: as the spec says, else evenly, as many as it has values."""
    found = []
    for column, name in enumerate(form.over):
        span = range_of(name, declared)
        scale = declared.variable(name).unit.scale
        count = len(np.unique(rows[:, column]))
        share = max(count if span.periodic else count - 1, 1)
        even = (span.low + (span.high - span.low) * np.arange(count) / share) / scale
        found.append(frozen(form.nodes.get(name, even)))
    return tuple(found)
