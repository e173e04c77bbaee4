"""A robot's decisions held against an arbiter's spec: the verdict, and what explains it."""

from dataclasses import dataclass, replace
from hashlib import blake2b
from typing import Final, final

import numpy as np

from runtime.arbiter import Arbiter, Paradigm
from runtime.arrays import Booleans, Integers
from verifier.arbitration.choosing import Chooser, RuleChooser, rule_chooser
from verifier.arbitration.comparisons import opened
from verifier.arbitration.decisions import Decisions, decisions_of
from verifier.arbitration.explaining import can_move, explained_by, strays_of, thresholds_of
from verifier.arbitration.numbers import (
    MOVABLE,
    Running,
    chooser_of,
    numbers_of,
    slowness_of_numbers,
)
from verifier.arbitration.planted import slowness_at_limit
from verifier.arbitration.refitting import Scales, later
from verifier.arbitration.regions import boxes, cells, standing_of
from verifier.arbitration.saying import CONFIDENCE, reasons_of, sentences_of
from verifier.arbitration.shares import share_of, slowness_of_choices
from verifier.report.arbitration import Arbitration, Explanation, Region, Threshold
from verifier.report.examination import Depth
from verifier.report.report import (
    Report,
    SpecIdentity,
    Standing,
    TraceIdentity,
    Verdict,
)
from verifier.traces.trace import Trace

AGREED: Final = 0.98
"""The share of decisions that must agree where an arbiter does not say."""
TOO_MANY: Final = (
    "its {} thresholds are too many to be moved one by one: "
    "where decisions differ is told, not which number would make them agree"
)
VERDICTS: Final = {
    Standing.WITHIN: Verdict.PASS,
    Standing.EXCEEDED: Verdict.FAIL,
    Standing.UNDECIDED: Verdict.INCONCLUSIVE,
}


@final
@dataclass(frozen=True, eq=False, slots=True)
class Arbitrated:
    """The report with its verdict, and the section that explains it."""

    report: Report
    section: Arbitration


def judge_arbiter(
    arbiter: Arbiter, trace: Trace, running: Running | None = None, *, depth: Depth = "all"
) -> Arbitrated:
    """Hold the decisions in `trace` against `arbiter`.

    running: makes one that decides tick by tick, of an arbiter that is no rules.

    Raises:
        SpecError: the choice, or something that is read, is not in the log (V310).
    """
    decisions = decisions_of(arbiter, trace)
    rules = _rules(arbiter, decisions)
    required = _required(arbiter)
    chooser: Chooser
    if rules is not None:
        chooser = rules
    else:
        assert running is not None, "an arbiter without rules has to run"
        chooser = chooser_of(arbiter, running)
    expected = chooser(decisions)
    agrees = (expected == decisions.chosen) & decisions.judged
    slowness = slowness_of_choices(decisions.chosen[decisions.judged], len(arbiter.choices))
    if rules is not None:
        slowness = min(slowness, slowness_at_limit(rules, decisions, required))
    elif running is not None and arbiter.paradigm in MOVABLE:
        slowness = min(slowness, slowness_of_numbers(arbiter, running, decisions, required))
    scales = Scales(slowness, CONFIDENCE)
    explained = None
    is_told = bool(decisions.judged.any()) and _asks_why(depth, agrees, decisions)
    if is_told and rules is not None:
        explained = _by_rules(arbiter, rules, decisions, agrees, scales)
    elif is_told and running is not None and arbiter.paradigm in MOVABLE:
        explained = _by_numbers(arbiter, running, decisions, agrees, scales)
    section = _section(arbiter, rules, decisions, expected, agrees, scales, explained)
    standing = standing_of(section.share.interval.low, section.share.interval.high, required)
    report = _report(arbiter, trace, decisions, section, VERDICTS[standing])
    if is_told and rules is not None and not can_move(rules):
        report = replace(report, notes=(*report.notes, TOO_MANY.format(len(rules.values))))
    return Arbitrated(report, section)


def _asks_why(depth: Depth, agrees: Booleans, decisions: Decisions) -> bool:
    """Whether decisions are explained: where that is wanted, and there is something to explain."""
    differs = bool(np.any(decisions.judged & ~agrees))
    return depth == "all" or (depth == "reasons" and differs)


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Told:
    """What explains decisions that differ: decided by `chooser`, `delay` samples later."""

    thresholds: tuple[Threshold, ...]
    chooser: Chooser
    delay: int
    agrees: Booleans
    tried: tuple[Explanation, ...]


def _by_rules(
    arbiter: Arbiter, rules: RuleChooser, decisions: Decisions, agrees: Booleans, scales: Scales
) -> _Told:
    found = explained_by(arbiter, rules, decisions, agrees, scales)
    thresholds = thresholds_of(arbiter, rules, found, decisions, scales)
    return _Told(thresholds, found.chooser, found.delay, found.agrees, found.tried)


def _by_numbers(
    arbiter: Arbiter, running: Running, decisions: Decisions, agrees: Booleans, scales: Scales
) -> _Told | None:
    if bool(agrees[decisions.judged].all()):
        return None
    found = numbers_of(arbiter, running, decisions, agrees, scales)
    if found.chooser is None:
        return None
    return _Told(found.thresholds, found.chooser, 0, found.agrees, ())


def _section(
    arbiter: Arbiter,
    rules: RuleChooser | None,
    decisions: Decisions,
    expected: Integers,
    agrees: Booleans,
    scales: Scales,
    told: _Told | None,
) -> Arbitration:
    slowness = scales.slowness
    share = share_of(agrees[decisions.judged], slowness, CONFIDENCE)
    found: tuple[Region, ...] = ()
    if rules is not None:
        found = cells(arbiter, rules, decisions, agrees, slowness, CONFIDENCE)
    left, followed = agrees, decisions
    if told is not None:
        followed = later(decisions, told.delay)
        left = told.agrees
    section = Arbitration(
        choices=arbiter.choices,
        share=share,
        changes=int(np.count_nonzero(np.diff(decisions.chosen[decisions.judged]))),
        required=_required(arbiter),
        confusion=_confusion(expected, decisions, len(arbiter.choices)),
        cells=found,
        boxes=boxes(arbiter, decisions, agrees, slowness, CONFIDENCE),
        thresholds=() if told is None else told.thresholds,
        delay=0 if told is None else told.delay,
        period=decisions.period,
        explanations=() if told is None else told.tried,
        strays=strays_of(
            arbiter, followed, expected if told is None else told.chooser(followed), left
        ),
        unexplained=int((~left & followed.judged).sum()),
        sentences=(),
        origin="" if arbiter.agreement is None else arbiter.agreement.origin,
    )
    return replace(section, sentences=sentences_of(section))


def _required(arbiter: Arbiter) -> float:
    return AGREED if arbiter.agreement is None else arbiter.agreement.share


def _rules(arbiter: Arbiter, decisions: Decisions) -> RuleChooser | None:
    """The rules, with controls as they were set meanwhile."""
    if arbiter.paradigm not in {Paradigm.RULES, Paradigm.SUBSUMPTION}:
        return None
    columns = {
        each.name: decisions.register[:, arbiter.register.index(each.name)]
        for each in arbiter.controls
    }
    values = {name: np.unique(each[np.isfinite(each)]) for name, each in columns.items()}
    moving = {name for name, each in values.items() if each.size > 1}
    set_to = {name: float(each[0]) for name, each in values.items() if each.size == 1}
    return rule_chooser(arbiter, opened(arbiter, moving), set_to)


def _confusion(expected: Integers, decisions: Decisions, count: int) -> Integers:
    """Decisions by the robot's choice (row) and the spec's; those without a choice are left out."""
    counted = np.zeros((count, count), dtype=np.int64)
    told = decisions.judged & (expected >= 0)
    np.add.at(counted, (decisions.chosen[told], expected[told]), 1)
    return counted


def _content(start: float, decisions: Decisions) -> str:
    """A digest of what was read and chosen, and when."""
    digest = blake2b(np.float64(start).tobytes(), digest_size=16)
    for part in (decisions.times, decisions.register, decisions.chosen, decisions.judged):
        digest.update(np.ascontiguousarray(part).tobytes())
    return digest.hexdigest()


def _report(
    arbiter: Arbiter, trace: Trace, decisions: Decisions, section: Arbitration, verdict: Verdict
) -> Report:
    source = arbiter.source
    ends = [s.times[[0, -1]] for s in trace.series.values() if s.times.size]
    duration = float(max(e[1] for e in ends) - min(e[0] for e in ends)) if ends else 0.0
    reasons, advice = reasons_of(section, verdict)
    starts = decisions.times[decisions.judged]
    return Report(
        verdict=verdict,
        reasons=reasons,
        advice=advice,
        horizon=0.0,
        confidence=CONFIDENCE,
        variables=(),
        coverage=None,
        exclusions=decisions.exclusions,
        losses=trace.losses,
        notes=trace.notes,
        spec=SpecIdentity(arbiter.name, source.file, source.sha256),
        trace=TraceIdentity(
            trace.source,
            trace.start,
            duration,
            min(duration, decisions.period * starts.size),
            _content(trace.start, decisions),
        ),
        starts=starts,
        places={},
        units={read.name: read.unit for read in arbiter.reads},
    )
