"""Why nothing of a trace can be compared, and what to do about it."""

import math
from collections.abc import Sequence
from typing import Final

from verifier.fidelity.judging.outside import Outside
from verifier.fidelity.judging.sentences import too_few
from verifier.fidelity.judging.verdict import Finding, with_outside
from verifier.fidelity.stretches.needs import Needs, period_of
from verifier.fidelity.stretches.segments import Segments, too_short_cause
from verifier.report.report import Verdict
from verifier.report.wording import listed, number, seconds
from verifier.traces.trace import Trace

SLOW: Final = 3.0
"""Samples so many horizons apart are none of what shall be compared."""
UNITS: Final = (("milliseconds", 1e3), ("microseconds", 1e6), ("nanoseconds", 1e9))
SHORT: Final = {"milliseconds": "ms", "microseconds": "us", "nanoseconds": "ns"}
"""How columns are named whose times are in such units."""


def not_told(needs: Needs) -> Finding | None:
    """Which variables without which nothing can be compared are not in the trace, if any."""
    names = [*needs.missing, *(each.name for each in needs.signals if not each.is_known)]
    if not names:
        return None
    verb = "is" if len(names) == 1 else "are"
    entries = ", ".join(f"{name}: ..." for name in names)
    return open_for(
        f"{listed(names)} {verb} not in the trace, and nothing can be compared without",
        f"log {listed(names)}, or write in `trace: {{{entries}}}` where in the log it stands",
    )


def too_short(
    needs: Needs, segments: Segments, horizon: float, outside: Sequence[Outside]
) -> Finding:
    """Why no window fits."""
    first, last = segments.whole
    if last - first < horizon:
        return open_for(
            f"the trace covers {first:.1f}-{last:.1f} s, the check needs {horizon:.1f} s",
            too_few(horizon),
        )
    if outside:
        return with_outside(Finding(Verdict.INCONCLUSIVE, (), ()), outside)
    cutting = [each for each in segments.exclusions if each.cause != too_short_cause(horizon)]
    causes = sorted(cutting, key=lambda each: -each.seconds)
    base = needs.series[needs.base].name
    cuts = [f"{each.cause} ({seconds(each.seconds)})" for each in causes]
    return open_for(
        f"no stretch of {base} is as long as the horizon of {number(horizon)} s: the trace is cut"
        f" by {listed(cuts)}",
        f"record {number(horizon)} s and more at a time without {causes[0].cause}, or declare a"
        " shorter `horizon`",
    )


def too_slow(needs: Needs, horizon: float, trace: Trace) -> Finding | None:
    """Samples that are whole horizons apart, as where milliseconds are taken for seconds."""
    base = needs.series[needs.base]
    period = period_of(base.times)
    if not math.isfinite(period) or period < SLOW * horizon:
        return None
    clock = next((note for note in trace.notes if note.startswith("times are ")), "")
    unit = next((word for word, many in UNITS if period < SLOW * horizon * many), "")
    guess = f", as if {unit} were taken for seconds" if unit else ""
    return open_for(
        f"{base.name} has one sample every {number(period)} s, the check compares over"
        f" {number(horizon)} s{guess}; {clock or 'these are the stamps of the log'}",
        f"write times in seconds, or name the column after its unit, as `time_{SHORT[unit]}`"
        if unit
        else f"log {base.name} at least every {number(horizon / 10.0)} s",
    )


def open_for(reason: str, *advice: str) -> Finding:
    """INCONCLUSIVE for one reason."""
    return Finding(Verdict.INCONCLUSIVE, (reason,), advice)
