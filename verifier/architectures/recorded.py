"""The records of an architecture's nodes, read from a recording of a scenario.

Recordings: `runtime.recording.nodes`. Times count from the beginning of the run.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

import numpy as np

from runtime.architecture import Architecture, Node
from runtime.arrays import Array, Booleans
from runtime.recording.nodes import (
    ACTING,
    CHOICE,
    CONTROL,
    READS,
    STATE,
    fields_of_reads,
    topic_of,
)
from runtime.recording.tables import Field
from verifier.architectures.nodes import NodeRecord
from verifier.architectures.way import has_its_way
from verifier.traces.files.log import LogFile, MessageLog, Messages, Wanted
from verifier.traces.files.open_log import open_log
from verifier.traces.messages.columns import Column
from verifier.traces.messages.paths import MessagePath, parse_path, path_text

NANOSECONDS: Final = 1e9
ACTS: Final = "acts"
CHOSEN: Final = "choice"


def read_nodes(path: Path, robots: Mapping[str, Architecture]) -> dict[str, tuple[NodeRecord, ...]]:
    """By robot, the record of each node in the order of nodes; empty where nothing was recorded.

    Raises:
        SpecError: the recording can't be opened (V301, V302).
    """
    wanted = {
        topic: tuple(parse_path(path_text(topic, (field.name,))) for field in fields)
        for robot, architecture in robots.items()
        for node in architecture.nodes
        for topic, fields in _topics(robot, architecture, node).items()
    }
    log = _opened(path, wanted)
    return {
        robot: tuple(_records(log, robot, architecture)) for robot, architecture in robots.items()
    }


def _opened(path: Path, wanted: Mapping[str, tuple[MessagePath, ...]]) -> LogFile:
    return open_log(path, Wanted(wanted, frozenset()))


def _topics(robot: str, architecture: Architecture, node: Node) -> dict[str, list[Field]]:
    """What is read of a node, by topic."""
    found = {ACTING: [Field(ACTS, is_flag=True)]}
    if node.behavior >= 0:
        program = architecture.programs[node.behavior]
        found[STATE] = [Field(s.name, s.unit, s.values) for s in program.states]
        found[CONTROL] = [Field(c.name, c.unit) for c in program.controls]
    elif node.arbiter >= 0:
        arbiter = architecture.arbiters[node.arbiter]
        found[READS] = fields_of_reads(arbiter)
        found[CHOICE] = [Field(CHOSEN, labels=arbiter.choices)]
    return {topic_of(robot, node.name, what): fields for what, fields in found.items() if fields}


def _records(log: LogFile, robot: str, architecture: Architecture) -> list[NodeRecord]:
    instants, free = _free(log, robot, architecture)
    return [
        _record(log, robot, architecture, place, instants, free[:, place])
        for place in range(len(architecture.nodes))
    ]


def _record(
    log: LogFile,
    robot: str,
    architecture: Architecture,
    place: int,
    instants: Array,
    free: Booleans,
) -> NodeRecord:
    node = architecture.nodes[place]
    times: Array | None = None
    columns: dict[str, Array] = {}
    for topic, fields in _topics(robot, architecture, node).items():
        if topic == topic_of(robot, node.name, ACTING):
            continue
        here, found = _columns(log, topic, fields)
        if times is None:
            times, columns = here, found
            continue
        # A message that was lost of one topic is missing in the others, too.
        shared, mine, its = np.intersect1d(times, here, return_indices=True)
        columns = {name: column[mine] for name, column in columns.items()}
        columns |= {name: column[its] for name, column in found.items()}
        times = shared
    times = np.zeros(0) if times is None else times
    chosen = columns.pop(CHOSEN, None) if node.arbiter >= 0 else None
    if chosen is not None:
        chosen = np.where(np.isfinite(chosen), chosen, -1.0)
    acts = free[np.maximum(np.searchsorted(instants, times, "right") - 1, 0)]
    is_arbiter = node.arbiter >= 0
    return NodeRecord(
        name=f"{robot}.{node.name}",
        times=times,
        columns=columns,
        free=np.ones(times.size, dtype=np.bool_) if is_arbiter else acts,
        chosen=chosen,
    )


def _free(log: LogFile, robot: str, architecture: Architecture) -> tuple[Array, Booleans]:
    """When who acts changes, and which nodes (T, nodes) have their way from then on."""
    told = []
    for node in architecture.nodes:
        times, found = _columns(log, topic_of(robot, node.name, ACTING), [Field(ACTS)])
        told.append((times, found[ACTS] > 0.0))
    instants = np.unique(np.concatenate([[-1.0], *(times for times, _ in told)]))
    acts = np.zeros((instants.size, len(told)), dtype=np.bool_)
    for place, (times, flags) in enumerate(told):
        if times.size:
            last = np.searchsorted(times, instants, "right") - 1
            acts[:, place] = np.where(last >= 0, flags[np.maximum(last, 0)], False)  # noqa: FBT003
    return instants, has_its_way(architecture, acts)


def _columns(log: LogFile, topic: str, fields: Sequence[Field]) -> tuple[Array, dict[str, Array]]:
    """The times of a topic's messages, strictly increasing, and its fields in SI."""
    empty = np.zeros(0), {field.name: np.zeros(0) for field in fields}
    streams = log.streams if isinstance(log, MessageLog) else ()
    stream = next((s for s in streams if s.channel.topic == topic and s.values), None)
    if stream is None or stream.values is None:
        return empty
    readable = np.flatnonzero(stream.values.readable)
    seconds = _seconds(stream, readable)
    times, rows = np.unique(seconds, return_index=True)
    found = {}
    for field in fields:
        column = stream.values.columns.get(path_text(topic, (field.name,)))
        if column is None:
            return empty
        found[field.name] = _in_si(field, column)[rows]
    return times, found


def _seconds(stream: Messages, readable: np.ndarray[tuple[int], np.dtype[np.int64]]) -> Array:
    return np.asarray(stream.times[: readable.max(initial=-1) + 1][readable] / NANOSECONDS)


def _in_si(field: Field, column: Column) -> Array:
    if field.labels and column.texts is not None:
        places = {label: float(place) for place, label in enumerate(field.labels)}
        return np.array([places.get(text or "", np.nan) for text in column.texts])
    return column.numbers * field.unit.scale
