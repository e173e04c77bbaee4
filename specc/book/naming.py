"""What the files of a book are called: for each node a page, its data and its figures."""

from dataclasses import dataclass
from typing import final

from runtime.architecture import Architecture, Node
from specc.book.contents import Contents, Shown


@final
@dataclass(frozen=True, slots=True)
class Names:
    """Names of files. many: whether there are several architectures, whose names stand before."""

    many: bool

    def stem(self, made: Architecture, node: Node) -> str:
        """The name of a node's page."""
        return f"{made.name}.{node.name}" if self.many else node.name

    def overview(self, made: Architecture) -> str:
        """The name of an architecture's own page."""
        return f"architecture.{made.name}" if self.many else "architecture"

    def page(self, made: Architecture, node: Node) -> str:
        """The HTML of a node."""
        return f"pages/{self.stem(made, node)}.html"

    def data(self, made: Architecture, node: Node) -> tuple[str, ...]:
        """The tables of a node."""
        return tuple(f"data/{self.stem(made, node)}{kind}" for kind in (".npz", ".csv"))

    def portrait(self, made: Architecture, node: Node, count: int) -> str:
        """The figure of a node's portrait of that number."""
        return f"{self.stem(made, node)}-{count + 1}"

    def figures(self, made: Architecture, shown: Shown) -> tuple[str, ...]:
        """The figures of a node, as files."""
        count = range(len(shown.portraits))
        return tuple(f"figures/{self.portrait(made, shown.node, k)}.svg" for k in count)


def names_of(contents: Contents) -> Names:
    """The names in a book of these contents."""
    return Names(len(contents.architectures) > 1)
