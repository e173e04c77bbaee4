"""A robot's decisions held against an arbiter's spec: the verdict, and what explains it."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Final, final

import numpy as np

from runtime.arbiter import Arbiter, Paradigm
from runtime.arrays import Array, Integers
from verifier.arbitration.choosing import Chooser, RuleChooser, rule_chooser, stepwise
from verifier.arbitration.comparisons import opened
from verifier.arbitration.decisions import Decisions, decisions_of
from verifier.arbitration.explaining import explained_by, strays_of, thresholds_of
from verifier.arbitration.planted import slowness_at_limit
from verifier.arbitration.refitting import Scales, later
from verifier.arbitration.regions import boxes, cells, standing_of
from verifier.arbitration.saying import CONFIDENCE, reasons_of, sentences_of
from verifier.arbitration.shares import share_of, slowness_of_choices
from verifier.report.arbitration import (
    Arbitration,
)
from verifier.report.report import (
    Report,
    SpecIdentity,
    Standing,
    TraceIdentity,
    Verdict,
)
from verifier.traces.trace import Trace

VERDICTS: Final = {
    Standing.WITHIN: Verdict.PASS,
    Standing.EXCEEDED: Verdict.FAIL,
    Standing.UNDECIDED: Verdict.INCONCLUSIVE,
}

Decide = Callable[[Array, float], Array]
"""One tick of an arbiter that runs: what it reads and the time, to a number per choice."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Arbitrated:
    """The report with its verdict, and the section that explains it."""

    report: Report
    section: Arbitration


def judge_arbiter(
    arbiter: Arbiter, trace: Trace, running: Decide | None = None, *, only_verdict: bool = False
) -> Arbitrated:
    """Hold the decisions in `trace` against `arbiter`.

    running: decides tick by tick, of an arbiter that is no rules; a fresh one.

    Raises:
        SpecError: the choice, or something that is read, is not in the log (V310).
    """
    decisions = decisions_of(arbiter, trace)
    rules = _rules(arbiter)
    chooser: Chooser
    if rules is not None:
        chooser = rules
    else:
        assert running is not None, "an arbiter without rules has to run"
        inputs = len(arbiter.reads) + len(arbiter.controls)
        chooser = stepwise(running, inputs, arbiter.choices)
    expected = chooser(decisions)
    agrees = (expected == decisions.chosen) & decisions.judged
    slowness = slowness_of_choices(decisions.chosen[decisions.judged], len(arbiter.choices))
    if rules is not None:
        slowness = min(slowness, slowness_at_limit(rules, decisions, _required(arbiter)))
    share = share_of(agrees[decisions.judged], slowness, CONFIDENCE)
    required = _required(arbiter)
    standing = standing_of(share.interval.low, share.interval.high, required)
    scales = Scales(slowness, CONFIDENCE)
    explained = None
    if rules is not None and not only_verdict and share.decisions:
        explained = explained_by(arbiter, rules, decisions, agrees, scales)
    section = Arbitration(
        choices=arbiter.choices,
        share=share,
        required=required,
        confusion=_confusion(expected, decisions, len(arbiter.choices)),
        cells=()
        if rules is None
        else cells(arbiter, rules, decisions, agrees, slowness, CONFIDENCE),
        boxes=boxes(arbiter, decisions, agrees, slowness, CONFIDENCE),
        thresholds=()
        if explained is None or rules is None
        else thresholds_of(arbiter, rules, explained, decisions, scales),
        delay=0 if explained is None else explained.delay,
        period=decisions.period,
        explanations=() if explained is None else explained.tried,
        strays=strays_of(arbiter, decisions, explained, expected, agrees),
        unexplained=share.decisions - share.agreeing
        if explained is None
        else int((~explained.agrees & later(decisions, explained.delay).judged).sum()),
        sentences=(),
        origin="" if arbiter.agreement is None else arbiter.agreement.origin,
    )
    section = replace(section, sentences=sentences_of(section))
    return Arbitrated(_report(arbiter, trace, decisions, section, VERDICTS[standing]), section)


def _required(arbiter: Arbiter) -> float:
    return 1.0 if arbiter.agreement is None else arbiter.agreement.share


def _rules(arbiter: Arbiter) -> RuleChooser | None:
    if arbiter.paradigm in {Paradigm.RULES, Paradigm.SUBSUMPTION}:
        return rule_chooser(arbiter, opened(arbiter))
    return None


def _confusion(expected: Integers, decisions: Decisions, count: int) -> Integers:
    """Decisions by the robot's choice (row) and the spec's; those without a choice are left out."""
    counted = np.zeros((count, count), dtype=np.int64)
    told = decisions.judged & (expected >= 0)
    np.add.at(counted, (decisions.chosen[told], expected[told]), 1)
    return counted


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
            trace.source, trace.start, duration, min(duration, decisions.period * starts.size)
        ),
        starts=starts,
        places={},
        units={read.name: read.unit for read in arbiter.reads},
    )
