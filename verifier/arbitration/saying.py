"""What the decisions of a robot show, in sentences."""

import math
from typing import Final

import numpy as np

from verifier.arbitration.shares import times_longer
from verifier.report.arbitration import Arbitration, Region, Threshold, ThresholdStanding
from verifier.report.report import Standing, Verdict
from verifier.report.wording import exact, listed, number, percent, quantity, seconds, span

CONFIDENCE: Final = 0.95
MOST_DIGITS: Final = 3
FEWEST_SHOWN: Final = 0.05
"""Of the decisions that differ: a confusion rarer than this is not told first."""


def reasons_of(section: Arbitration, verdict: Verdict) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Why the verdict is as it is, and what to do next."""
    share = section.share
    if not share.decisions:
        return ("no decision in the log can be judged",), ("see what was not judged, and why",)
    told = f"it decides as the spec in {_of(section)}; {percent(section.required)} is required"
    match verdict:
        case Verdict.PASS:
            return (told,), ()
        case Verdict.INCONCLUSIVE:
            return (told,), (_longer(section),)
        case Verdict.FAIL:
            return (told, *_mainly(section)), _advice(section)


def _longer(section: Arbitration) -> str:
    """How much of such a log would decide."""
    if section.required >= 1.0:
        return "PASS needs an `agreement` below 1: no log shows that every decision will agree"
    factor = times_longer(section.share, section.required, CONFIDENCE)
    if math.isinf(factor):
        return "record more changes of choice: decisions that go on tell little"
    wanted = math.ceil(factor * section.share.decisions)
    lasts = seconds(wanted * section.period)
    return (
        f"about {wanted} decisions like these ({lasts}) would decide: those that go on tell little"
    )


def sentences_of(section: Arbitration) -> tuple[str, ...]:
    """What explains the decisions that differ, and what they leave open."""
    if not section.share.decisions:
        return ()
    return (
        *_mainly(section),
        *_where(section),
        *_delayed(section),
        *_rest(section),
        *_open(section),
    )


def threshold_sentence(each: Threshold) -> str:
    """`near is 0.494 to 0.495 m (spec 0.55 m)`."""
    own = exact(each.value, each.unit)
    name = f"the number in `{each.comparison}`" if _is_bare(each) else each.name
    low, high = each.interval.low, each.interval.high
    if math.isinf(low) and math.isinf(high):
        return f"{name} may be anything (spec {own}): no reading is decided by it"
    if math.isinf(low):
        return f"{name} is at most {quantity(high, each.unit)} (spec {own})"
    if math.isinf(high):
        return f"{name} is at least {quantity(low, each.unit)} (spec {own})"
    return f"{name} is {span(low, high, each.unit)} (spec {own})"


def _is_bare(threshold: Threshold) -> bool:
    """Whether it is a number in a condition, as in learned rules, and so has no name of its own."""
    return " " in threshold.name


def _to_write(threshold: Threshold) -> str:
    """What the spec has to say so that the threshold is where the robot's is."""
    if not _is_bare(threshold):
        return f"{threshold.name}: {exact(threshold.fitted, threshold.unit)}"
    compared = threshold.comparison.rpartition(" ")[0]
    return f"`{compared} {threshold.fitted:.6g}` for `{threshold.comparison}`"


def region_phrase(region: Region) -> str:
    """Its conditions in one phrase."""
    return listed(list(region.conditions))


def _of(section: Arbitration) -> str:
    share, required = section.share, section.required
    ends = f"{_beside(share.interval.low, required)} to {_beside(share.interval.high, required)}"
    decisions = "1 decision" if share.decisions == 1 else f"{share.decisions} decisions"
    over = f"over {changes_phrase(section)}"
    return f"{_percents(share.value)} of {decisions}, {over} (95 % interval {ends})"


def changes_phrase(section: Arbitration) -> str:
    """`14 changes of choice`: as many decisions that go on tell much less."""
    count = section.changes
    if not count:
        return "no change of choice"
    return "1 change of choice" if count == 1 else f"{count} changes of choice"


def _beside(share: float, required: float) -> str:
    """With as many digits as tell it from what is required."""
    digits = MOST_DIGITS if share != required else 0
    told = _percents(share)
    for more in range(1, digits + 1):
        if float(told.split()[0]) != round(100.0 * required, MOST_DIGITS):
            break
        told = f"{100.0 * share:.{more}f} %"
    return told


def _percents(share: float) -> str:
    """With as many digits as tell it from 1."""
    missing = 1.0 - share
    digits = 0 if missing <= 0.0 or missing >= 0.1 else min(int(-math.log10(missing)), 3)
    return f"{100.0 * share:.{digits}f} %"


def _mainly(section: Arbitration) -> tuple[str, ...]:
    """The confusion that is most frequent, and thresholds that are elsewhere."""
    moved = [t for t in section.thresholds if t.standing is ThresholdStanding.MOVED]
    found = []
    if moved:
        changed = listed([threshold_sentence(each) for each in moved])
        found.append(f"{changed}: {_then(section)}")
    differ = section.confusion.copy()
    np.fill_diagonal(differ, 0)
    total = int(differ.sum())
    if total:
        robot, spec = np.unravel_index(int(np.argmax(differ)), differ.shape)
        count = int(differ[robot, spec])
        if count > FEWEST_SHOWN * total:
            found.append(
                f"where the spec chooses {section.choices[spec]}, the robot chooses"
                f" {section.choices[robot]} {count} times, of {total} decisions that differ"
            )
    return tuple(found)


def _then(section: Arbitration) -> str:
    """How many agree with what explains the most."""
    count = section.share.decisions
    if section.unexplained == 0:
        return f"with that, all {count} decisions agree"
    return f"with that, all but {section.unexplained} of {count} decisions agree"


def _where(section: Arbitration) -> tuple[str, ...]:
    worst = [c for c in section.cells if c.standing is Standing.EXCEEDED][:1]
    return tuple(
        f"where {region_phrase(each)}, {_percents(each.share.value)} of"
        f" {each.share.decisions} decisions agree"
        for each in worst
    )


def _delayed(section: Arbitration) -> tuple[str, ...]:
    if not section.delay:
        return ()
    when = "after" if section.delay > 0 else "before"
    by = seconds(abs(section.delay) * section.period)
    samples = f"{abs(section.delay)} sample{'s' if abs(section.delay) > 1 else ''}"
    return (f"the robot decides {by} ({samples}) {when} the readings tell it to: {_then(section)}",)


def _rest(section: Arbitration) -> tuple[str, ...]:
    if not section.unexplained:
        return ()
    at = section.strays[0]
    first = f"{at.decisions} from {number(at.start)} s on, {at.robot} where the spec has {at.spec}"
    return (f"{section.unexplained} decisions stay unexplained, most in one stretch: {first}",)


def _open(section: Arbitration) -> tuple[str, ...]:
    untold = [t for t in section.thresholds if t.standing is ThresholdStanding.UNTOLD]
    return tuple(
        f"{each.comparison} is not told: too few readings lie near it; {threshold_sentence(each)}"
        for each in untold
    )


def _advice(section: Arbitration) -> tuple[str, ...]:
    found = [
        f"if the robot is right, write {_to_write(each)} ({each.origin})"
        for each in section.thresholds
        if each.standing is ThresholdStanding.MOVED
    ]
    if section.delay > 0:
        late = seconds(section.delay * section.period)
        found.append(f"if it may decide {late} late, say so: `delay` of the choice under `trace:`")
    return tuple(found)
