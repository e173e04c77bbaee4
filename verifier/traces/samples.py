"""The samples of one topic: its log times, its sensor stamps, and the values at given paths."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import final

import numpy as np

from runtime.arrays import Array, Integers
from verifier.traces.files.log import LATEST, Messages, Sheet
from verifier.traces.messages import json_messages, wire
from verifier.traces.messages.columns import Column, Decoded
from verifier.traces.messages.definitions import Struct
from verifier.traces.messages.fields import FieldError, check, shape, stamp_leaves
from verifier.traces.messages.paths import MessagePath, Steps
from verifier.traces.messages.quaternions import angle
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
    columns: dict[str, Column]
    losses: tuple[Loss, ...]


def check_topic(streams: Sequence[Messages], path: MessagePath) -> FieldError | None:
    """Why the path finds no number in these channels."""
    try:
        for stream in streams:
            check(shape(stream), path)
    except FieldError as error:
        return error
    return None


def sample_topic(streams: Sequence[Messages], paths: Sequence[MessagePath]) -> Samples:
    """The samples of all channels of one topic; raises FieldError."""
    parts = [_sample_stream(stream, paths) for stream in streams]
    if len(parts) == 1:
        return parts[0][0]
    samples = [part for part, _ in parts]
    rows = np.argsort(np.concatenate([places for _, places in parts]))
    stamps = [part.stamps for part in samples if part.stamps is not None]
    return Samples(
        topic=samples[0].topic,
        log_times=np.concatenate([part.log_times for part in samples])[rows],
        stamps=np.concatenate(stamps)[rows] if len(stamps) == len(samples) else None,
        columns={
            path.text: _joined([part.columns[path.text] for part in samples]).rows(rows)
            for path in paths
        },
        losses=tuple(loss for part in samples for loss in part.losses),
    )


def sample_sheet(sheet: Sheet, names: Sequence[str]) -> Samples:
    """The named columns of a CSV file, which has no stamps beside its time column."""
    columns = {name: _numeric(sheet.columns[name]) for name in names}
    return Samples(sheet.name, sheet.times, None, columns, ())


def _sample_stream(stream: Messages, paths: Sequence[MessagePath]) -> tuple[Samples, Integers]:
    """The samples of one channel, and their places in the log."""
    root = shape(stream)
    for path in paths:
        check(root, path)
    stamp = stamp_leaves(root)
    asked = list(dict.fromkeys(leaf for path in paths for leaf in path.leaves))
    if stamp:
        asked += [stamp.seconds, stamp.nanoseconds]
    decoded = _decode(stream, root, asked)
    kept = decoded.readable
    rows = np.flatnonzero(kept)
    found = dict(zip(asked, (one.rows(rows) for one in decoded.columns), strict=True))
    losses = []
    if bad := int((~kept).sum()):
        losses.append(Loss("unreadable messages", bad, f"{stream.channel.topic}: {decoded.reason}"))
    samples = Samples(
        topic=stream.channel.topic,
        log_times=stream.times[kept],
        stamps=_stamps(found[stamp.seconds], found[stamp.nanoseconds]) if stamp else None,
        columns={path.text: _value(path, found) for path in paths},
        losses=tuple(losses),
    )
    return samples, stream.places[kept]


def _decode(stream: Messages, root: Struct, asked: Sequence[Steps]) -> Decoded:
    if stream.channel.encoding == "json":
        return json_messages.decode(stream.payloads, asked)
    return wire.decode(stream.payloads, stream.channel.encoding, root, asked)


def _value(path: MessagePath, found: dict[Steps, Column]) -> Column:
    if not path.derived:
        return found[path.steps]
    x, y, z, w = (found[leaf].numbers for leaf in path.leaves)
    return Column(angle(path.derived, x, y, z, w), None)


def _stamps(seconds: Column, nanoseconds: Column) -> Integers:
    whole = _integers(seconds.numbers)
    return whole * 1_000_000_000 + _integers(nanoseconds.numbers)


def _integers(numbers: Array) -> Integers:
    """Whole numbers; 0 for what is none, or is too large for seconds."""
    safe = np.where(np.isfinite(numbers) & (np.abs(numbers) < LATEST / 1e9), numbers, 0.0)
    return safe.astype(np.int64)


def _joined(parts: Sequence[Column]) -> Column:
    numbers = np.concatenate([part.numbers for part in parts])
    if all(part.texts is None for part in parts):
        return Column(numbers, None)
    texts = [part.texts or (None,) * part.numbers.size for part in parts]
    return Column(numbers, tuple(text for part in texts for text in part))


def _numeric(cells: Sequence[str]) -> Column:
    """Numbers and the texts that they were read from."""
    try:
        numbers = np.array(cells, dtype=np.float64)
    except ValueError:
        numbers = np.array([_number(cell) for cell in cells], dtype=np.float64)
    return Column(numbers, tuple(cells))


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return np.nan
