"""Tables of what a module declares, be it a behavior or an arbiter."""

from collections.abc import Sequence

from runtime.architecture import Architecture, Node
from runtime.program import Constant, Control
from specc.book.chapters import Table
from specc.book.naming import Names
from specc.book.words.quantities import NOTHING, exact, range_of
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
            control.about or NOTHING,
        )
        for control in controls
    )
    return Table(("control", "range", "default", "set here to", "what it does"), rows)


def constants_table(constants: Sequence[Constant]) -> Table:
    """What nobody sets."""
    rows = tuple((f"`{c.name}`", exact(c.value, c.unit), c.about or NOTHING) for c in constants)
    return Table(("constant", "value", "what it is"), rows)
