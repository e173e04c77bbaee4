"""Several logs of one arbiter judged together: their decisions added up, their thresholds met.

Decisions of different logs are independent, so the numbers of decisions that would tell as much
add up, and so do those that agree. A threshold lies where no log shows it to be worse.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from verifier.arbitration.judging import VERDICTS
from verifier.arbitration.regions import standing_of
from verifier.arbitration.saying import CONFIDENCE, reasons_of, threshold_sentence
from verifier.arbitration.shares import interval_of
from verifier.report.arbitration import Arbitration, Share, Threshold, ThresholdStanding
from verifier.report.examination import Examination
from verifier.report.report import Interval, Report, TraceIdentity
from verifier.report.wording import LEFT_OUT, exact, listed


def pooled_decisions(every: Sequence[Examination]) -> Examination:
    """What two logs or more of one arbiter show together; regions stay with each log.

    One that is there twice counts once, whatever it is called.
    """
    every, left = _distinct(every)
    sections = [each.arbitration for each in every if each.arbitration is not None]
    first, reports = sections[0], [each.report for each in every]
    share = _share([each.share for each in sections])
    standing = standing_of(share.interval.low, share.interval.high, first.required)
    thresholds = tuple(_met(alike) for alike in zip(*(s.thresholds for s in sections), strict=True))
    section = replace(
        first,
        share=share,
        changes=sum(each.changes for each in sections),
        confusion=np.sum([each.confusion for each in sections], axis=0),
        cells=(),
        boxes=(),
        thresholds=thresholds,
        delay=0,
        explanations=(),
        strays=(),
        unexplained=sum(each.unexplained for each in sections),
    )
    told = _sentences(thresholds, sections)
    reasons, advice = reasons_of(section, VERDICTS[standing])
    report = replace(
        reports[0],
        verdict=VERDICTS[standing],
        reasons=(*reasons[:1], *told, *left),
        advice=advice,
        exclusions=(),
        losses=tuple(loss for each in reports for loss in each.losses),
        notes=(),
        trace=_identity(reports),
        starts=np.concatenate([each.starts for each in reports]),
    )
    return Examination(
        report, origins=every[0].origins, arbitration=replace(section, sentences=told)
    )


def _distinct(every: Sequence[Examination]) -> tuple[list[Examination], list[str]]:
    """Each log once, and a sentence on each that is left out."""
    kept: dict[str, Examination] = {}
    left = []
    for each in every:
        trace = each.report.trace
        if kept.setdefault(trace.content or trace.source, each) is not each:
            left.append(f"{trace.source}{LEFT_OUT}it is there twice")
    return list(kept.values()), left


def _share(shares: Sequence[Share]) -> Share:
    agreeing, decisions = (sum(s.agreeing for s in shares), sum(s.decisions for s in shares))
    effective = sum(each.effective for each in shares if each.decisions)
    if not decisions:
        return Share(0, 0, 0.0, Interval(0.0, 1.0))
    interval = interval_of(agreeing / decisions, max(effective, 1.0), CONFIDENCE)
    return Share(agreeing, decisions, effective, interval)


def _met(alike: Sequence[Threshold]) -> Threshold:
    """One threshold as all logs leave it: within all of their intervals."""
    first = alike[0]
    low = max(each.interval.low for each in alike)
    high = min(each.interval.high for each in alike)
    if low > high:  # the logs contradict one another
        return first
    standing = ThresholdStanding.KEPT
    if not low <= first.value <= high:
        standing = ThresholdStanding.MOVED
    elif all(each.standing is ThresholdStanding.UNTOLD for each in alike):
        standing = ThresholdStanding.UNTOLD
    inside = [each.fitted for each in alike if low <= each.fitted <= high]
    fitted = inside[0] if inside else 0.5 * (low + high)
    return replace(first, interval=Interval(low, high), fitted=fitted, standing=standing)


def _sentences(thresholds: Sequence[Threshold], sections: Sequence[Arbitration]) -> tuple[str, ...]:
    """Where the logs have thresholds together, and where they contradict one another."""
    told = [
        threshold_sentence(each) for each in thresholds if each.standing is ThresholdStanding.MOVED
    ]
    for alike in zip(*(section.thresholds for section in sections), strict=True):
        low = max(each.interval.low for each in alike)
        high = min(each.interval.high for each in alike)
        if low > high:
            values = listed([exact(each.fitted, each.unit) for each in alike])
            told.append(f"the logs contradict one another about {alike[0].name}: {values}")
    return tuple(told)


def _identity(reports: Sequence[Report]) -> TraceIdentity:
    traces = [each.trace for each in reports]
    return TraceIdentity(
        source="1 recording" if len(traces) == 1 else f"{len(traces)} recordings together",
        start=min(each.start for each in traces),
        duration=sum(each.duration for each in traces),
        judged=sum(each.judged for each in traces),
    )
