"""From the figures to the verdict, with its reasons and what to do next."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import final

import numpy as np

from runtime.program import Unit
from verifier.fidelity.judging import sentences
from verifier.fidelity.judging.evidence import Evidence
from verifier.fidelity.judging.outside import Outside
from verifier.report.advice import CHECK_FIRST
from verifier.report.report import Coverage, Standing, VariableResult, Verdict
from verifier.report.situations import exceeded
from verifier.report.wording import listed, number, percent, quantity, span
from verifier.traces.trace import TICKS

MOST_LOST = 0.1
"""With a larger share of predictions leaving the domain, there is no PASS."""
MOST_STEP_ERROR = 0.1
"""With a larger integration error, as a share of the tolerance, there is no verdict."""
WHITE = 0.3
"""Noise with a larger correlation of successive values is worth a note."""


@final
@dataclass(frozen=True, slots=True)
class Finding:
    """The verdict, why, and what to do next."""

    verdict: Verdict
    reasons: tuple[str, ...]
    advice: tuple[str, ...]


def decide(
    evidence: Evidence,
    results: tuple[VariableResult, ...],
    coverage: Coverage,
    judged: float,
    units: dict[str, Unit],
) -> Finding:
    """FAIL where a tolerance is shown to be exceeded; PASS where all speaks for it."""
    bars = _bars(evidence)
    if bars:
        return Finding(Verdict.INCONCLUSIVE, tuple(bars), tuple(_declare(evidence)))
    failed = [r for r in results if r.standing is Standing.EXCEEDED]
    if failed:
        return _failed(evidence, failed, units)
    doubts = [*_lost(evidence), *(sentences.undecided(r, units) for r in results if _is_open(r))]
    if not coverage.is_reached:
        doubts.append(sentences.uncovered(coverage))
    if doubts:
        advice = _advice(results, coverage, judged)
        return Finding(Verdict.INCONCLUSIVE, tuple(doubts), tuple(dict.fromkeys(advice)))
    reasons = [sentences.within(r) for r in results]
    reasons += [sentence for r in results for sentence in sentences.unmoved(r)]
    if coverage.required == 0.0:
        reasons.append(sentences.scope(coverage))
    return Finding(Verdict.PASS, tuple(reasons), ())


def with_outside(finding: Finding, outside: Sequence[Outside]) -> Finding:
    """The finding with what lies outside its domain: first where it leaves the verdict open.

    Nobody fails by a log in which something else stands than was meant.
    """
    told = tuple(each.reason for each in outside)
    is_open = finding.verdict is Verdict.INCONCLUSIVE or any(each.is_far for each in outside)
    verdict = Verdict.INCONCLUSIVE if is_open else finding.verdict
    reasons = (*told, *finding.reasons) if is_open else (*finding.reasons, *told)
    return Finding(verdict, reasons, (*(each.advice for each in outside), *finding.advice))


def _is_open(result: VariableResult) -> bool:
    return result.standing is Standing.UNDECIDED


def _advice(results: tuple[VariableResult, ...], coverage: Coverage, judged: float) -> list[str]:
    """What would decide: what no data would mend first, then where to drive, then how long."""
    special, more = _of_open(results, judged)
    return special + ([] if coverage.is_reached else sentences.unseen(coverage)) + more


def advice_on_open(results: tuple[VariableResult, ...], judged: float) -> frozenset[str]:
    """All that is advised about variables whose verdict is open; judged: seconds."""
    special, more = _of_open(results, judged)
    return frozenset((*special, *more))


def _of_open(results: tuple[VariableResult, ...], judged: float) -> tuple[list[str], list[str]]:
    """What no data would mend, and how much data would decide the others."""
    advice: list[str] = []
    short: list[VariableResult] = []
    for result in filter(_is_open, results):
        special = sentences.too_noisy(result) or sentences.allow_scatter(result)
        advice += special
        short += [] if special else [result]
    return advice, sentences.more_data(short, judged)


def _failed(evidence: Evidence, failed: list[VariableResult], units: dict[str, Unit]) -> Finding:
    reasons = []
    for result in failed:
        reasons.append(exceeded(result, units))
        reasons += sentences.proportion(evidence, result)
    reasons.append(sentences.what_is_systematic())
    return Finding(Verdict.FAIL, tuple(reasons), (CHECK_FIRST,))


def _bars(evidence: Evidence) -> list[str]:
    """What forbids any verdict."""
    bars = [
        f"{each.name} is neither in the trace nor declared constant; the figures assume"
        f" {number(each.value)} (SI), the spec's default"
        for each in evidence.unknown
    ]
    if evidence.step_error > MOST_STEP_ERROR:
        bars.append(
            "the field could not be integrated accurately enough: halving the step still moves"
            f" predictions by {percent(evidence.step_error)} of the tolerance"
        )
    return bars


def _declare(evidence: Evidence) -> list[str]:
    return [
        f"log {each.name}, or write `trace: {{{each.name}: {{constant: ...}}}}`"
        for each in evidence.unknown
    ]


def _lost(evidence: Evidence) -> list[str]:
    share = float(np.mean(evidence.is_lost))
    if share <= MOST_LOST:
        return []
    return [
        f"{percent(share)} of the predictions left the spec's domain, while the robot stayed inside"
    ]


def _times(clocks: tuple[str, ...]) -> str:
    """Whose stamps the times are; a run's are the instants at which its nodes sample."""
    said = ["the ticks of nodes" if clock == TICKS else f"{clock} stamps" for clock in clocks]
    return f"times are {listed(said)}"


def notes_of(evidence: Evidence, results: tuple[VariableResult, ...]) -> list[str]:
    """How the figures were made: clocks, windows, noise, losses on the way."""
    notes = [
        _times(evidence.clocks),
        f"{len(evidence.starts)} windows of {number(evidence.horizon)} s, one every half horizon",
    ]
    lost = int(np.sum(evidence.is_lost))
    if lost:
        notes.append(f"{lost} windows are not counted: their prediction left the spec's domain")
    rare = max((result.unjudged for result in results), default=0)
    if rare:
        notes.append(
            f"{rare} windows ran in a mode that was seen too rarely to be judged on its own: they"
            " count for the whole alone"
        )
    return [*notes, *_noise_notes(evidence)]


def _noise_notes(evidence: Evidence) -> list[str]:
    """Which noise is not white, recording by recording; and how loud it was in each of them."""
    notes = []
    for j, state in enumerate(evidence.states):
        every = [noise[j] for noise in evidence.noise]
        if len(every) > 1:
            low, high = min(n.sigma for n in every), max(n.sigma for n in every)
            is_one = quantity(low, state.unit) == quantity(high, state.unit)
            size = f"{quantity(low, state.unit)} each" if is_one else span(low, high, state.unit)
            notes.append(f"the noise of {state.name} is told by each recording for itself: {size}")
        for source, noise in zip(evidence.sources, every, strict=True):
            if noise.correlation > WHITE:
                where = f" in {source}" if len(every) > 1 else ""
                notes.append(
                    f"the noise of {state.name}{where} is not white (correlation of successive"
                    f" samples {noise.correlation:.2f}): its slow part counts as scatter of the"
                    " windows"
                )
    return notes
