"""Results as text for people and as records for programs, in the user's units."""

import hashlib
import math
from pathlib import Path

from compiler.compile import Compiled
from compiler.quantities import rate_text
from runtime.arrays import Array
from runtime.integrators import MOST_STEPS
from runtime.program import Kind, Program, State, Unit
from runtime.rollout import Ending, Rollout
from runtime.table import Table


def compile_record(compiled: Compiled, path: Path, artifact: bytes) -> dict[str, object]:
    """What `specc compile --format json` prints: a row for each table and rate that it serves.

    Bounds and tolerances are of the whole rate, in the user's unit per second.
    """
    program = compiled.program
    field = program.field
    scale = {state.name: state.unit.scale for state in program.states}
    rows: list[dict[str, object]] = []
    for index, table in enumerate(field.tables):
        served = sorted({t.component for t in field.terms if t.table == index})
        for component in served:
            bound, name = field.bounds[component], field.driven[component]
            rows.append(
                {
                    "field": name,
                    "axes": [axis.name for axis in table.axes],
                    "shape": [axis.count for axis in table.axes],
                    "method": str(table.method),
                    "error_bound": bound.measured / scale[name],
                    "tolerance": bound.tolerance / scale[name],
                    "bytes": table.coefficients.nbytes,
                }
            )
    digest = hashlib.sha256(artifact).hexdigest()
    return {"artifact": str(path), "sha256": digest, "tables": rows, "notes": list(compiled.notes)}


def compile_summary(compiled: Compiled) -> str:
    """What the compiler chose and added, and how good it is."""
    program = compiled.program
    field = program.field
    lines = [f"{program.name}: {field.form} field of {', '.join(field.driven)}"]
    lines += [f"  table over {_table(table)}" for table in field.tables]
    if not field.terms:
        lines.append("  kept as code: no tables")
    for name, bound in zip(field.driven, field.bounds, strict=False):
        state = next(s for s in program.states if s.name == name)
        unit = state.unit.text if field.is_map else rate_text(state.unit.text)
        scale = state.unit.scale
        lines.append(
            f"  {name}: off by at most {bound.measured / scale:.2e} {unit} "
            f"(allowed {bound.tolerance / scale:.2e}; measured on {bound.points:,} points)"
        )
    lines += [f"  {note}" for note in compiled.notes]
    written = sum(not claim.sketched for claim in program.claims)
    if written:
        claims = f"{written} claim{'' if written == 1 else 's'}"
        lines.append(f"  {claims} not checked: run `specc check --claims {program.source.file}`")
    return "\n".join(lines)


def _table(table: Table) -> str:
    axes = " x ".join(f"{axis.name}[{axis.count}]" for axis in table.axes)
    return f"{axes}, {table.method}, {table.coefficients.nbytes:,} bytes"


def rollout_record(program: Program, rollout: Rollout) -> dict[str, object]:
    """A run as numbers, in the spec's own units; None after its end."""
    return {
        "behavior": program.name,
        "times": rollout.times.tolist(),
        "states": {
            s.name: _column(rollout.states[:, i], s.unit) for i, s in enumerate(program.states)
        },
        "controls": {
            c.name: float(f"{rollout.controls[i] / c.unit.scale:.15g}")
            for i, c in enumerate(program.controls)
        },
        "outputs": {
            o.name: _column(rollout.outputs[:, i], o.unit) for i, o in enumerate(program.outputs)
        },
        "ending": str(rollout.ending),
        "ended_at": float(rollout.ended_at),
        "detail": rollout.detail,
        "switches": _switches(program, rollout),
    }


def _switches(program: Program, rollout: Rollout) -> list[dict[str, object]]:
    """When the mode changed, and from what to what."""
    values = next((s.values for s in program.states if s.name == program.field.mode), ())
    found = rollout.switches
    return [
        {"t": float(time), "from": values[left], "to": values[entered]}
        for time, left, entered in zip(found.times, found.left, found.entered, strict=True)
    ]


def _column(values: Array, unit: Unit) -> list[float | None]:
    return [v / unit.scale if math.isfinite(v) else None for v in values.tolist()]


def incomplete(program: Program, rollout: Rollout) -> str:
    """What to do about a run that took more steps than one may have; empty for any other."""
    if rollout.ending is not Ending.TOO_MANY_STEPS:
        return ""
    end = float(rollout.ended_at)
    start = " ".join(
        f"--start {state.name}={_spelled(state, value)}"
        for state, value in zip(program.states, rollout.ended_in.tolist(), strict=True)
    )
    return (
        f"incomplete: {MOST_STEPS:,} steps reach {end:.6g} s, not {float(rollout.times[-1]):.6g} s"
        f"\ntake a shorter duration, or go on from there: {start}"
    )


def _spelled(state: State, value: float) -> str:
    """A value of a state as `--start` reads it."""
    if state.kind is Kind.DISCRETE:
        return state.values[int(value)]
    return f"{value / state.unit.scale:.6g}"


def rollout_summary(program: Program, rollout: Rollout) -> str:
    """How a run began and ended."""
    first, last = rollout.states[0], rollout.ended_in
    rows = [f"{program.name}: {rollout.ending.sentence} after {float(rollout.ended_at):.6g} s"]
    if rollout.ending is not Ending.COMPLETED:
        rows.append(f"  {rollout.detail}")
    rows.append(f"  {'':16} {'start':>14} {'end':>14}")
    for i, state in enumerate(program.states):
        if state.kind is Kind.DISCRETE:
            names = (state.values[int(x[i])] for x in (first, last))
            rows.append(f"  {state.name:16} " + " ".join(f"{name:>14}" for name in names))
            continue
        start, end = first[i] / state.unit.scale, last[i] / state.unit.scale
        rows.append(f"  {state.name:16} {start:14.6g} {end:14.6g}  {state.unit.text}")
    if len(rollout.switches):
        rows.append(f"  {program.field.mode} changed {len(rollout.switches)} times")
    return "\n".join(rows)
