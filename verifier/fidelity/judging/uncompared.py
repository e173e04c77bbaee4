"""Why nothing of a trace can be compared, and what to do about it."""

from collections.abc import Sequence

from verifier.fidelity.judging.outside import Outside
from verifier.fidelity.judging.sentences import too_few
from verifier.fidelity.judging.verdict import Finding, with_outside
from verifier.fidelity.stretches.needs import Needs
from verifier.fidelity.stretches.segments import Segments, too_short_cause
from verifier.report.report import Verdict
from verifier.report.wording import listed, number, seconds


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


def open_for(reason: str, *advice: str) -> Finding:
    """INCONCLUSIVE for one reason."""
    return Finding(Verdict.INCONCLUSIVE, (reason,), advice)
