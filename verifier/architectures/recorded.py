"""The records of an architecture's nodes, read from a recording of a scenario.

Recordings: `runtime.recording.nodes`. Times count from the beginning of the run.
"""

from collections.abc import Mapping
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
from verifier.architectures.log import RunLog
from verifier.architectures.nodes import NodeRecord, held_back
from verifier.architectures.way import has_its_way

ACTS: Final = "acts"
WEIGHT: Final = "weight"
CHOSEN: Final = "choice"
UNKNOWN: Final = "who acted is not in the recording"
WHO_ACTS: Final = (Field(ACTS, is_flag=True), Field(WEIGHT))


def topics_of_nodes(robots: Mapping[str, Architecture]) -> dict[str, list[Field]]:
    """What is read of the nodes of these robots, by topic."""
    return {
        topic: fields
        for robot, architecture in robots.items()
        for node in architecture.nodes
        for topic, fields in _topics(robot, architecture, node).items()
    }


def records_of(
    log: RunLog, robots: Mapping[str, Architecture]
) -> dict[str, tuple[NodeRecord, ...]]:
    """By robot, the record of each node in the order of nodes; empty where nothing was recorded."""
    return {
        robot: tuple(_records(log, robot, architecture)) for robot, architecture in robots.items()
    }


def _topics(robot: str, architecture: Architecture, node: Node) -> dict[str, list[Field]]:
    """What is read of a node, by topic."""
    found = {ACTING: list(WHO_ACTS)}
    if node.behavior >= 0:
        program = architecture.programs[node.behavior]
        found[STATE] = [Field(s.name, s.unit, s.values) for s in program.states]
        found[CONTROL] = [Field(c.name, c.unit) for c in program.controls]
    elif node.arbiter >= 0:
        arbiter = architecture.arbiters[node.arbiter]
        found[READS] = fields_of_reads(arbiter)
        found[CHOICE] = [Field(CHOSEN, labels=arbiter.choices)]
    return {topic_of(robot, node.name, what): fields for what, fields in found.items() if fields}


def _records(log: RunLog, robot: str, architecture: Architecture) -> list[NodeRecord]:
    instants, acts, weights = acting_in(log, robot, architecture)
    free = has_its_way(architecture, acts, weights)
    return [
        _record(log, robot, architecture, place, instants, acts[:, place], free[:, place])
        for place in range(len(architecture.nodes))
    ]


def _record(
    log: RunLog,
    robot: str,
    architecture: Architecture,
    place: int,
    instants: Array,
    acts: Booleans,
    free: Booleans,
) -> NodeRecord:
    node = architecture.nodes[place]
    times, columns = _sampled(log, robot, architecture, node)
    chosen = columns.pop(CHOSEN, None) if node.arbiter >= 0 else None
    if chosen is not None:
        chosen = np.where(np.isfinite(chosen), chosen, -1.0)
    since = np.maximum(np.searchsorted(instants, times, "right") - 1, 0)
    back = held_back(architecture, place, columns, acts[since], free[since])
    if instants.size == 1:
        back = {UNKNOWN: np.ones(times.size, dtype=np.bool_)}
    return NodeRecord(
        name=f"{robot}.{node.name}",
        times=times,
        columns=columns,
        held_back={} if node.arbiter >= 0 else back,
        chosen=chosen,
        losses=log.losses,
    )


def _sampled(
    log: RunLog, robot: str, architecture: Architecture, node: Node
) -> tuple[Array, dict[str, Array]]:
    """What a node sampled, and what an arbiter chose, at its ticks."""
    times: Array | None = None
    columns: dict[str, Array] = {}
    for topic, fields in _topics(robot, architecture, node).items():
        if topic == topic_of(robot, node.name, ACTING):
            continue
        here, found = log.columns(topic, fields)
        if times is None:
            times, columns = here, found
            continue
        # A message that was lost of one topic is missing in the others, too.
        shared, mine, its = np.intersect1d(times, here, return_indices=True)
        columns = {name: column[mine] for name, column in columns.items()}
        columns |= {name: column[its] for name, column in found.items()}
        times = shared
    return np.zeros(0) if times is None else times, columns


def acting_in(log: RunLog, robot: str, architecture: Architecture) -> tuple[Array, Booleans, Array]:
    """When who acts changes, who acts (T, nodes) from then on, and the weights of choices."""
    told = []
    for node in architecture.nodes:
        topic = topic_of(robot, node.name, ACTING)
        times, found = log.columns(topic, WHO_ACTS)
        if not times.size:  # recordings of before told no weights
            times, found = log.columns(topic, WHO_ACTS[:1])
        told.append((times, found[ACTS] > 0.0, found.get(WEIGHT, np.zeros(times.size))))
    instants = np.unique(np.concatenate([[-1.0], *(times for times, _, _ in told)]))
    acts = np.zeros((instants.size, len(told)), dtype=np.bool_)
    weights = np.zeros(acts.shape)
    for place, (times, flags, numbers) in enumerate(told):
        if times.size:
            last = np.searchsorted(times, instants, "right") - 1
            begun, at = last >= 0, np.maximum(last, 0)
            acts[:, place] = begun & flags[at]
            weights[:, place] = np.where(begun, numbers[at], 0.0)
    return instants, acts, weights
