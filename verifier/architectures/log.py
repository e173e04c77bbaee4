"""The recording of a scenario, opened: columns of its topics in SI, at instants of the run."""

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Final, TypeAlias, final

import numpy as np

from runtime.arrays import Array, Integers
from runtime.recording.tables import Field
from verifier.traces.files.log import MessageLog, Messages, Progress, Wanted
from verifier.traces.files.open_log import open_log
from verifier.traces.messages.columns import Column
from verifier.traces.messages.paths import parse_path, path_text
from verifier.traces.trace import Loss

NANOSECONDS: Final = 1e9

Topics: TypeAlias = Mapping[str, Sequence[Field]]
"""What is read of which topics."""


@final
class RunLog:
    """A recording of which some topics were read.

    losses: what of the file could not be used, counted by cause.
    """

    def __init__(self, log: MessageLog | None, step: float) -> None:
        """step: of the run's physics (s), on whose multiples everything happens; 0: not known."""
        self._step = step
        self.losses: tuple[Loss, ...] = () if log is None else log.losses
        streams = () if log is None else log.streams
        self._streams = {s.channel.topic: s for s in reversed(streams) if s.values is not None}

    def columns(self, topic: str, fields: Sequence[Field]) -> tuple[Array, dict[str, Array]]:
        """The times of a topic's messages, strictly increasing, and its fields in SI.

        Empty where the recording has not all of them.
        """
        empty = np.zeros(0), {field.name: np.zeros(0) for field in fields}
        stream = self._streams.get(topic)
        if stream is None or stream.values is None:
            return empty
        readable = np.flatnonzero(stream.values.readable)
        times, rows = np.unique(self._times(stream, readable), return_index=True)
        found = {}
        for field in fields:
            column = stream.values.columns.get(path_text(topic, (field.name,)))
            if column is None:
                return empty
            found[field.name] = _in_si(field, column)[rows]
        return times, found

    def _times(self, stream: Messages, readable: Integers) -> Array:
        seconds = stream.times[: readable.max(initial=-1) + 1][readable] / NANOSECONDS
        if not self._step:
            return np.asarray(seconds)
        # Stamps are whole nanoseconds; the run's own instants are multiples of its step.
        instants = np.rint(seconds / self._step) * self._step
        return np.where(np.abs(instants - seconds) <= 1.0 / NANOSECONDS, instants, seconds)


def together(wanted: Iterable[Topics]) -> dict[str, list[Field]]:
    """All that is read: each field of a topic once, by its name."""
    found: dict[str, dict[str, Field]] = {}
    for topics in wanted:
        for topic, fields in topics.items():
            known = found.setdefault(topic, {})
            for field in fields:
                known.setdefault(field.name, field)
    return {topic: list(known.values()) for topic, known in found.items()}


def open_run(
    path: Path, topics: Topics, step: float = 0.0, reading: Progress | None = None
) -> RunLog:
    """The recording with these topics read; step: of its physics, in seconds.

    Raises:
        SpecError: the recording can't be opened (V301, V302).
    """
    paths = {
        topic: tuple(parse_path(path_text(topic, (field.name,))) for field in fields)
        for topic, fields in topics.items()
        if fields
    }
    wanted = Wanted(paths, frozenset())
    log = open_log(path, wanted) if reading is None else open_log(path, wanted, reading)
    return RunLog(log if isinstance(log, MessageLog) else None, step)


def _in_si(field: Field, column: Column) -> Array:
    if field.labels and column.texts is not None:
        places = {label: float(place) for place, label in enumerate(field.labels)}
        return np.array([places.get(text or "", np.nan) for text in column.texts])
    return column.numbers * field.unit.scale
