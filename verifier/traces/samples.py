"""The samples of one topic: its log times, its sensor stamps, and the values at given paths."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import final

import numpy as np

from runtime.arrays import Integers
from verifier.traces.files.log import Messages, Places, Sheet
from verifier.traces.messages.columns import Column, joined
from verifier.traces.messages.fields import FieldError
from verifier.traces.messages.paths import MessagePath
from verifier.traces.trace import Loss


@final
@dataclass(frozen=True, eq=False, slots=True)
class Samples:
    """T samples in the order of the file.

    log_times: (T,) nanoseconds. stamps: (T,) nanoseconds of the sensor, 0 where it gave none;
    None where the messages have no stamp. columns: by the text of the path or column.
    """

    topic: str
    log_times: Integers
    stamps: Integers | None
    columns: Mapping[str, Column]
    losses: tuple[Loss, ...]


def check_topic(streams: Sequence[Messages], path: MessagePath) -> FieldError | None:
    """Why the path finds no number in these channels."""
    for stream in streams:
        if stream.values and path.text in stream.values.faults:
            return stream.values.faults[path.text]
    return None


def sample_topic(streams: Sequence[Messages]) -> Samples:
    """The samples of all channels of one topic, of which values were read."""
    parts = [_sample_stream(stream) for stream in streams]
    if len(parts) == 1:
        return parts[0][0]
    samples = [part for part, _ in parts]
    rows = np.argsort(np.concatenate([places for _, places in parts if places is not None]))
    stamps = [part.stamps for part in samples if part.stamps is not None]
    shared = [text for text in samples[0].columns if all(text in part.columns for part in samples)]
    return Samples(
        topic=samples[0].topic,
        log_times=np.concatenate([part.log_times for part in samples])[rows],
        stamps=np.concatenate(stamps)[rows] if len(stamps) == len(samples) else None,
        columns={
            text: joined([part.columns[text] for part in samples]).rows(rows) for text in shared
        },
        losses=tuple(loss for part in samples for loss in part.losses),
    )


def sample_sheet(sheet: Sheet, names: Sequence[str]) -> Samples:
    """The named columns of a CSV file, which has no stamps beside its time column."""
    columns = {name: sheet.columns[name] for name in names}
    return Samples(sheet.name, sheet.times, None, columns, ())


def _sample_stream(stream: Messages) -> tuple[Samples, Places | None]:
    """The samples of one channel, and their places in the log where others have its topic."""
    values = stream.values
    assert values is not None, "only channels that were read have samples"
    read = values.readable.size
    times = stream.times[:read]
    places = None if stream.places is None else stream.places[:read]
    losses = []
    if bad := read - int(np.count_nonzero(values.readable)):
        losses.append(Loss("unreadable messages", bad, f"{stream.channel.topic}: {values.reason}"))
        times = times[values.readable]
        places = None if places is None else places[values.readable]
    topic = stream.channel.topic
    return Samples(topic, times, values.stamps, values.columns, tuple(losses)), places
