"""Recordings judged one after the other, with a bar that says which is at work."""

from typing import TYPE_CHECKING, Final, TypeVar, final

from specc.cli.console import shown_bar

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from specc.cli.console import Bar

READING: Final = "reading"
"""The phase in which bytes are counted."""
PIECES: Final = 1000
"""Of which the bar shows each recording."""
Outcome = TypeVar("Outcome")


def judged_with_bar(
    judge: "Callable[..., Iterator[Outcome]]", count: int
) -> "tuple[list[Outcome], bool]":
    """The outcomes, and whether Ctrl-C came before the last of them."""
    outcomes: list[Outcome] = []
    with shown_bar("verify") as bar:
        watch = _Watch(bar, count)
        try:
            outcomes.extend(judge(progress=watch.tell, reading=watch.read))
        except KeyboardInterrupt:
            return outcomes, True
    return outcomes, False


@final
class _Watch:
    """Shows in a bar which recording is at work: half of it is reading, told by bytes."""

    def __init__(self, bar: "Bar", count: int) -> None:
        self._bar, self._count = bar, count
        self._done, self._source, self._told = -1, "", ""

    def tell(self, source: str, phase: str) -> None:
        """Another phase; each recording begins with being read."""
        self._source, self._told = source, phase
        self._done += phase == READING
        self._show(0.0 if phase == READING else 0.5)

    def read(self, done: int, whole: int) -> None:
        """So many bytes of how many were read."""
        self._show(0.5 * done / max(whole, 1))

    def _show(self, share: float) -> None:
        what = f"{self._source}, {self._told}"
        self._bar.advance(what, round((self._done + share) * PIECES), self._count * PIECES)
