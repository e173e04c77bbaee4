"""The samplers of fields that are given by numbers: arrows at points, and arrays on grids."""

import math
from pathlib import Path as FilePath

import numpy as np

from compiler.declare import Declarations
from compiler.findings import Findings
from compiler.lattice import between_nodes, closed, is_even
from compiler.scattered import SketchError, piecewise_linear, reaches_beyond, thin_plate
from compiler.tabulate import Range, Sampler
from runtime.arrays import Array, frozen
from runtime.interpolation import lookup, tabulate
from runtime.program import Axis, Kind, Method, State, Table
from spec_schema.behavior import BehaviorSpec
from spec_schema.field_forms import Arrows, Grid


def range_of(name: str, declared: Declarations, fixed: int | None = None) -> Range:
    """The axis of a table over the variable."""
    part = declared.variable(name)
    periodic = isinstance(part, State) and part.kind is Kind.PERIODIC
    return Range(name, part.low, part.high, periodic, fixed)


def arrows_sampler(
    form: Arrows, declared: Declarations, drives: tuple[str, ...], findings: Findings
) -> Sampler | None:
    """The field through the arrows, with a warning where the sketch does not reach."""
    if not _sizes_fit(form, drives, findings):
        return None
    at = frozen([arrow.at for arrow in form.sketch]) * _scales(form.over, declared)
    go = frozen([arrow.go for arrow in form.sketch]) * _scales(drives, declared)
    ranges = [range_of(name, declared) for name in form.over]
    low, high = frozen([r.low for r in ranges]), frozen([r.high for r in ranges])
    outside = np.any((at < low) | (at > high), axis=1)
    if outside.any():
        index = int(np.argmax(outside))
        message = "this arrow starts outside the domain"
        findings.error(
            "S234",
            ("field", "arrows", "sketch", index, "at"),
            message,
            "move it inside, or widen the domain",
        )
        return None
    periodic = tuple(span.periodic for span in ranges)
    try:
        if form.fill == "thin_plate":
            sample = thin_plate(at, go, low, high, periodic)
        else:
            sample = piecewise_linear(*_wrapped(at, go, ranges))
        beyond = reaches_beyond(*_wrapped(at, go, ranges)[:1], low, high)
    except SketchError as error:
        findings.error("S234", ("field", "arrows", "sketch"), error.message, error.remedy)
        return None
    if beyond is not None:
        findings.warning(
            "S224",
            ("field", "arrows", "sketch"),
            f"the domain of '{form.over[beyond]}' reaches beyond the hull of the sketch, where the "
            "field is a guess",
            "sketch arrows at the corners of the domain, or shrink the domain",
        )
    return sample


def grid_sampler(
    form: Grid,
    spec: BehaviorSpec,
    declared: Declarations,
    drives: tuple[str, ...],
    beside: FilePath,
    findings: Findings,
) -> tuple[Sampler | None, Table | None]:
    """The field of a lookup array; its own table, too, where its nodes are those of a table."""
    given = _grid_values(form, declared, drives, beside, findings)
    if given is None:
        return None, None
    values = given * _scales(drives, declared)
    ranges = [range_of(name, declared) for name in form.over]
    nodes = _grid_nodes(form, values.shape, ranges, declared, findings)
    if nodes is None:
        return None, None
    method = Method(form.between)
    even = all(
        is_even(at, r.low, r.high, periodic=r.periodic) for at, r in zip(nodes, ranges, strict=True)
    )
    if even and not spec.table.nodes:
        axes = tuple(
            Axis(r.name, r.low, r.high, len(at), r.periodic)
            for at, r in zip(nodes, ranges, strict=True)
        )
        table = tabulate(values, axes, method)
        return (lambda points: lookup(table, points)), table
    periodic = tuple(span.periodic for span in ranges)
    highs = tuple(span.high for span in ranges)
    return between_nodes(*closed(nodes, values, periodic, highs), method, periodic), None


def _scales(names: tuple[str, ...], declared: Declarations) -> Array:
    return frozen([declared.variable(name).unit.scale for name in names])


def _sizes_fit(form: Arrows, drives: tuple[str, ...], findings: Findings) -> bool:
    fits = True
    for i, arrow in enumerate(form.sketch):
        if len(arrow.go) != len(drives) or len(arrow.at) != len(form.over):
            fits = False
            if form.drives is None and len(arrow.go) != len(drives):
                message = f"'go' has {len(arrow.go)} numbers for {len(drives)} driven states"
                remedy = f"write one for each of {', '.join(drives)}"
                findings.error("S234", ("field", "arrows", "sketch", i, "go"), message, remedy)
    return fits


def _wrapped(at: Array, go: Array, ranges: list[Range]) -> tuple[Array, Array]:
    """The sketch with a copy on either side of every periodic axis, so that its ends meet."""
    for i, span in enumerate(ranges):
        if span.periodic:
            turn = np.zeros(len(ranges))
            turn[i] = span.high - span.low
            at = np.concatenate([at - turn, at, at + turn])
            go = np.concatenate([go, go, go])
            at, kept = np.unique(at, axis=0, return_index=True)
            go = go[kept]
    return at, go


def _grid_values(
    form: Grid,
    declared: Declarations,
    drives: tuple[str, ...],
    beside: FilePath,
    findings: Findings,
) -> Array | None:
    """The array (n1, ..., nd, m) in the user's units."""
    base = ("field", "grid")
    if form.values is not None:
        unlike = [name for name in form.values if name not in drives]
        missing = [name for name in drives if name not in form.values]
        for name in unlike:
            findings.error(
                "S205",
                (*base, "values", name),
                f"'{name}' is no driven state",
                f"the driven states: {', '.join(drives)}",
                key=True,
            )
        if missing:
            findings.error(
                "S204",
                (*base, "values"),
                f"the grid gives no rate for '{missing[0]}'",
                f"add `{missing[0]}: [...]`",
                key=True,
            )
        if unlike or missing:
            return None
        given = [form.values[name] for name in drives]
        return np.stack([frozen(g.numbers).reshape(g.shape) for g in given], axis=-1)
    path = beside / str(form.file)
    try:
        if path.suffix == ".npy":
            data = _read_npy(path)
        else:
            data = _read_csv(path, form, drives, _csv_nodes(path, form, declared))
    except (OSError, ValueError, EOFError, IndexError) as error:
        why = str(error.strerror).lower() if isinstance(error, OSError) else error
        message = f"{form.file} can't be used: {why}"
        axes = ", ".join(form.over)
        remedy = f"it needs an axis for each of {axes}, and a last one for {', '.join(drives)}"
        findings.error("S232", (*base, "file"), message, remedy)
        return None
    if data.ndim != len(form.over) + 1 or data.shape[-1] != len(drives):
        shape = " x ".join(map(str, data.shape))
        message = (
            f"{form.file} is {shape}; it must have {len(form.over)} axes and {len(drives)} columns"
        )
        findings.error(
            "S231",
            (*base, "file"),
            message,
            f"axes: {', '.join(form.over)}; columns: {', '.join(drives)}",
        )
        return None
    return data


def _read_npy(path: FilePath) -> Array:
    # Mapped, so that a header that lies about the size is found out before memory is taken.
    data = np.load(path, mmap_mode="r", allow_pickle=False)
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


def _read_csv(
    path: FilePath, form: Grid, drives: tuple[str, ...], nodes: tuple[Array, ...]
) -> Array:
    """A table with a column for each variable of `over`, then one for each driven state.

    Its rows may stand in any order, one for each node; `nodes` are where the user's spec has them.
    """
    with path.open(encoding="utf-8") as file:
        header = [name.strip() for name in file.readline().split(",")]
        lines = [line for line in file if line.strip()]
    wanted = [*form.over, *drives]
    if header != wanted:
        raise ValueError(f"its header must be {','.join(wanted)} (got {','.join(header)})")
    if not lines:
        raise ValueError("it has no rows")
    rows = _finite(np.loadtxt(lines, delimiter=",", ndmin=2))
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


def _csv_nodes(path: FilePath, form: Grid, declared: Declarations) -> tuple[Array, ...]:
    """The nodes that a .csv means: as the spec says, else evenly, as many as it has values."""
    with path.open(encoding="utf-8") as file:
        file.readline()
        lines = [line for line in file if line.strip()]
    rows = np.loadtxt(lines, delimiter=",", ndmin=2) if lines else np.zeros((0, len(form.over)))
    found = []
    for column, name in enumerate(form.over):
        span = range_of(name, declared)
        scale = declared.variable(name).unit.scale
        count = len(np.unique(rows[:, column])) if column < rows.shape[1] else 0
        share = max(count if span.periodic else count - 1, 1)
        even = (span.low + (span.high - span.low) * np.arange(count) / share) / scale
        found.append(frozen(form.nodes.get(name, even)))
    return tuple(found)


def _grid_nodes(
    form: Grid,
    shape: tuple[int, ...],
    ranges: list[Range],
    declared: Declarations,
    findings: Findings,
) -> tuple[Array, ...] | None:
    """The nodes of each axis in SI; evenly over the domain where none are given."""
    found = []
    least = 4 if form.between == "cubic" else 2
    for name, count, span in zip(form.over, shape, ranges, strict=False):
        given = form.nodes.get(name)
        if count < least:
            message = f"'{name}' has {count} nodes, and {form.between} needs {least}"
            findings.error(
                "S231",
                ("field", "grid"),
                message,
                "give more nodes, or write `between: linear`",
                key=True,
            )
            return None
        if given is None:
            share = count if span.periodic else count - 1
            found.append(span.low + (span.high - span.low) * np.arange(count) / share)
            continue
        at = frozen(given) * declared.variable(name).unit.scale
        slack = 1e-9 * (span.high - span.low)
        if span.periodic:
            if len(at) == count and abs(at[0] - span.low) <= slack and at[-1] < span.high - slack:
                found.append(at)
                continue
            message = f"the nodes of '{name}' must begin at its lower end and stop before the upper"
            remedy = "leave the upper end out: there the lower one comes again"
            findings.error("S231", ("field", "grid", "nodes", name), message, remedy)
            return None
        at[[0, -1]] = [
            edge if abs(node - edge) <= slack else node
            for node, edge in zip(at[[0, -1]], (span.low, span.high), strict=True)
        ]
        if len(at) != count or at[0] > span.low or at[-1] < span.high:
            message = f"the nodes of '{name}' must reach from one end of its domain to the other"
            findings.error(
                "S231",
                ("field", "grid", "nodes", name),
                message,
                "add nodes at the ends, or shrink the domain",
            )
            return None
        found.append(at)
    return tuple(found)
