"""How a node is wired, in cells and sentences: what it is fed, who sets it, who lets it act."""

from collections.abc import Iterator

from runtime.arbiter import Read
from runtime.architecture import Architecture, Input, Node, Outside
from runtime.program import Control, Kind, State
from specc.book.naming import Names
from specc.book.words.quantities import exact, listed
from specc.figures.quantities import number


def source_of(made: Architecture, node: Node, part: State | Control | Read, names: Names) -> str:
    """Where an entry of a node comes from, in this architecture."""
    wire = next((one for one in node.inputs if one.entry == part.name), None)
    by_choice = list(_set_by_choices(made, node, part, names))
    if by_choice:
        return listed(by_choice)
    if wire is None:
        return "the behavior itself"
    if wire.signal < 0:
        return f"held at {value_of(part, wire.value)}"
    return _signal(made, wire, part, names)


def _signal(made: Architecture, wire: Input, part: State | Control | Read, names: Names) -> str:
    signal = made.board[wire.signal]
    scale = "" if wire.scale == 1.0 else f"{number(wire.scale, 6)} · "
    low, high = sorted((wire.scale * signal.low, wire.scale * signal.high))
    told = f"{scale}{linked(made, signal.name, names)}"
    is_bounded = isinstance(part, Control) or part.kind is Kind.CONTINUOUS
    if wire.outside is Outside.INHIBIT:
        return f"{told}; outside its range the behavior does not act"
    if is_bounded and (low < part.low or high > part.high):
        return f"{told}, clipped to its range"
    return told


def value_of(part: State | Control | Read, value: float) -> str:
    """A value of a state, control or read; of a discrete one its label."""
    if not isinstance(part, Control) and part.values:
        return f"`{part.values[int(value)]}`"
    return exact(value, part.unit)


def linked(made: Architecture, signal: str, names: Names) -> str:
    """A signal with a link to who tells it: a node's page, or the architecture's, of a sensor."""
    box = signal.partition(".")[0]
    node = next((one for one in made.nodes if one.name == box), None)
    page = names.overview(made) if node is None else names.stem(made, node)
    return f"[{signal}]({page})"


def link(made: Architecture, node: Node, names: Names) -> str:
    """A node by its name."""
    return f"[{node.name}]({names.stem(made, node)})"


def _set_by_choices(
    made: Architecture, node: Node, part: State | Control | Read, names: Names
) -> Iterator[str]:
    for other in made.nodes:
        for choice in other.choices:
            for one in choice.sets:
                if made.nodes[one.node] is node and one.entry == part.name:
                    value = value_of(part, one.value)
                    yield f"{value} by {link(made, other, names)} in `{choice.name}`"


def governors(made: Architecture, node: Node) -> list[tuple[Node, str]]:
    """Who lets a node act, by which choice."""
    place = made.nodes.index(node)
    return [
        (other, choice.name)
        for other in made.nodes
        for choice in other.choices
        if place in choice.acts
    ]
