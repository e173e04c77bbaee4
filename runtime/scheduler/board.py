"""The board: everything that sensors and nodes have said, and all that a node may read."""

from collections.abc import Sequence
from typing import final

import numpy as np

from runtime.architecture import Architecture, Node
from runtime.arrays import Array
from runtime.world.model import Sensor


@final
class Board:
    """The signals of one robot, (s,) in SI; what has not been said yet is `Signal.unsaid`."""

    def __init__(self, architecture: Architecture, sensors: Sequence[Sensor]) -> None:
        unsaid = [signal.unsaid for signal in architecture.board]
        self.values: Array = np.array(unsaid, dtype=np.float64)
        counts = [len(sensor.readings) for sensor in sensors]
        ends = np.cumsum(counts).tolist()
        self._sensors = [slice(end - n, end) for end, n in zip(ends, counts, strict=True)]
        self._nodes = [places_of(node) for node in architecture.nodes]

    def sense(self, sensor: int, readings: Array) -> None:
        """Put readings of a sensor on the board."""
        self.values[self._sensors[sensor]] = readings

    def write(self, node: int, outputs: Array) -> None:
        """Put on the board what a node says."""
        self.values[self._nodes[node]] = outputs


def places_of(node: Node) -> slice | list[int]:
    """Where a node writes; a slice where the places are neighbors, which is quicker."""
    places = list(node.outputs)
    if not places:
        return slice(0, 0)
    neighbors = list(range(places[0], places[0] + len(places)))
    return slice(places[0], places[0] + len(places)) if places == neighbors else places
