"""Ticks of a run gathered into records of its nodes, as the run goes on."""

from typing import final

import numpy as np

from runtime.architecture import Architecture
from runtime.arrays import Array, Booleans
from runtime.scheduler.environment import Delivery
from runtime.scheduler.observer import Event, Resolved, Tick
from verifier.architectures.nodes import NodeRecord, held_back
from verifier.architectures.way import has_its_way


@final
class Gathered:
    """An observer of a run that keeps what verifying each node of one robot needs."""

    def __init__(self, architecture: Architecture, robot: int, step: float) -> None:
        self._architecture, self._robot, self._step = architecture, robot, step
        self._ticks: list[list[tuple[int, Array, float]]] = [[] for _ in architecture.nodes]
        self._acts: list[tuple[int, Booleans, Array]] = []

    def sensed(self, instant: int, delivery: Delivery) -> None:
        """Do nothing: nodes tell what they sampled."""

    def ticked(self, instant: int, tick: Tick) -> None:
        """Keep what the node sampled, and what an arbiter chose."""
        if tick.robot == self._robot:
            chosen = float(tick.outputs[-1]) if tick.outputs.size else -1.0
            self._ticks[tick.node].append((instant, tick.register.copy(), chosen))

    def acting(self, instant: int, robot: int, acts: Booleans, weights: Array) -> None:
        """Keep who acts."""
        if robot == self._robot:
            self._acts.append((instant, acts.copy(), weights.copy()))

    def commanded(self, instant: int, robot: int, channels: Array, driven: Booleans) -> None:
        """Do nothing: who acts is told apart."""

    def resolved(self, instant: int, robot: int, channel: int, how: Resolved) -> None:
        """Do nothing."""

    def happened(self, instant: int, event: Event) -> None:
        """Do nothing."""

    def records(self) -> tuple[NodeRecord, ...]:
        """The record of each node, in their order."""
        count = len(self._architecture.nodes)
        instants = np.array([-1, *(instant for instant, _, _ in self._acts)])
        acts = np.array([np.zeros(count, dtype=np.bool_), *(each for _, each, _ in self._acts)])
        weights = np.array([np.zeros(count), *(each for _, _, each in self._acts)])
        free = has_its_way(self._architecture, acts, weights)
        return tuple(
            self._record(node, instants, acts[:, node], free[:, node]) for node in range(count)
        )

    def _record(self, place: int, instants: Array, acts: Booleans, free: Booleans) -> NodeRecord:
        node = self._architecture.nodes[place]
        ticks = self._ticks[place]
        at = np.array([instant for instant, _, _ in ticks], dtype=np.int64)
        names = _entries(self._architecture, place)
        rows = np.array([row[: len(names)] for _, row, _ in ticks]).reshape(len(ticks), len(names))
        columns = {name: rows[:, i] for i, name in enumerate(names)}
        # Who acts is told after the last that was told at or before the tick.
        since = np.maximum(np.searchsorted(instants, at, "right") - 1, 0)
        back = held_back(self._architecture, place, columns, acts[since], free[since])
        is_arbiter = node.arbiter >= 0
        times: Array = np.asarray(at, dtype=np.float64) * self._step
        return NodeRecord(
            name=node.name,
            times=times,
            columns=columns,
            held_back={} if is_arbiter else back,
            chosen=np.array([chosen for _, _, chosen in ticks]) if is_arbiter else None,
        )


def _entries(architecture: Architecture, place: int) -> tuple[str, ...]:
    """The names of what a node samples."""
    node = architecture.nodes[place]
    if node.behavior >= 0:
        program = architecture.programs[node.behavior]
        return (*(s.name for s in program.states), *(c.name for c in program.controls))
    return tuple(dict.fromkeys(each.entry for each in node.inputs))
