"""The changes of mode of several recordings, for their common verdict.

A recording that is shown to change its mode otherwise fails by itself. Else the switches of all
recordings are judged at once, way by way, with the statistics that one recording is judged with.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from verifier.fidelity.switching import sentences
from verifier.fidelity.switching.means import Mean, mean_of, standings_of
from verifier.fidelity.switching.verdict import with_switching
from verifier.report.report import Report, Standing
from verifier.report.switching import Jump, Sample, Switching, Timing, Way

WORST: Final = (Standing.EXCEEDED, Standing.UNDECIDED, Standing.WITHIN)
ROUNDING: Final = 1e-9
"""Of what is allowed: so little is no difference."""


def with_every_switching(
    report: Report, switchings: Sequence[tuple[str, Switching | None]]
) -> Report:
    """The report, its verdict no better than the changes of mode of all recordings allow.

    Those that took no way have no say, but where no recording took one, nothing is decided.
    """
    told = [(source, each) for source, each in switchings if each is not None]
    spoken = [(source, each) for source, each in told if _has_taken(each)] or told[:1]
    exceeded = [(s, each) for s, each in spoken if each.standing is Standing.EXCEEDED]
    if not exceeded and len(spoken) > 1 and (joined := _joined([each for _, each in spoken])):
        is_within = joined.standing is Standing.WITHIN
        return report if is_within else with_switching(report, joined, ())
    for source, each in exceeded or spoken:
        if each.standing is not Standing.WITHIN:
            reasons = tuple(f"{source}: {reason}" for reason in each.reasons)
            report = with_switching(report, replace(each, reasons=reasons), ())
    return report


def _joined(every: Sequence[Switching]) -> Switching | None:
    """The switches of all recordings as those of one; None where one does not tell its ways."""
    first = every[0]
    if any(len(each.ways) != len(first.ways) or not each.ways for each in every):
        return None
    alike = list(zip(*(each.ways for each in every), strict=True))
    if any(way.expected and way.timing is None and not way.jumps for ways in alike for way in ways):
        return None  # what is known of it is known recording by recording
    means = [_means(ways) for ways in alike]
    flat = [mean for timing, jumps in means for mean in (timing, *jumps) if mean is not None]
    standings = dict(zip(map(id, flat), standings_of(flat), strict=True))
    ways = tuple(
        _way(ways, timing, jumps, standings)
        for ways, (timing, jumps) in zip(alike, means, strict=True)
    )
    taken = {way.standing for way in ways if way.expected}
    standing = next((each for each in WORST if each in taken), Standing.UNDECIDED)
    return Switching(
        mode=first.mode,
        ways=ways,
        switches=(),
        standing=standing,
        reasons=sentences.reasons(first.mode, ways, ()),
        advice=sentences.advice(ways, ()),
    )


def _means(ways: Sequence[Way]) -> tuple[Mean | None, tuple[Mean, ...]]:
    """Of one way in all recordings: how late it is taken, and the jump of each state."""
    timings = [way.timing for way in ways if way.timing is not None]
    timing = None
    if timings:
        allowed = float(np.median([each.allowed for each in timings]))
        # In shares of what each recording allows: guards are not approached equally fast.
        timing = _mean([(each.sample, allowed / each.allowed) for each in timings], allowed)
    jumps = tuple(
        _mean([(each.sample, 1.0) for each in alike], alike[0].tolerance) for alike in _jumps(ways)
    )
    return timing, jumps


def _jumps(ways: Sequence[Way]) -> list[list[Jump]]:
    """The jumps of each state, in the recordings that have them."""
    found: dict[str, list[Jump]] = {}
    for jump in (each for way in ways for each in way.jumps):
        found.setdefault(jump.name, []).append(jump)
    return list(found.values())


def _mean(samples: Sequence[tuple[Sample, float]], allowed: float) -> Mean:
    """The mean over all samples, each with its scale."""
    values = np.concatenate([scale * np.array(each.values) for each, scale in samples])
    deviations = np.concatenate([scale * np.array(each.deviations) for each, scale in samples])
    values = np.where(np.abs(values) <= ROUNDING * allowed, 0.0, values)
    bias = max(scale * each.bias for each, scale in samples)
    return mean_of(values, deviations, allowed, bias)


def _way(
    ways: Sequence[Way],
    timing: Mean | None,
    jumps: Sequence[Mean],
    standings: dict[int, Standing],
) -> Way:
    first = next((way for way in ways if way.timing is not None), ways[0])
    own = tuple(
        replace(
            alike[0],
            count=mean.count,
            error=mean.mean,
            interval=mean.interval,
            standing=standings[id(mean)],
            sample=mean.sample,
        )
        for alike, mean in zip(_jumps(ways), jumps, strict=True)
    )
    found = {each.standing for each in own} | ({standings[id(timing)]} if timing else set())
    return replace(
        first,
        expected=sum(way.expected for way in ways),
        timing=_timing(first.timing, timing, standings),
        jumps=own,
        standing=next((each for each in WORST if each in found), Standing.UNDECIDED),
    )


def _timing(
    like: Timing | None, mean: Mean | None, standings: dict[int, Standing]
) -> Timing | None:
    if like is None or mean is None:
        return None
    return replace(
        like,
        count=mean.count,
        late=mean.mean,
        interval=mean.interval,
        allowed=mean.allowed,
        standing=standings[id(mean)],
        sample=mean.sample,
    )


def _has_taken(switching: Switching) -> bool:
    counts = (w.expected + w.unexpected + w.missed + w.wrong for w in switching.ways)
    return bool(switching.switches) or any(counts)
