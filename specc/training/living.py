"""Episodes lived one after the other, and told."""

from collections.abc import Sequence

from runtime.progress import Progress
from specc.training.episode import Episode, Task
from specc.training.workers import Workers


def live_through(
    workers: Workers, tasks: Sequence[Task], what: str, tell: Progress
) -> list[Episode]:
    """All episodes, in their order; `tell` is told `what`, how many are done, and of how many."""
    episodes: list[Episode] = []
    tell(what, 0, len(tasks))
    for episode in workers.lived(tasks):
        episodes.append(episode)
        tell(what, len(episodes), len(tasks))
    return episodes
