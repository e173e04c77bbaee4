"""Where in the space of what is read decisions agree: cells of the thresholds, and a k-d grid."""

from collections.abc import Iterator, Sequence
from typing import Final

import numpy as np

from runtime.arbiter import Arbiter, Read
from runtime.arrays import Array, Booleans, Integers
from runtime.machine import evaluate
from verifier.arbitration.choosing import RuleChooser
from verifier.arbitration.comparisons import COMPARING, Comparison, infix
from verifier.arbitration.decisions import Decisions
from verifier.arbitration.shares import share_of
from verifier.report.arbitration import Region
from verifier.report.report import Standing
from verifier.report.wording import exact, span

SMALLEST_BOX: Final = 150
"""Decisions; a box of fewer is not divided."""
DEEPEST: Final = 4
OPPOSITE: Final = {"lt": ">=", "le": ">", "gt": "<=", "ge": "<"}


def standing_of(low: float, high: float, required: float) -> Standing:
    """Where an interval of shares stands."""
    if low >= required:
        return Standing.WITHIN
    return Standing.EXCEEDED if high < required else Standing.UNDECIDED


def cells(
    arbiter: Arbiter,
    chooser: RuleChooser,
    decisions: Decisions,
    agrees: Booleans,
    slowness: float,
    confidence: float,
) -> tuple[Region, ...]:
    """The parts into which the thresholds divide what was read, the worst first."""
    told = tuple({each.text: each for each in chooser.opened.comparisons}.values())
    if not told:
        return ()
    judged = np.flatnonzero(decisions.judged)
    readings = evaluate([c.reading for c in told], arbiter.register, decisions.register[judged])
    truths = np.stack(
        [_compared(c, readings[:, i], chooser.values[c.entry]) for i, c in enumerate(told)], axis=1
    )
    kinds, of_kind = np.unique(truths, axis=0, return_inverse=True)
    found = [
        _region(
            _phrases(arbiter, told, kind, chooser),
            judged[of_kind.reshape(-1) == i],
            agrees,
            slowness,
            confidence,
            arbiter,
        )
        for i, kind in enumerate(kinds)
    ]
    return _worst_first(found)


def boxes(
    arbiter: Arbiter,
    decisions: Decisions,
    agrees: Booleans,
    slowness: float,
    confidence: float,
) -> tuple[Region, ...]:
    """The parts of a k-d tree over what was read, the worst first."""
    places = np.flatnonzero(decisions.judged)
    reads = [i for i, read in enumerate(arbiter.reads) if not read.values]
    if not reads or not places.size:
        return ()
    found = []
    for members in _divided(decisions, places, reads, DEEPEST):
        ranges = decisions.register[members][:, reads]
        phrases = tuple(
            _ranged(arbiter.reads[i], float(ranges[:, k].min()), float(ranges[:, k].max()))
            for k, i in enumerate(reads)
        )
        found.append(_region(phrases, members, agrees, slowness, confidence, arbiter))
    return _worst_first(found)


def _divided(
    decisions: Decisions, places: Integers, reads: Sequence[int], depth: int
) -> Iterator[Integers]:
    values = decisions.register[places][:, reads]
    ranks = np.ptp(values, axis=0) / np.maximum(np.ptp(decisions.register[:, reads], axis=0), 1e-30)
    axis = int(np.argmax(ranks))
    cut = float(np.median(values[:, axis]))
    below = values[:, axis] <= cut
    if places.size < 2 * SMALLEST_BOX or depth == 0 or below.all():
        yield places
        return
    yield from _divided(decisions, places[below], reads, depth - 1)
    yield from _divided(decisions, places[~below], reads, depth - 1)


def _region(
    phrases: tuple[str, ...],
    members: Integers,
    agrees: Booleans,
    slowness: float,
    confidence: float,
    arbiter: Arbiter,
) -> Region:
    share = share_of(agrees[members], slowness, confidence)
    required = 1.0 if arbiter.agreement is None else arbiter.agreement.share
    standing = standing_of(share.interval.low, share.interval.high, required)
    return Region(phrases, share, standing)


def _worst_first(regions: Sequence[Region]) -> tuple[Region, ...]:
    order = {Standing.EXCEEDED: 0, Standing.UNDECIDED: 1, Standing.WITHIN: 2}
    return tuple(
        sorted(
            regions,
            key=lambda r: (order[r.standing], r.share.agreeing - r.share.decisions),
        )
    )


def _compared(comparison: Comparison, readings: Array, value: float) -> Booleans:
    match comparison.word:
        case "lt":
            return readings < value
        case "le":
            return readings <= value
        case "gt":
            return readings > value
        case _:
            return readings >= value


def _phrases(
    arbiter: Arbiter, told: Sequence[Comparison], kind: Booleans, chooser: RuleChooser
) -> tuple[str, ...]:
    """`front > 0.9 m` for each reading and side: of several comparisons the one that says most."""
    units = {read.name: read.unit for read in arbiter.reads}
    phrases: dict[tuple[str, bool], tuple[float, str]] = {}
    for comparison, holds in zip(told, kind, strict=True):
        names = [name for name in comparison.reading.tokens if name in units]
        value = chooser.values[comparison.entry]
        sign = COMPARING[comparison.word] if holds else OPPOSITE[comparison.word]
        phrase = f"{infix(comparison.reading)} {sign} {exact(value, units[names[0]])}"
        is_upper = sign[0] == "<"
        side, tightness = (comparison.reading.text, is_upper), -value if is_upper else value
        if side not in phrases or tightness > phrases[side][0]:
            phrases[side] = (tightness, phrase)
    order = list(dict.fromkeys(reading for reading, _ in phrases))
    beside = sorted(phrases, key=lambda side: order.index(side[0]))
    return tuple(phrases[side][1] for side in beside)


def _ranged(read: Read, low: float, high: float) -> str:
    return f"{read.name} {span(low, high, read.unit)}"
