"""What the end of a training has found out so far, so that whoever goes on asks nothing twice.

Who won the last race and what each trial said is a few hundred bits. What the list lived that they
led to is lived once more, which takes a part of the time that all trials took.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import final


@final
@dataclass(slots=True)
class Remembered:
    """What is known of the last race and of the trials after it.

    winner: the place of the generation whose list won; None before that is known. trials: of each,
    in their order, whether the change stays. keep: is called when there is more.
    """

    winner: int | None = None
    trials: list[bool] = field(default_factory=list)
    keep: Callable[["Remembered"], None] = lambda _: None
    _asked: int = field(default=0, init=False)

    def won(self, winner: int) -> None:
        """The last race is over."""
        self.winner = winner
        self.keep(self)

    def stays(self, trial: Callable[[], bool]) -> bool:
        """Whether the change of the next trial stays: as it was found, or as it is found now."""
        if self._asked == len(self.trials):
            self.trials.append(trial())
            self.keep(self)
        self._asked += 1
        return self.trials[self._asked - 1]
