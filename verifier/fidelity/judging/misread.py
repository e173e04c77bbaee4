"""Angles that were logged in another unit than they are read in.

Of an angle that goes round no value is outside, since a log may count its turns. But it then turns
step by step, and about as fast as its field; one in degrees for radians leaps where it goes round,
by far more than a turn, or moves many times as fast.
"""

from collections.abc import Iterator
from typing import Final

import numpy as np

from runtime.arrays import Array
from runtime.flow import flow_of, rates
from runtime.program import Kind, Program, State
from verifier.fidelity.judging.outside import (
    Outside,
    other_readings,
    own_binding,
    told_outside,
)
from verifier.fidelity.judging.verdict import Finding, with_outside
from verifier.fidelity.stretches.needs import Needs, held, parts_of, period_of
from verifier.fidelity.stretches.segments import GAP_PERIODS, GAP_SECONDS, on_circle
from verifier.report.report import Verdict
from verifier.traces.trace import Series

LEAST: Final = 0.05
"""An angle is looked at of which this share lies beyond its range,"""
MOST: Final = 0.95
"""and this one within it, read in another unit."""
LEAP: Final = 1.5
"""Turns between two samples: an angle whose turns are counted makes less than one."""
SWIFT: Final = 10.0
"""Times as fast as the field ever is: no robot; and degrees are 57 radians."""
PLACES: Final = 256
"""Of the trace, at which the field is asked."""


def turned_in_another_unit(program: Program, needs: Needs) -> Finding | None:
    """What leaves the verdict open where an angle is read in another unit than it was logged in."""
    found = tuple(_misread(program, needs))
    return with_outside(Finding(Verdict.INCONCLUSIVE, (), ()), found) if found else None


def _misread(program: Program, needs: Needs) -> Iterator[Outside]:
    bindings = {binding.name: binding for binding in program.bindings}
    driven = zip((state.name for state in needs.driven), needs.series, strict=True)
    told = ((each.name, each.series) for each in needs.inputs if each.series is not None)
    parts = parts_of(program)
    for name, series in (*driven, *told):
        part, values = parts[name], series.logged
        if values is None or not isinstance(part, State) or part.kind is not Kind.PERIODIC:
            continue
        share = float(np.mean((values < part.low) | (values > part.high)))
        binding = bindings.get(name) or own_binding(part, series.path)
        for _, _, read in other_readings(part, binding, values):
            is_inside = np.mean((read >= part.low) & (read <= part.high)) >= MOST
            if share >= LEAST and is_inside and _is_strange(program, needs, part, series, read):
                yield told_outside(part, series, values, share, bindings.get(name))
                break


def _is_strange(program: Program, needs: Needs, part: State, series: Series, read: Array) -> bool:
    """Whether the angle leaps, or is many times as fast as its field.

    read: what is logged, in the other unit.
    """
    values, width = series.logged, part.high - part.low
    assert values is not None, "only what was logged beyond its range is looked at"
    if leaps(series, width):
        return True
    if not part.is_driven or program.fidelity is None or len(values) < 2:
        return False
    stride = max(1, round(program.fidelity.horizon / period_of(series.times)))
    turned = np.unwrap(read, period=width)[::stride]
    span = np.diff(series.times[::stride])
    scale = float(np.median(values[values != 0.0] / read[values != 0.0]))
    speeds = np.abs(np.diff(turned)) * scale / span
    return speeds.size > 0 and bool(speeds.max() > SWIFT * _fastest(program, needs, part))


def leaps(series: Series, width: float) -> bool:
    """Whether an angle goes on by more than a whole turn from one sample to the next."""
    if series.logged is None:
        return False
    near = np.diff(series.times) <= max(GAP_PERIODS * period_of(series.times), GAP_SECONDS)
    return bool(np.any(np.abs(np.diff(series.logged))[near] > LEAP * width))


def _fastest(program: Program, needs: Needs, part: State) -> float:
    """The largest rate that the field gives an angle in the trace; infinite where it gives none."""
    flow = flow_of(program)
    if flow.is_map:
        return float("inf")
    base = needs.series[needs.base].times
    times = base[:: max(1, len(base) // PLACES)]
    columns: dict[str, Array] = {}
    for state, series in zip(needs.driven, needs.series, strict=True):
        columns[state.name] = on_circle(state, held(series, times))
    for each in needs.inputs:
        if each.series is not None:
            columns[each.name] = on_circle(parts_of(program)[each.name], held(each.series, times))
    states = [_column(each.name, each.hold, columns, times) for each in program.states]
    controls = [_column(each.name, each.default, columns, times) for each in program.controls]
    x = np.stack(states, axis=-1)
    u = np.stack(controls, axis=-1) if controls else np.zeros((len(times), 0))
    place = [state.name for state in program.states].index(part.name)
    fastest = float(np.nanmax(np.abs(rates(flow, x, u)[:, place]), initial=0.0))
    return fastest or float("inf")


def _column(name: str, usual: float, columns: dict[str, Array], times: Array) -> Array:
    return columns.get(name, np.full(len(times), usual))
