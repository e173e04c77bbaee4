"""Recordings: a run as an MCAP file that opens in Foxglove and that the verifier can judge alone.

Topics `/NAME/state`, `/NAME/control`, `/NAME/output` hold JSON objects with one number per variable
(a discrete one: the name of its value) in the spec's own units. The compiled spec is attached; its
bindings point at these topics. The same run gives the same bytes.

MCAP: https://mcap.dev/spec.
"""

import dataclasses
import io
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Final, TypeAlias

import numpy as np
from mcap.writer import CompressionType, Writer

from runtime.arrays import Array
from runtime.artifact import replace_file, to_bytes
from runtime.code import Code
from runtime.program import Binding, Control, Output, Program, State
from runtime.rollout import Rollout

Variable: TypeAlias = State | Control | Output

MEDIA_TYPE: Final = "application/vnd.specc"
LIBRARY: Final = "specc"
CHUNK: Final = 1 << 20
NANOSECONDS: Final = 1e9


def recorded(rollout: Rollout, program: Program) -> bytes:
    """The bytes of an MCAP file that holds one run of the program.

    Raises:
        ValueError: the rollout is a batch, or of another program.
    """
    if rollout.states.ndim != 2 or rollout.program != program.name:
        raise ValueError(
            f"a recording holds one run of '{program.name}' (got {len(rollout.endings)} of "
            f"'{rollout.program}')"
        )
    artifact = to_bytes(self_bound(program))
    stream = io.BytesIO()
    writer = Writer(stream, chunk_size=CHUNK, compression=CompressionType.ZSTD)
    writer.start(library=LIBRARY)
    _write_samples(writer, rollout, program)
    writer.add_attachment(0, 0, f"{program.name}.specc", MEDIA_TYPE, artifact)
    writer.add_metadata(
        "specc",
        {
            "behavior": program.name,
            "spec_sha256": program.source.sha256,
            "ending": str(rollout.ending),
            "ended_at": repr(float(rollout.ended_at)),
        },
    )
    writer.finish()  # type: ignore[no-untyped-call]  # the library's
    return stream.getvalue()


def record(path: Path, rollout: Rollout, program: Program) -> None:
    """Write the recording of one run; at no time is there a half-written file under `path`.

    Raises:
        ValueError: the rollout is a batch, or of another program.
    """
    replace_file(path, recorded(rollout, program))


def self_bound(program: Program) -> Program:
    """The program whose variables stand where a recording has them.

    Simulated, the behavior always has its way: `judge_when` stays only if it reads no signal.
    """
    bindings = own_bindings(program)
    read = set(program.judge_when.tokens) if program.judge_when else set()
    signals = {binding.name for binding in program.bindings} - set(program.register)
    judge_when: Code | None = None if read & signals else program.judge_when
    return dataclasses.replace(program, bindings=bindings, judge_when=judge_when)


def own_bindings(program: Program) -> tuple[Binding, ...]:
    """Where a recording has the states and controls of a program."""
    states = [_binding(program, "state", state) for state in program.states]
    return (*states, *(_binding(program, "control", each) for each in program.controls))


def _binding(program: Program, group: str, variable: State | Control) -> Binding:
    return Binding(
        name=variable.name,
        path=f"/{program.name}/{group}.{variable.name}",
        unit=variable.unit,
        delay=0.0,
        scale=1.0,
        offset=0.0,
        constant=None,
        values=tuple((text, index) for index, text in enumerate(_values(variable))),
        origin=variable.origin,
    )


def _write_samples(writer: Writer, rollout: Rollout, program: Program) -> None:
    """All messages up to the end of the run, in the order of time."""
    controls = np.broadcast_to(rollout.controls, (rollout.times.size, rollout.controls.size))
    groups: list[tuple[int, Sequence[Variable], Array]] = [
        (_channel(writer, program, "state", program.states), program.states, rollout.states),
        (_channel(writer, program, "control", program.controls), program.controls, controls),
        (_channel(writer, program, "output", program.outputs), program.outputs, rollout.outputs),
    ]
    columns = [(channel, _texts(variables, values)) for channel, variables, values in groups]
    living = ~np.isnan(rollout.states).any(axis=-1)
    for sample in np.flatnonzero(living):
        time = round(float(rollout.times[sample]) * NANOSECONDS)
        for channel, texts in columns:
            if texts:
                data = "{" + ",".join(column[sample] for column in texts) + "}"
                writer.add_message(channel, time, data.encode(), time, sequence=int(sample))


def _texts(variables: Sequence[Variable], values: Array) -> list[list[str]]:
    """Per variable, its `"name":value` at each sample; null where a value is not finite."""
    columns = []
    for variable, column in zip(variables, values.T, strict=True):
        key = json.dumps(variable.name)
        names = _values(variable)
        if names:
            known = np.where(np.isfinite(column), column, 0.0).astype(np.int64)
            texts = [json.dumps(names[index]) for index in known]
        else:
            own = column / variable.unit.scale
            texts = [repr(value) if finite else "null" for value, finite in _checked(own)]
        columns.append([f"{key}:{text}" for text in texts])
    return columns


def _checked(values: Array) -> list[tuple[float, bool]]:
    return list(zip(values.tolist(), np.isfinite(values).tolist(), strict=True))


def _channel(writer: Writer, program: Program, group: str, variables: Sequence[Variable]) -> int:
    """The number of the group's channel; 0 where there are no variables."""
    if not variables:
        return 0
    properties = {variable.name: _property(variable) for variable in variables}
    schema = {
        "title": f"{program.name}/{group}",
        "type": "object",
        "properties": properties,
        "required": list(properties),
    }
    text = json.dumps(schema, ensure_ascii=False)
    number = writer.register_schema(f"{program.name}/{group}", "jsonschema", text.encode())
    return int(writer.register_channel(f"/{program.name}/{group}", "json", number))


def _property(variable: Variable) -> dict[str, object]:
    names = _values(variable)
    kind: dict[str, object] = (
        {"type": "string", "enum": list(names)} if names else {"type": "number"}
    )
    about = [variable.about] if variable.about else []
    unit = [] if names else [f"unit: {variable.unit.text}"]
    return {**kind, "description": "; ".join([*about, *unit])}


def _values(variable: Variable) -> tuple[str, ...]:
    """The names of a discrete state's values."""
    return variable.values if isinstance(variable, State) else ()
