"""The sections that explain a verdict, as parts of the page."""

import math
from collections.abc import Callable
from typing import Final

from runtime.program import Unit
from specc.figures.candidates import draw_candidates
from specc.figures.caught import draw_caught
from specc.figures.features import draw_features
from specc.figures.quantities import number, quantity, seconds
from specc.figures.style import Picture
from specc.figures.switches import draw_switches
from specc.pages.arbitration_part import arbitration_part
from specc.pages.inline_svg import inline_svg
from specc.pages.page import Block, Part, Plot, Table
from specc.pages.requirements_part import requirements_part
from specc.pages.sentences import ranged
from verifier.report.diagnosis import Candidate, Diagnosis, FittedNumber, Refitted
from verifier.report.examination import Examination
from verifier.report.features import Estimate, FeatureNumber, Features
from verifier.report.limits import Limits
from verifier.report.report import Interval
from verifier.report.scores import Scores, VariableScores
from verifier.report.switching import Switching, SwitchSort, Way
from verifier.report.why import ranked, why
from verifier.report.wording import digits_of, percent, suffix

COUNTS: Final[dict[str, Callable[[Way], int]]] = {
    "expected": lambda way: way.expected,
    "unexpected": lambda way: way.unexpected,
    "missed": lambda way: way.missed,
    "elsewhere": lambda way: way.wrong,
}
"""The sorts of switches; of those that never occurred, no column is shown."""


def explanations(examination: Examination, prefix: str) -> tuple[Part, ...]:
    """What speaks of the robot; `prefix` keeps the figures of several traces apart."""
    of = examination
    parts = (
        requirements_part(of.requirements) if of.requirements else None,
        of.arbitration and arbitration_part(of.arbitration),
        of.diagnosis and diagnosis_part(of.diagnosis, of.switching, prefix),
        of.switching and switching_part(of.switching, prefix),
        of.features and features_part(of.features, prefix),
    )
    return tuple(part for part in parts if part)


def limits_of_verdict(examination: Examination, prefix: str) -> tuple[Part, ...]:
    """What speaks of the trace and of the judgement."""
    of = examination
    parts = (of.limits and limits_part(of.limits, prefix), of.scores and scores_part(of.scores))
    return tuple(part for part in parts if part)


def plotted(figure: Picture, name: str, caption: str) -> Plot:
    """A figure as it stands in the page."""
    return Plot(inline_svg(figure, name, caption), caption)


def diagnosis_part(diagnosis: Diagnosis, switching: Switching | None, prefix: str) -> Part:
    """Why the robot departs."""
    title, sentences = why(diagnosis, switching)
    blocks = [Block("", sentences, is_list=True)]
    if diagnosis.refitted:
        titles = ("number", "spec", "refitted", "its interval", "stands in")
        rows = tuple(_refitted(each) for each in diagnosis.refitted)
        table = Table(titles, rows, last=1)
        blocks.append(Block("The numbers that this trace can tell", table=table))
    if diagnosis.candidates:
        caption = (
            "How much of the error each explanation takes away in windows that it was not fitted"
            " to (a number of a guard: at switches). Full bars are named above, in the order in"
            " which they were taken in: each is a share of what those before it left. Pale ones"
            " were tried instead, one at a time."
        )
        figure = plotted(draw_candidates(diagnosis), f"{prefix}candidates", caption)
        titles = ("explanation", "numbers", "explains", "log-likelihood", "as good")
        rows = tuple(_candidate(each) for each in ranked(diagnosis))
        table = Table(titles, rows, first=1, last=1)
        blocks.append(Block("What would explain it", figure=figure, table=table))
    if diagnosis.differs:
        sentences = tuple(each.sentence for each in diagnosis.differs)
        blocks.append(Block("Where the structure differs", sentences, is_list=True))
    return Part(f"Why: {title}", tuple(blocks))


def _refitted(each: Refitted) -> tuple[str, ...]:
    name = f"{each.kind} {each.name}".strip()
    return (
        f"{name} (moved)" if each.is_moved else name,
        quantity(each.spec, each.unit),
        f"{_beside(each.value, each.interval, each.unit)}{suffix(each.unit)}",
        ranged(each.interval, each.unit),
        each.origin,
    )


def _candidate(each: Candidate) -> tuple[str, ...]:
    numbers = ", ".join(_number(n) for n in each.numbers)
    share = percent(max(each.evidence.share, 0.0))
    return (each.label, numbers, share, number(each.evidence.gain), ", ".join(each.alike) or "–")


def _number(each: FittedNumber) -> str:
    """A delay without its sign: the label says late or early."""
    value = abs(each.value) if each.name == "delay" else each.value
    return f"{each.name} {quantity(value, each.unit)}"


def switching_part(switching: Switching, prefix: str) -> Part:
    """The changes of mode."""
    counted = [title for title in COUNTS if any(COUNTS[title](way) for way in switching.ways)]
    titles = ("change", "judgement", *counted)
    rows = tuple(_way(way, counted) for way in switching.ways)
    blocks = [
        Block("", switching.reasons, is_list=True),
        Block("", table=Table((*titles, "late", "its interval", "allowed"), rows, first=1)),
    ]
    if any(s.sort is SwitchSort.EXPECTED for s in switching.switches):
        caption = (
            "Each change of mode, by how much later than the spec the robot made it (earlier:"
            " negative). Bars reach to where the tolerance of the states allows it. Crosses at the"
            " bottom are changes without a partner: unexpected, missed or to another mode."
        )
        figure = plotted(draw_switches(switching), f"{prefix}switches", caption)
        blocks.append(Block("", figure=figure))
    jumps = tuple(
        (
            f"{jump.name}, {way.source} to {way.target}",
            str(jump.standing),
            "reset" if jump.is_reset else "goes on",
            quantity(jump.error, jump.unit),
            ranged(jump.interval, jump.unit),
            quantity(jump.tolerance, jump.unit),
            str(jump.count),
        )
        for way in switching.ways
        for jump in way.jumps
    )
    if jumps:
        columns = ("state just after", "judgement", "", "off by", "its interval", "tolerance", "n")
        blocks.append(Block("Jumps", table=Table(columns, jumps, first=2)))
    return Part(f"Changes of {switching.mode}: {switching.standing}", tuple(blocks))


def _way(way: Way, counted: list[str]) -> tuple[str, ...]:
    counts = [COUNTS[title](way) for title in counted]
    timing = way.timing
    times = (
        ("–", "–", "–")
        if timing is None
        else (
            seconds(timing.late),
            ranged(timing.interval, Unit("s", 1.0)),
            seconds(timing.allowed),
        )
    )
    return (f"{way.source} to {way.target}", str(way.standing), *map(str, counts), *times)


def features_part(features: Features, prefix: str) -> Part:
    """The robot's topology beside the spec's."""
    sentences = tuple(each.sentence for each in features.features)
    blocks = [Block("", sentences, is_list=True)]
    if len(features.axes) >= 2 and any(len(f.spec_path) for f in features.features):
        caption = (
            "Features of the field: blue, dashed or hollow, where the spec has them; orange, solid"
            " or full, where the robot has them."
        )
        figure = plotted(draw_features(features), f"{prefix}features", caption)
        blocks.append(Block("", figure=figure))
    rows = tuple(
        (feature.name, each.name, str(each.standing), *_feature_cells(each))
        for feature in features.features
        for each in feature.numbers
    )
    if rows:
        titles = ("feature", "number", "judgement", "spec", "seen", "refitted field", "allowed")
        blocks.append(Block("", table=Table(titles, rows, first=2)))
    blocks.append(Block("", features.notes, is_list=True))
    return Part("Features of the field", tuple(blocks))


def _feature_cells(each: FeatureNumber) -> tuple[str, ...]:
    allowed = "–" if math.isinf(each.tolerance) else quantity(each.tolerance, each.unit)
    spec = quantity(each.spec, each.unit)
    return (spec, _estimate(each.seen, each.unit), _estimate(each.refitted, each.unit), allowed)


def _estimate(estimate: Estimate | None, unit: Unit) -> str:
    if estimate is None:
        return "–"
    return f"{_beside(estimate.value, estimate.interval, unit)} ({ranged(estimate.interval, unit)})"


def limits_part(limits: Limits, prefix: str) -> Part:
    """What the trace can't tell, and what it would have caught."""
    blocks: list[Block] = []
    if limits.not_told:
        rows = tuple((each.what, each.why, each.suggestion) for each in limits.not_told)
        titles = ("not told", "because", "what would tell")
        blocks.append(Block("What this trace can't tell", table=Table(titles, rows, first=2)))
    if limits.caught:
        caption = (
            "Faults planted into copies of this very trace, which were then judged like the trace"
            " itself: a cross was caught (FAIL), a diamond left it open (INCONCLUSIVE), a dot"
            " passed unseen. The nearer the crosses come to the left, the sharper this trace is."
        )
        figure = plotted(draw_caught(limits), f"{prefix}caught", caption)
        sentences = tuple(each.sentence for each in limits.caught)
        blocks.append(Block("What would have been caught", sentences, is_list=True, figure=figure))
    blocks.append(Block("", limits.notes, is_list=True))
    return Part("How far this verdict reaches", tuple(blocks))


def scores_part(scores: Scores) -> Part:
    """The scores of similarity."""
    titles = ("", "ISO/TS 18571", "corridor", "phase", "magnitude", "slope", "NRMSE", "R²")
    rows = tuple(_score_row(each) for each in scores.variables)
    return Part(
        "Scores, for comparison only", (Block("", scores.sentences, table=Table(titles, rows)),)
    )


def _score_row(each: VariableScores) -> tuple[str, ...]:
    iso = each.iso
    parts = (
        (math.nan,) * 5
        if iso is None
        else (iso.overall, iso.corridor, iso.phase, iso.magnitude, iso.slope)
    )
    shares = (f"{part:.3f}" if math.isfinite(part) else "–" for part in (*parts, each.r_squared))
    *iso_parts, r_squared = shares
    return (each.name, *iso_parts, number(each.nrmse), r_squared)


def _beside(value: float, interval: Interval, unit: Unit) -> str:
    """A number in as many digits as its interval is shown in."""
    scale = unit.scale
    return number(value / scale, digits_of(interval.low / scale, interval.high / scale))
