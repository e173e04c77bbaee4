"""A run as a file: .mcap with the compiled spec attached, or .csv."""

import csv
import io
from pathlib import Path

from runtime.program import Program
from runtime.recording.behavior import recorded
from runtime.recording.scenario_run import recorded_run
from runtime.rollout import Rollout
from runtime.run import Run
from specc.files import unknown_suffix, write_atomically


def record(program: Program, rollout: Rollout, path: Path | str) -> None:
    """Write a run as .mcap (with the compiled spec attached) or as .csv."""
    path = Path(path)
    match path.suffix.lower():
        case ".mcap":
            write_atomically(path, recorded(rollout, program))
        case ".csv":
            write_atomically(path, _csv(program, rollout).encode())
        case _:
            raise unknown_suffix(path, ".mcap, .csv")


def record_run(run: Run, path: Path | str) -> None:
    """Write the run of a scenario as .mcap, with all that it was made of attached."""
    path = Path(path)
    if path.suffix.lower() != ".mcap":
        raise unknown_suffix(path, ".mcap")
    write_atomically(path, recorded_run(run))


def _csv(program: Program, rollout: Rollout) -> str:
    """A column for time, each state, control and output, in the spec's units."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    states, controls, outputs = program.states, program.controls, program.outputs
    names = [*(s.name for s in states), *(c.name for c in controls), *(o.name for o in outputs)]
    writer.writerow(["t", *names])
    for time, x, y in zip(rollout.times, rollout.states, rollout.outputs, strict=True):
        row = [v / s.unit.scale for s, v in zip(states, x, strict=True)]
        row += [v / c.unit.scale for c, v in zip(controls, rollout.controls, strict=True)]
        row += [v / o.unit.scale for o, v in zip(outputs, y, strict=True)]
        if all(value == value for value in row):  # noqa: PLR0124  NaN: the run has ended
            writer.writerow([repr(float(v)) for v in (time, *row)])
    return text.getvalue()
