"""From the figures to the verdict, with its reasons and what to do next."""

from dataclasses import dataclass
from typing import final

import numpy as np

from runtime.program import Unit
from verifier.fidelity.judging import sentences
from verifier.fidelity.judging.evidence import Evidence
from verifier.fidelity.stretches.needs import Needs
from verifier.fidelity.stretches.segments import Segments
from verifier.report.report import Coverage, Standing, VariableResult, Verdict
from verifier.report.wording import listed, number, percent, seconds, span

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
    doubts = [sentences.undecided(r, units) for r in results if r.standing is Standing.UNDECIDED]
    advice = []
    for result in results:
        if result.standing is Standing.UNDECIDED:
            noisy = sentences.too_noisy(result)
            restless = [] if noisy else sentences.allow_scatter(result)
            advice += noisy or restless or [sentences.more_data(result, judged)]
    if not coverage.is_reached:
        doubts.append(sentences.uncovered(coverage))
        advice += sentences.unseen(coverage)
    doubts += _lost(evidence)
    if doubts:
        return Finding(Verdict.INCONCLUSIVE, tuple(doubts), tuple(dict.fromkeys(advice)))
    reasons = [sentences.within(r) for r in results]
    reasons += [sentence for r in results for sentence in sentences.unmoved(evidence, r)]
    if coverage.required == 0.0:
        reasons.append(sentences.scope(coverage))
    return Finding(Verdict.PASS, tuple(reasons), ())


def _failed(evidence: Evidence, failed: list[VariableResult], units: dict[str, Unit]) -> Finding:
    reasons = []
    for result in failed:
        reasons.append(sentences.exceeded(result))
        reasons += sentences.proportion(evidence, result)
        reasons += sentences.worst(result, units)
    advice = (
        "before blaming the robot, check units, signs and the `delay:` of every entry in `trace:`",
    )
    return Finding(Verdict.FAIL, tuple(reasons), advice)


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


def not_told(needs: Needs) -> str:
    """Which variables without which nothing can be compared are not in the trace, if any."""
    names = [*needs.missing, *(each.name for each in needs.signals if not each.is_known)]
    if not names:
        return ""
    verb = "is" if len(names) == 1 else "are"
    return f"{listed(names)} {verb} not in the trace, and nothing can be compared without"


def too_short(needs: Needs, segments: Segments, horizon: float) -> str:
    """Why no window fits."""
    first, last = segments.whole
    if last - first < horizon:
        return f"the trace covers {first:.1f}-{last:.1f} s, the check needs {horizon:.1f} s"
    causes = [f"{e.cause} ({seconds(e.seconds)})" for e in segments.exclusions]
    base = needs.series[needs.base].name
    return (
        f"no stretch of {base} is as long as the horizon of {number(horizon)} s;"
        f" taken out: {listed(causes)}"
    )


def notes_of(evidence: Evidence, results: tuple[VariableResult, ...]) -> list[str]:
    """How the figures were made: clocks, windows, noise, losses on the way."""
    notes = [
        f"times are {listed([*evidence.clocks])} stamps",
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
            sigmas = [noise.sigma for noise in every]
            notes.append(
                f"the noise of {state.name} is told by each recording for itself:"
                f" {span(min(sigmas), max(sigmas), state.unit)}"
            )
        for source, noise in zip(evidence.sources, every, strict=True):
            if noise.correlation > WHITE:
                where = f" in {source}" if len(every) > 1 else ""
                notes.append(
                    f"the noise of {state.name}{where} is not white (correlation of successive"
                    f" samples {noise.correlation:.2f}): its slow part counts as scatter of the"
                    " windows"
                )
    return notes
