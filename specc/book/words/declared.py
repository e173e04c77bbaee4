"""Tables of what a module declares, be it a behavior or an arbiter."""

from collections.abc import Sequence

from runtime.architecture import Architecture, Node
from runtime.program import Constant, Control
from specc.book.chapters import Table
from specc.book.naming import Names
from specc.book.words.quantities import NOTHING, exact, listed, range_of
from specc.book.words.wiring import source_of


def controls_table(
    controls: Sequence[Control], made: Architecture, node: Node, names: Names
) -> Table:
    """What can be set from outside, and what sets it here."""
    rows = tuple(
        (
            f"`{control.name}`",
            range_of(control),
            exact(control.default, control.unit),
            source_of(made, node, control, names),
            control.about or _channels(made, node, control.name),
        )
        for control in controls
    )
    return Table(("control", "range", "default", "here", "what it does"), rows)


def _channels(made: Architecture, node: Node, entry: str) -> str:
    """What a control goes to as it is."""
    told = [f"`{made.channels[c.channel].name}`" for c in node.commands if c.entry == entry]
    return f"goes to {listed(told)}" if told else NOTHING


def constants_table(constants: Sequence[Constant]) -> Table:
    """What nobody sets."""
    rows = tuple((f"`{c.name}`", exact(c.value, c.unit), c.about or NOTHING) for c in constants)
    return Table(("constant", "value", "what it is"), rows)
