"""Which time a sample is of: the sensor's stamp or the log's, one choice for a whole trace.

Sensor stamps are better, where there are any: log times hold the delays of transport, and
recorders deliver in batches. But the two clocks can be far apart (simulated time is 1.8e9 s off
the wall's), and then stamps of one topic can't stand beside log times of another.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import final

import numpy as np

from runtime.arrays import Integers
from verifier.traces.samples import Samples

SAME_CLOCK = 1.0
"""Seconds. Stamps further than this from the log's time are of another clock."""

ENOUGH = 100_000


@final
class Clock(StrEnum):
    """Which stamp of a message is its time."""

    SENSOR = "sensor"
    LOG = "log"


@final
@dataclass(frozen=True, slots=True)
class Offset:
    """Log time minus sensor stamp, in seconds: the median, and half the span of the middle 90 %."""

    median: float
    spread: float


@final
@dataclass(frozen=True, slots=True)
class Clocks:
    """The clock of each topic, and in sentences why."""

    of: dict[str, Clock]
    notes: tuple[str, ...]


def choose_clocks(topics: Sequence[Samples], wish: str) -> Clocks:
    """The clock of each topic; `wish` is `auto`, `sensor` or `log`.

    `auto` takes sensor stamps where they can be used and all times stay on one clock.
    """
    if wish == "log":
        return Clocks({samples.topic: Clock.LOG for samples in topics}, ())
    faults = {samples.topic: stamp_fault(samples) for samples in topics}
    offsets = {s.topic: offset(s) for s in topics if not faults[s.topic]}
    notes = [_offset_note(topic, found) for topic, found in offsets.items()]
    if wish == "auto" and (reason := _apart(topics, offsets)):
        notes.append(f"log times are used for every topic: {reason}")
        return Clocks({samples.topic: Clock.LOG for samples in topics}, tuple(notes))
    of = {s.topic: Clock.SENSOR if s.topic in offsets else Clock.LOG for s in topics}
    notes += [f"{topic}: log times ({fault})" for topic, fault in faults.items() if fault]
    return Clocks(of, tuple(notes))


def stamp_fault(samples: Samples) -> str:
    """Why the topic's stamps can't be its times; empty where they can."""
    if samples.stamps is None:
        return "no sensor stamps"
    stamps, logs = _given(samples.stamps, samples.log_times)
    if stamps.size < 0.5 * samples.stamps.size or not stamps.size:
        return "most sensor stamps are zero"
    steps = stamps.size - 1
    if steps and np.count_nonzero(stamps[1:] > stamps[:-1]) < 0.8 * steps:
        return "sensor stamps stand still or run backwards"
    span, logged = _span(stamps), _span(logs)
    if logged > 0 and steps > 10 and not 0.8 < span / logged < 1.25:
        return f"sensor stamps span {span:.3g} s, log times {logged:.3g} s"
    return ""


def offset(samples: Samples) -> Offset:
    """How much later than its stamp a message of this topic was logged."""
    assert samples.stamps is not None, "only topics with stamps have an offset"
    stamps, logs = _given(samples.stamps, samples.log_times)
    late = (_thinned(logs) - _thinned(stamps)).astype(np.float64) / 1e9
    low, median, high = np.percentile(late, (5.0, 50.0, 95.0))
    return Offset(float(median), float(high - low) / 2.0)


def _given(stamps: Integers, logs: Integers) -> tuple[Integers, Integers]:
    """The stamps that are there, and the log times beside them; no copies where all are."""
    given = stamps > 0
    return (stamps, logs) if given.all() else (stamps[given], logs[given])


def _span(times: Integers) -> float:
    some = _thinned(times)
    return float(np.percentile(some, 95) - np.percentile(some, 5)) / 1e9


def _thinned(times: Integers) -> Integers:
    """Some of very many times, evenly chosen: percentiles need no more."""
    return times[:: max(1, times.size // ENOUGH)]


def _apart(topics: Sequence[Samples], offsets: dict[str, Offset]) -> str:
    """Why stamps would put the topics on different clocks; empty where they don't."""
    medians = [found.median for found in offsets.values()]
    unstamped = [samples.topic for samples in topics if samples.topic not in offsets]
    if medians and unstamped and max(map(abs, medians)) > SAME_CLOCK:
        far = max(medians, key=abs)
        return f"{unstamped[0]} has no usable stamps and the stamps of others are {far:.6g} s off"
    if medians and max(medians) - min(medians) > SAME_CLOCK:
        return f"sensor stamps of the topics are {max(medians) - min(medians):.6g} s apart"
    return ""


def _offset_note(topic: str, found: Offset) -> str:
    late = f"{found.median * 1e3:.3g} ms" if abs(found.median) < 1.0 else f"{found.median:.6g} s"
    spread = f"± {found.spread * 1e3:.3g} ms"
    return f"{topic}: logged {late} after the sensor stamp at the median ({spread})"
