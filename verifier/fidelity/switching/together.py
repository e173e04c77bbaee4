"""The changes of mode of several recordings, for their common verdict."""

from collections.abc import Sequence
from dataclasses import replace

from verifier.fidelity.switching.verdict import with_switching
from verifier.report.report import Report, Standing
from verifier.report.switching import Switching


def with_every_switching(
    report: Report, switchings: Sequence[tuple[str, Switching | None]]
) -> Report:
    """The report, its verdict no better than the changes of mode of any recording allow.

    They are not pooled: each recording decides about its own. Those that took no way have no say,
    but where no recording took one, nothing is decided.
    """
    told = [(source, each) for source, each in switchings if each is not None]
    spoken = [(source, each) for source, each in told if _has_taken(each)] or told[:1]
    for source, each in spoken:
        if each.standing is not Standing.WITHIN:
            reasons = tuple(f"{source}: {reason}" for reason in each.reasons)
            report = with_switching(report, replace(each, reasons=reasons), ())
    return report


def _has_taken(switching: Switching) -> bool:
    counts = (w.expected + w.unexpected + w.missed + w.wrong for w in switching.ways)
    return bool(switching.switches) or any(counts)
