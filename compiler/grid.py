"""A field given as a lookup array: its sampler, and its own table where the nodes allow it."""

import math
from pathlib import Path as FilePath

import numpy as np

from compiler.declare import Declarations
from compiler.findings import Findings
from compiler.grid_file import read_grid
from compiler.lattice import between_nodes, closed, is_even
from compiler.ranges import Range, range_of, scales
from compiler.tabulate import Sampler
from runtime.arrays import Array, frozen
from runtime.interpolation import lookup, tabulate
from runtime.table import Axis, Method, Table
from spec_schema.behavior import BehaviorSpec
from spec_schema.field_grid import Grid


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
    values = given * scales(drives, declared)
    ranges = [range_of(name, declared) for name in form.over]
    nodes = _grid_nodes(form, values.shape, ranges, declared, findings)
    if nodes is None:
        return None, None
    return _between(form, spec, values, nodes, ranges)


def grid_shares(
    form: Grid, spec: BehaviorSpec, declared: Declarations, findings: Findings
) -> Sampler:
    """How much each of N nodes counts at places (P, d), the last axis fastest.

    The values must be inline and fit, as `grid_sampler` tests.
    """
    assert form.values, "the values are inline"
    shape = next(iter(form.values.values())).shape
    ranges = [range_of(name, declared) for name in form.over]
    nodes = _grid_nodes(form, (*shape, 1), ranges, declared, findings)
    assert nodes is not None, "the nodes were tested before"
    count = math.prod(shape)
    return _between(form, spec, np.eye(count).reshape(*shape, count), nodes, ranges)[0]


def _between(
    form: Grid,
    spec: BehaviorSpec,
    values: Array,
    nodes: tuple[Array, ...],
    ranges: list[Range],
) -> tuple[Sampler, Table | None]:
    """What is between the nodes; its own table, too, where they are those of a table."""
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
        data = read_grid(path, form, declared, drives)
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
