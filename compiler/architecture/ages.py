"""How old what a node reads can be when it samples it: sensors say late, and nodes answer late."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import final

from compiler.architecture.parts import Parts
from compiler.architecture.times import common, exact
from runtime.architecture import Input, Signal


@final
@dataclass(frozen=True, slots=True)
class Age:
    """How long ago (s) a reading was sampled, at the most, and the sensor that sampled it.

    through: the nodes that passed it on, the last first.
    """

    seconds: float = 0.0
    sensor: str = ""
    through: tuple[str, ...] = ()


@final
@dataclass(frozen=True, eq=False, slots=True)
class Readings:
    """What is needed to tell ages: every wire, every signal, and who says it how often."""

    inputs: Mapping[str, tuple[Input, ...]]
    signals: Sequence[Signal]
    parts: Parts


def at_a_tick(every: float, latency: float, period: float) -> float:
    """The age of what was said last, at the ticks of a node at which it is the oldest.

    It is sampled at each multiple of `every` and said `latency` later; all begins at 0. What
    both periods share says which phases they ever have to one another.

    >>> round(at_a_tick(0.05, 0.0, 0.1), 3), round(at_a_tick(0.05, 0.02, 0.05), 3)
    (0.0, 0.05)
    >>> round(at_a_tick(0.05, 0.0, 0.03), 3)
    0.04
    """
    if every == 0.0 or period == 0.0:
        return latency
    rate, late = exact(every), exact(latency)
    shared = common((rate, exact(period)))
    first = (-late) % shared if shared else Fraction(0)
    return float(late + rate - shared + first)


def age_of(node: str, entries: Iterable[str], period: float, readings: Readings) -> Age:
    """The age of the oldest reading that leads to one of the `entries` of a node.

    Through nodes, too: what they say is as old as what they read, and their response time.
    """
    return _oldest(node, frozenset(entries), period, readings, (node,))


def _oldest(
    node: str,
    entries: frozenset[str] | None,
    period: float,
    readings: Readings,
    way: tuple[str, ...],
) -> Age:
    """Of all entries for None; a node that is already on the way is not gone through again."""
    sensors = () if readings.parts.body is None else readings.parts.body.body.sensors
    found = [Age()]
    for wire in readings.inputs[node]:
        if wire.signal < 0 or (entries is not None and wire.entry not in entries):
            continue
        owner = readings.signals[wire.signal].name.partition(".")[0]
        found += [
            Age(at_a_tick(s.every, s.latency, period), s.name) for s in sensors if s.name == owner
        ]
        teller = readings.parts.nodes.get(owner)
        if teller is not None and owner not in way and teller.period > 0.0:
            before = _oldest(owner, None, teller.period, readings, (*way, owner))
            if before.sensor:
                passed = at_a_tick(teller.period, teller.response_time, period)
                found.append(Age(before.seconds + passed, before.sensor, (owner, *before.through)))
    return max(found, key=lambda age: age.seconds)
