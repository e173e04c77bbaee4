"""What the changes of mode do to a verdict.

They can only make a verdict worse: a PASS needs them in time and with the right jumps, a switch
that is shown to be wrong is a FAIL of its own, and where an input is missing nothing is decided.
"""

from dataclasses import replace

from verifier.fidelity.stretches.needs import Input
from verifier.report.report import Report, Standing, Verdict
from verifier.report.switching import Switching


def with_switching(report: Report, switching: Switching, unknown: tuple[Input, ...]) -> Report:
    """The report, its verdict no better than the changes of mode allow.

    unknown: the inputs that the trace does not tell.
    """
    if unknown:
        is_untold = any(each.name == switching.mode for each in unknown)
        return _told(report, switching, report.verdict, first=False) if is_untold else report
    match switching.standing, report.verdict:
        case Standing.EXCEEDED, verdict:
            return _told(report, switching, Verdict.FAIL, first=verdict is not Verdict.FAIL)
        case Standing.UNDECIDED, Verdict.PASS:
            return _told(report, switching, Verdict.INCONCLUSIVE, first=True)
        case Standing.WITHIN, Verdict.FAIL | Verdict.INCONCLUSIVE:
            return report
        case _:
            return _told(report, switching, report.verdict, first=False)


def _told(report: Report, switching: Switching, verdict: Verdict, *, first: bool) -> Report:
    own, others = switching.reasons, report.reasons
    if verdict is not report.verdict and report.verdict is Verdict.PASS:
        others = ()
    reasons = (*own, *others) if first else (*others, *own)
    advice = (*switching.advice, *report.advice) if first else (*report.advice, *switching.advice)
    return replace(report, verdict=verdict, reasons=reasons, advice=tuple(dict.fromkeys(advice)))
