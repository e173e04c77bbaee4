"""The modules of a book beside recordings: which are done, which fail, which still lack data."""

from dataclasses import dataclass
from enum import StrEnum
from typing import Final, final

from runtime.arbiter import Arbiter
from runtime.architecture import Architecture, Node
from runtime.program import Program
from specc.verifying.architecture import NotJudged
from specc.verifying.runs import Unusable
from specc.verifying.trace import Verification
from verifier.report.examination import Examination


@final
class Standing(StrEnum):
    """How far a module is."""

    DONE = "done"
    FAILS = "fails"
    LACKS = "lacks data"
    FREE = "promises nothing"


DONE_FIRST: Final = (Standing.DONE, Standing.FAILS, Standing.LACKS, Standing.FREE)
"""The order in which modules are shown."""
WORST_FIRST: Final = (Standing.FAILS, Standing.LACKS, Standing.DONE, Standing.FREE)


@final
@dataclass(frozen=True, slots=True)
class Place:
    """Which module: a node of an architecture of the book."""

    architecture: str
    node: str


@final
@dataclass(frozen=True, eq=False, slots=True)
class Piece:
    """A module as the book has it: its node, and the spec that it runs; None of code."""

    place: Place
    node: Node
    spec: Program | Arbiter | None

    @property
    def kind(self) -> str:
        """In a word."""
        if self.spec is None:
            return "module"
        return "behavior" if isinstance(self.spec, Program) else "arbiter"


@final
@dataclass(frozen=True, eq=False, slots=True)
class ModuleVerdict:
    """A module, and what all recordings together show of it.

    members: what single recordings say; not_judged: of which nothing can be said, and why.
    together: what they say together; None where none says anything. why: what decides, first of
    all; to_record: what is still to be recorded. Both are sentences. page: of the book.
    """

    piece: Piece
    standing: Standing
    members: tuple[Verification, ...]
    not_judged: tuple[NotJudged, ...]
    together: Examination | None
    why: tuple[str, ...]
    to_record: tuple[str, ...]
    page: str

    @property
    def is_recorded(self) -> bool:
        """Whether anything was recorded of it that says something."""
        return self.together is not None


@final
@dataclass(frozen=True, eq=False, slots=True)
class BookVerdict:
    """Modules of a book, in its order, and recordings that can't be used.

    left_out: how many other modules it has, which nobody asked for.
    """

    name: str
    modules: tuple[ModuleVerdict, ...]
    unusable: tuple[Unusable, ...]
    left_out: int = 0

    @property
    def standing(self) -> Standing:
        """The worst of all modules."""
        found = {each.standing for each in self.modules} - {Standing.FREE}
        return next((each for each in WORST_FIRST if each in found), Standing.LACKS)

    def count(self, standing: Standing) -> int:
        """How many modules are so far."""
        return sum(each.standing is standing for each in self.modules)


def pieces_of(architecture: Architecture) -> tuple[Piece, ...]:
    """The modules of an architecture, in the order of its nodes."""
    return tuple(
        Piece(Place(architecture.name, node.name), node, architecture.spec_of(node))
        for node in architecture.nodes
    )
