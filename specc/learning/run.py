"""A run of an experiment: a learner, what went on, and how far it is; and who teaches it."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Generic, Protocol, TypeVar, final

from lcs.rules.compaction import Compacted
from lcs.rules.experience import Experience
from lcs.state import Saved
from runtime.progress import Progress
from specc.learning.courses import Piece, joined

Pupil = TypeVar("Pupil", bound=Saved)
Figures = TypeVar("Figures")


@final
@dataclass(slots=True)
class Run(Generic[Pupil, Piece]):
    """One run of a seed: what it has learnt, what went on, and seconds spent on learning.

    none: a piece of its course that is empty. done: cycles, or in a world episodes.
    """

    seed: int
    learner: Pupil
    none: Piece
    pieces: list[Piece] = field(default_factory=list)
    done: int = 0
    seconds: float = 0.0

    def so_far(self) -> Piece:
        """The course as one piece."""
        if len(self.pieces) != 1:
            self.pieces = [joined(self.pieces, self.none)]
        return self.pieces[0]


@final
@dataclass(frozen=True, eq=False, slots=True)
class Outcome(Generic[Figures]):
    """What came of a run: its figures, and few rules that say the same on the examples `seen`."""

    seen: Experience
    compacted: Compacted
    summary: Figures


class Teacher(Protocol[Pupil, Piece, Figures]):
    """Gives a learner what it is to learn, and says how it stands and what came of it."""

    def begun(self, seed: int) -> Run[Pupil, Piece]:
        """A run that has not begun to learn."""
        ...

    def advance(self, run: Run[Pupil, Piece], most: int) -> float:
        """Learn from so many cycles or episodes at most; how long they took, in seconds."""
        ...

    def standing(self, run: Run[Pupil, Piece]) -> str:
        """How it stands, in a few words."""
        ...

    def concluded(
        self, runs: Sequence[Run[Pupil, Piece]], tell: Progress
    ) -> tuple[Outcome[Figures], ...]:
        """What came of each of the runs, which are done."""
        ...
