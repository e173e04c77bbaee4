"""Episodes over processes: in the same order, and the same, however many there are."""

import os
import signal
import tempfile
import threading
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import ExitStack
from functools import cache
from multiprocessing import parent_process
from multiprocessing.connection import wait
from pathlib import Path
from types import TracebackType
from typing import Final, Self, final

from runtime.scenario import Scenario
from runtime.scenario_artifact import from_bytes, to_bytes
from specc.faults import fault
from specc.training.episode import Episode, Task, lived

FEWER: Final = "take fewer --jobs; what a folder (-o) keeps goes on with --resume"


@final
class Workers:
    """Lives episodes of one scenario; a context, at whose end its processes are gone.

    They are gone soon, too, where this process is killed: each looks for it.

    Args:
        scenario: one that trains.
        processes: how many; with 1 it is done here.
    """

    def __init__(self, scenario: Scenario, processes: int) -> None:
        self._scenario, self.processes = scenario, processes
        self._open = ExitStack()
        self._pool: ProcessPoolExecutor | None = None
        self._file = Path()

    def __enter__(self) -> Self:
        if self.processes > 1:
            folder = self._open.enter_context(tempfile.TemporaryDirectory(prefix="specc-"))
            self._file = Path(folder) / "scenario.specc"
            self._file.write_bytes(to_bytes(self._scenario))
            pool = ProcessPoolExecutor(self.processes, initializer=_begin)
            self._pool = self._open.enter_context(pool)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._pool is not None and error is not None:
            self._pool.shutdown(wait=False, cancel_futures=True)
        self._open.close()

    def lived(self, tasks: Sequence[Task]) -> Iterator[Episode]:
        """What came of each, in their order, as soon as it is known.

        Raises:
            NoRoomError: there is no room for what is placed at random.
            UserCodeError: the scenario needs Python of the user's own.
            SpecError: a process is gone (V417).
        """
        if self._pool is None:
            yield from (lived(self._scenario, task) for task in tasks)
            return
        try:
            yield from self._pool.map(_lived_there, [self._file] * len(tasks), tasks)
        except BrokenProcessPool as error:
            message = "a process that lived episodes is gone: was it killed, or memory short?"
            raise fault("V417", self._scenario.source.file, message, FEWER) from error


def _lived_there(file: Path, task: Task) -> Episode:
    return lived(_scenario_in(file), task)


@cache
def _scenario_in(file: Path) -> Scenario:
    return from_bytes(file.read_bytes())


def _begin() -> None:
    """Ctrl-C is for the process that waits for this one, and this one ends with that."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = parent_process()
    if parent is not None:
        threading.Thread(target=_end_with, args=(parent.sentinel,), daemon=True).start()


def _end_with(sentinel: int) -> None:
    wait([sentinel])
    os._exit(1)
