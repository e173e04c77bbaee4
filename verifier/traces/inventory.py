"""What a log holds: topics, rates, and the paths of all numbers with what they look like."""

from dataclasses import dataclass
from pathlib import Path
from typing import final

import numpy as np

from runtime.arrays import Array, Integers
from verifier.traces.clock import stamp_fault
from verifier.traces.files.log import MessageLog, Sheet, Wanted
from verifier.traces.files.open_log import attached_program, open_log
from verifier.traces.messages.columns import Column
from verifier.traces.messages.paths import column_text
from verifier.traces.samples import Samples, sample_sheet, sample_topic
from verifier.traces.trace import Loss

BYTES_PER_TOPIC = 1 << 25
MOST_TEXTS = 20
MOST_CODES = 8
MOST_LOOKED_AT = 1000
"""Numbers, before all of a column are sorted."""


@final
@dataclass(frozen=True, slots=True)
class FieldInfo:
    """One value of a topic's messages; `path` is written as a spec's `trace:` block wants it.

    first, low, high: of the sampled numbers in SI or as logged; None for a text, or where no
    number was finite. texts: the distinct texts, sorted. codes: the distinct numbers, sorted,
    where they are few and whole. wraps: how often the number jumps over most of its range.
    """

    path: str
    first: float | None
    low: float | None
    high: float | None
    texts: tuple[str, ...]
    codes: tuple[int, ...] = ()
    wraps: int = 0

    @property
    def is_text(self) -> bool:
        """Whether the field holds texts."""
        return bool(self.texts)


@final
@dataclass(frozen=True, slots=True)
class TopicInfo:
    """A topic; a CSV file is one topic without a name.

    rate: messages a second by the median step, of sensor stamps where they can be used; 0 for
    fewer than two. duration: seconds from the first to the last. note: why it has no fields.
    """

    name: str
    message_type: str
    encoding: str
    count: int
    rate: float
    duration: float
    fields: tuple[FieldInfo, ...]
    note: str


@final
@dataclass(frozen=True, slots=True)
class Inventory:
    """A log's content. start: seconds since 1970 (of a CSV: its first time); size in bytes.

    attached: the name of the compiled spec that the file carries, or empty.
    """

    source: str
    kind: str
    start: float
    duration: float
    messages: int
    size: int
    attached: str
    topics: tuple[TopicInfo, ...]
    losses: tuple[Loss, ...]
    notes: tuple[str, ...]


def inspect(path: Path) -> Inventory:
    """What the log at `path` holds; raises SpecError V301, V302 or V309."""
    log = open_log(path, Wanted(None, None, BYTES_PER_TOPIC))
    if isinstance(log, Sheet):
        topics: tuple[TopicInfo, ...] = (_sheet_info(log),)
        times, kind = log.times, "CSV"
    else:
        topics = tuple(_topic_info(log, topic) for topic in log.topics)
        times = np.concatenate([np.zeros(0, np.int64), *(s.times for s in log.streams)])
        kind = log.kind
    attached = attached_program(path)
    return Inventory(
        source=str(path),
        kind=kind,
        start=float(times.min()) / 1e9 if times.size else 0.0,
        duration=_span(times),
        messages=times.size,
        size=_size(path),
        attached=attached[0] if attached else "",
        topics=topics,
        losses=log.losses,
        notes=log.notes,
    )


def _topic_info(log: MessageLog, topic: str) -> TopicInfo:
    streams = [stream for stream in log.streams if stream.channel.topic == topic]
    # Channels of one topic nearly always have one type; the fields are those of the first.
    first = next((stream for stream in streams if stream.count), streams[0])
    times = np.concatenate([stream.times for stream in streams])
    fields: tuple[FieldInfo, ...] = ()
    rate, note = _rate(times), ""
    values = first.values
    if values is not None and values.fault:
        note = values.fault.message
    elif values is not None:
        samples = sample_topic([first])
        fields = _field_infos(samples)
        if samples.stamps is not None and not stamp_fault(samples):
            rate = _rate(samples.stamps)
        if values.readable.size < first.count:
            note = f"values of the first {values.readable.size} messages"
    return TopicInfo(
        name=topic,
        message_type=first.channel.message_type,
        encoding=first.channel.encoding,
        count=times.size,
        rate=rate,
        duration=_span(times),
        fields=fields,
        note=note,
    )


def _sheet_info(sheet: Sheet) -> TopicInfo:
    names = [name for name in sheet.columns if name != sheet.time_column]
    samples = sample_sheet(sheet, names)
    columns = {column_text(name): samples.columns[name] for name in names}
    return TopicInfo(
        name="",
        message_type="",
        encoding="csv",
        count=sheet.times.size,
        rate=_rate(sheet.times),
        duration=_span(sheet.times),
        fields=tuple(_field_info(path, column) for path, column in columns.items()),
        note="",
    )


def _field_infos(samples: Samples) -> tuple[FieldInfo, ...]:
    """All fields but the items that no list in the sample is long enough for."""
    infos = (_field_info(path, column) for path, column in samples.columns.items())
    return tuple(i for i in infos if i.first is not None or i.is_text or "[" not in i.path)


def _field_info(path: str, column: Column) -> FieldInfo:
    numbers = column.numbers[np.isfinite(column.numbers)]
    if numbers.size:
        first, low, high = float(numbers[0]), float(numbers.min()), float(numbers.max())
        return FieldInfo(path, first, low, high, (), _codes(numbers), _wraps(numbers))
    distinct = tuple(sorted({text for text in column.texts or () if text})[:MOST_TEXTS])
    return FieldInfo(path, None, None, None, distinct)


def _codes(numbers: Array) -> tuple[int, ...]:
    """The distinct numbers where they are few and whole, else nothing."""
    head = np.unique(numbers[:MOST_LOOKED_AT])
    if head.size > MOST_CODES or (head != np.round(head)).any():
        return ()
    distinct = np.unique(numbers)
    is_few = distinct.size <= MOST_CODES and bool((distinct == np.round(distinct)).all())
    return tuple(int(number) for number in distinct) if is_few else ()


def _wraps(numbers: Array) -> int:
    """How often the number jumps over nine tenths of its range, as an angle on the circle does."""
    with np.errstate(over="ignore", invalid="ignore"):
        return int(np.count_nonzero(np.abs(np.diff(numbers)) > 0.9 * np.ptp(numbers)))


def _rate(times: Integers) -> float:
    """One over the median step of `times` (nanoseconds), in Hz."""
    steps = np.diff(np.sort(times))
    median = float(np.median(steps)) if steps.size else 0.0
    return 1e9 / median if median > 0.0 else 0.0


def _span(times: Integers) -> float:
    return float(times.max() - times.min()) / 1e9 if times.size else 0.0


def _size(path: Path) -> int:
    files = path.iterdir() if path.is_dir() else [path]
    return sum(file.stat().st_size for file in files if file.is_file())
