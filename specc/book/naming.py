"""What the files of a book are called: for each node a page, its data and its figures."""

from dataclasses import dataclass
from typing import Final, final

from runtime.architecture import Architecture, Node
from specc.book.contents import Contents, Shown

RUN: Final = "run"
"""The figure of the scenario's run."""
RESERVED: Final = frozenset({"index", "building", "scenario", "architecture", RUN})
"""Pages and figures that are of no node."""


@final
@dataclass(frozen=True, slots=True)
class Names:
    """Names of files. many: whether there are several architectures, whose names stand before."""

    many: bool

    def stem(self, made: Architecture, node: Node) -> str:
        """The name of a node's page."""
        own = f"module.{node.name}" if node.name in RESERVED else node.name
        return f"{made.name}.{own}" if self.many else own

    def overview(self, made: Architecture) -> str:
        """The name of an architecture's own page."""
        return f"architecture.{made.name}" if self.many else "architecture"

    def wiring(self, made: Architecture) -> str:
        """The figure of its wiring."""
        return f"{self.overview(made)}-wiring"

    def page(self, made: Architecture, node: Node) -> str:
        """The HTML of a node."""
        return f"pages/{self.stem(made, node)}.html"

    def data(self, made: Architecture, node: Node) -> tuple[str, ...]:
        """The tables of a node."""
        return tuple(f"data/{self.stem(made, node)}{kind}" for kind in (".npz", ".csv"))

    def procedure(self, made: Architecture, node: Node) -> str:
        """The runs of its test procedure, for programs."""
        return f"data/{self.stem(made, node)}.procedure.csv"

    def portrait(self, made: Architecture, node: Node, count: int) -> str:
        """The figure of a node's portrait of that number."""
        return f"{self.stem(made, node)}-{count + 1}"

    def figures(self, made: Architecture, shown: Shown) -> tuple[str, ...]:
        """The figures of a node, as files."""
        count = range(len(shown.portraits) + len(shown.decisions) + len(shown.speeds))
        return tuple(f"figures/{self.portrait(made, shown.node, k)}.svg" for k in count)


def names_of(contents: Contents) -> Names:
    """The names in a book of these contents."""
    return Names(len(contents.architectures) > 1)
