"""What a recorded node's report says: when it had its way, and how long a run would decide.

The recording is our own: no entry of a spec's `trace:` has a part in it, so advice to mend a log
is left out, and so is `specc fit`, which edits by logs.
"""

import re
from collections.abc import Mapping
from dataclasses import replace
from typing import Final

import numpy as np

from runtime.arrays import Array, Booleans
from runtime.program import Program
from verifier.report.examination import Examination
from verifier.report.report import Exclusion, Report, Verdict
from verifier.report.wording import listed, number, quantity, seconds, span

INHIBITED: Final = "it was inhibited"
OVERRULED: Final = "it was overruled"
BEYOND_DOMAIN: Final = "beyond its domain (clipped)"
UNJUDGED: Final = "judge_when is false"
"""What a report on a log says of time in which a node had not its way."""
OF_LOGS: Final = re.compile(
    r"`trace:|mend the log|under `trace|`delay:`|shorter `horizon`|`judge_when`"
)
FITTING: Final = re.compile(r" \(`specc fit [^`]*` edits it\)")

MENDING: Final = "mend the robot"
MUCH: Final = 0.05
"""Touching for less of its time explains little."""
SAME: Final = 1e-6
"""Values that differ by this share are one."""


def told_of_node(report: Report, times: Array, held_back: dict[str, Booleans]) -> Report:
    """The report, with what kept the node from having its way at its ticks (T,), by cause."""
    causes = _causes(times, held_back)
    others = tuple(each for each in report.exclusions if each.cause != UNJUDGED)
    report = replace(report, exclusions=(*causes, *others))
    if report.starts.size:
        return replace(report, advice=(*report.advice, *_of_run(report)))
    return replace(report, reasons=(_never(report, causes),), advice=_advice(causes))


def with_touches(report: Report, times: Array, free: Booleans, touches: Booleans) -> Report:
    """The report, its first reason told with how long the body touched something meanwhile.

    A field says what happens between robot and world: being held by a wall is a departure, too,
    and is not left out; but whoever reads of a departure wants to know.
    """
    if report.verdict is Verdict.PASS or times.size < 2 or not report.reasons:
        return report
    lasts = np.append(np.diff(times), 0.0)
    own, touched = float(lasts[free].sum()), float(lasts[free & touches].sum())
    if touched < MUCH * own or touched == 0.0:
        return report
    said = (
        f"{report.reasons[0]}; in {seconds(touched)} of the {seconds(own)} in which it had its way"
        " its body touched something, which may have held it"
    )
    return replace(report, reasons=(said, *report.reasons[1:]))


def controls_as_recorded(program: Program, columns: Mapping[str, Array]) -> tuple[str, ...]:
    """Of each control that was not at the default of the spec: what it was, which counts."""
    told = []
    for each in program.controls:
        values = columns.get(each.name, np.zeros(0))
        low, high = (values.min(), values.max()) if values.size else (each.default, each.default)
        near = SAME * max(abs(each.default), abs(low), abs(high))
        if max(abs(low - each.default), abs(high - each.default)) > near:
            is_one = high - low <= near
            was = quantity(low, each.unit) if is_one else span(low, high, each.unit)
            default = quantity(each.default, each.unit)
            told.append(f"{each.name} is {was}, as recorded; the spec's default is {default}")
    return tuple(told)


def without_logs(examination: Examination) -> Examination:
    """Without what is said of how a log may be wrong; what departs is explained where it FAILs."""
    report = examination.report
    kept = [FITTING.sub("", each) for each in report.advice]
    advice = tuple(each for each in kept if not OF_LOGS.search(each) and "specc fit" not in each)
    if report.verdict is not Verdict.FAIL:  # what may explain a chance departure mends nothing
        advice = tuple(each for each in advice if not each.startswith(MENDING))
    diagnosis = examination.diagnosis if report.verdict is Verdict.FAIL else None
    return replace(examination, report=replace(report, advice=advice), diagnosis=diagnosis)


def _causes(times: Array, held_back: dict[str, Booleans]) -> tuple[Exclusion, ...]:
    if times.size < 2:
        return ()
    lasts = np.append(np.diff(times), 0.0)
    return tuple(
        Exclusion(cause, float(lasts[flags].sum()), int(flags.sum()))
        for cause, flags in held_back.items()
        if flags.any()
    )


def _never(report: Report, causes: tuple[Exclusion, ...]) -> str:
    """Why nothing of it could be judged."""
    duration = report.trace.duration
    told = listed([f"{each.cause} ({seconds(each.seconds)})" for each in causes])
    if not causes:
        return report.reasons[0]
    if sum(each.seconds for each in causes) >= duration * (1.0 - 1e-9):
        only = causes[0].cause == INHIBITED and len(causes) == 1
        return f"it never acted in {seconds(duration)}" if only else f"it never had its way: {told}"
    return (
        f"it never had its way for as long as the horizon of {number(report.horizon)} s at a"
        f" time: {told} of {seconds(duration)}"
    )


def _advice(causes: tuple[Exclusion, ...]) -> tuple[str, ...]:
    worst = max(causes, key=lambda each: each.seconds, default=None)
    if worst is None:
        return ()
    if worst.cause == INHIBITED:
        return ("run a scenario in which it acts: another start, another world, or longer",)
    if worst.cause == OVERRULED:
        return ("run a scenario in which no other behavior moves what it moves",)
    return ("run a scenario in which what it reads stays within its domain",)


def _of_run(report: Report) -> tuple[str, ...]:
    """How long a run has to be for what is asked for."""
    judged, duration = report.trace.judged, report.trace.duration
    if report.verdict is not Verdict.INCONCLUSIVE or not 0.0 < judged < 0.99 * duration:
        return ()
    a_minute = 60.0 * judged / duration
    return (f"a run like this one gives {seconds(a_minute)} of judged data a minute",)
