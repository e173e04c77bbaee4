"""Who acts: choices in effect, what keeps nodes from acting, and who replaces whom."""

from collections.abc import Sequence
from typing import NamedTuple, final

import numpy as np

from runtime.architecture import Architecture, Node, Setting
from runtime.arrays import Array, Booleans
from runtime.scheduler.inputs import Inputs


@final
class _Option(NamedTuple):
    """A choice of an arbiter: its place on the board, the nodes that act, and what is set."""

    place: int
    acts: tuple[int, ...]
    sets: tuple[Setting, ...]


@final
class Acting:
    """Which nodes of one robot act, worked out anew whenever something of it changes.

    is_ready: (nodes,) of what each node said last that is in effect: whether it is to act, as far
    as it is its own to say. allowed: whether nothing outside a node keeps it from acting.
    acts: both. by: for each arbiter how strongly its choices in effect name each node (nodes,);
    weights: their sum. does: acts as a list, which is read quicker.
    """

    def __init__(self, architecture: Architecture, inputs: Sequence[Inputs]) -> None:
        nodes = architecture.nodes
        self._inputs = inputs
        arbiters = [i for i, node in enumerate(nodes) if node.arbiter >= 0]
        # An arbiter may itself be named by one that stands above it.
        arbiters.sort(key=lambda i: (-nodes[i].level, i))
        self._options = [(i, _options(architecture, nodes[i])) for i in arbiters]
        named = {n for _, options in self._options for option in options for n in option.acts}
        self._is_free = [i not in named for i in range(len(nodes))]
        combined = [i for i, node in enumerate(nodes) if node.replaces]
        combined.sort(key=lambda i: (-len(nodes[i].replaces), i))
        self._combined = [(i, nodes[i].replaces) for i in combined]
        self._set: dict[tuple[int, str], float] = {}
        self.is_ready = [False for _ in nodes]
        self.allowed = [False for _ in nodes]
        self.does = [False for _ in nodes]
        self.acts: Booleans = np.zeros(len(nodes), dtype=np.bool_)
        self._weights = [0.0 for _ in nodes]
        self.by: dict[int, list[float]] = {i: [0.0 for _ in nodes] for i in arbiters}
        self.weights: Array = np.zeros(len(nodes))

    def settle(self, board: Array) -> bool:
        """Work out who acts; whether that, or a weight, is other than before."""
        weights, wanted = self._weighed(board)
        self.allowed = [free or w > 0.0 for free, w in zip(self._is_free, weights, strict=True)]
        would = [a and b for a, b in zip(self.allowed, self.is_ready, strict=True)]
        self._replace(would)
        if wanted != self._set:
            self._apply(wanted)
        if would == self.does and weights == self._weights:
            return False
        self.does, self._weights = would, weights
        self.acts, self.weights = np.array(would, dtype=np.bool_), np.array(weights)
        return True

    def _weighed(self, board: Array) -> tuple[list[float], dict[tuple[int, str], float]]:
        """How strongly choices in effect name each node, and what they set: the first has it."""
        weights = [0.0] * len(self.allowed)
        wanted: dict[tuple[int, str], float] = {}
        for arbiter, options in self._options:
            mine = self.by[arbiter] = [0.0] * len(weights)
            if not (self.is_ready[arbiter] and (self._is_free[arbiter] or weights[arbiter] > 0.0)):
                continue
            for option in options:
                number = float(board[option.place])
                if number > 0.0:
                    for node in option.acts:
                        mine[node] += number
                        weights[node] += number
                    for setting in option.sets:
                        wanted.setdefault((setting.node, setting.entry), setting.value)
        return weights, wanted

    def _replace(self, would: list[bool]) -> None:
        """Let combined nodes act where all their parts would, and nowhere else."""
        for node, parts in self._combined:
            self.allowed[node] &= all(would[part] for part in parts)
            would[node] &= self.allowed[node]
            if would[node]:
                for part in parts:
                    would[part] = self.allowed[part] = False

    def _apply(self, wanted: dict[tuple[int, str], float]) -> None:
        """Set what choices in effect set; undo what none sets any more."""
        for node, entry in self._set.keys() - wanted.keys():
            self._inputs[node].set(entry, None)
        for (node, entry), value in wanted.items():
            self._inputs[node].set(entry, value)
        self._set = wanted


def _options(architecture: Architecture, node: Node) -> list[_Option]:
    first = len(architecture.arbiters[node.arbiter].outputs)
    places = node.outputs[first : first + len(node.choices)]
    return [
        _Option(place, choice.acts, choice.sets)
        for place, choice in zip(places, node.choices, strict=True)
    ]
