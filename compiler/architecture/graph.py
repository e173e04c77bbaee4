"""The wiring as a graph: the order of nodes at one instant, circles without a delay, levels."""

from collections.abc import Iterator, Mapping

import networkx as nx

from compiler.architecture.parts import Part, Parts
from compiler.findings import Findings
from runtime.architecture import Input, Signal


def order_of(
    inputs: Mapping[str, tuple[Input, ...]],
    board: tuple[Signal, ...],
    parts: Parts,
    findings: Findings,
) -> tuple[int, ...]:
    """Nodes so that one with response time 0 stands before those that it tells something.

    A circle of such nodes is a finding: none of them could be the first.
    """
    names = list(parts.nodes)
    graph = nx.DiGraph()
    graph.add_nodes_from(names)
    for one, other in _told(inputs, board, parts):
        if parts.nodes[one].response_time == 0.0:
            graph.add_edge(one, other)
    circles = [sorted(c, key=names.index) for c in nx.strongly_connected_components(graph)]
    for circle in sorted(circles, key=lambda c: names.index(c[0])):
        if len(circle) > 1 or graph.has_edge(circle[0], circle[0]):
            _tell_circle(nx.find_cycle(graph.subgraph(circle), circle[0]), parts, findings)
    if not nx.is_directed_acyclic_graph(graph):
        return tuple(range(len(names)))
    sorted_names = nx.lexicographical_topological_sort(graph, key=names.index)
    return tuple(names.index(name) for name in sorted_names)


def _tell_circle(edges: list[tuple[str, str]], parts: Parts, findings: Findings) -> None:
    way = " -> ".join([*(one for one, _ in edges), edges[-1][1]])
    first = parts.nodes[edges[0][0]]
    message = f"{way}: a circle in which nothing takes any time"
    remedy = "give one of them a `response_time` above 0"
    findings.error("S350", first.path, message, remedy, key=True)


def _told(
    inputs: Mapping[str, tuple[Input, ...]], board: tuple[Signal, ...], parts: Parts
) -> Iterator[tuple[str, str]]:
    """Pairs of nodes of which the first tells, sets, or lets act the second."""
    for name, many in inputs.items():
        for one in many:
            owner = board[one.signal].name.partition(".")[0] if one.signal >= 0 else ""
            if owner in parts.nodes:
                yield owner, name
    for name, part in parts.nodes.items():
        for other in governed_by(part, parts):
            yield name, other


def governed_by(part: Part, parts: Parts) -> tuple[str, ...]:
    """The nodes that a node's choices let act, or set controls of."""
    named = [
        name
        for acting in part.spec.choices.values()
        for name in (*acting.act, *(key.partition(".")[0] for key in acting.set))
    ]
    return tuple(name for name in dict.fromkeys(named) if name in parts.nodes)


def controls_of(
    inputs: Mapping[str, tuple[Input, ...]], board: tuple[Signal, ...], parts: Parts
) -> dict[str, tuple[str, ...]]:
    """For each node those that it controls: sets a control of, or lets act."""
    found: dict[str, list[str]] = {
        name: list(governed_by(part, parts)) for name, part in parts.nodes.items()
    }
    for name, many in inputs.items():
        settable = {entry.name for entry in parts.nodes[name].controls}
        for one in many:
            owner = board[one.signal].name.partition(".")[0] if one.signal >= 0 else ""
            if owner in found and one.entry in settable:
                found[owner].append(name)
    return {name: tuple(dict.fromkeys(many)) for name, many in found.items()}


def levels_of(controls: Mapping[str, tuple[str, ...]]) -> tuple[dict[str, int], list[list[str]]]:
    """The level of each node, and circles of nodes that control one another.

    0 for a base behavior; else one above the highest that it controls. Nodes of a circle are on
    one level.
    """
    graph = nx.DiGraph()
    graph.add_nodes_from(controls)
    graph.add_edges_from((one, other) for one, many in controls.items() for other in many)
    whole = nx.condensation(graph)
    level: dict[int, int] = {}
    for circle in reversed(list(nx.topological_sort(whole))):
        level[circle] = max((level[below] + 1 for below in whole.successors(circle)), default=0)
    found = {name: level[whole.graph["mapping"][name]] for name in controls}
    circles = [sorted(members) for _, members in whole.nodes(data="members")]
    return found, [circle for circle in circles if len(circle) > 1]
