"""How a robot's arbiter decides, as plain text and as rows of tables."""

import math
from typing import Final

from verifier.report.arbitration import Arbitration, Region, Threshold
from verifier.report.layout import INDENT, bullets, section, table
from verifier.report.report import Interval
from verifier.report.wording import exact, number, span

MOST_CELLS: Final = 8
REGION_TITLES: Final = ("where", "decisions", "agree", "interval", "")
THRESHOLD_TITLES: Final = ("threshold", "spec", "robot", "")


def arbitration_text(of: Arbitration) -> str:
    """Sentences, thresholds, and where decisions agree."""
    blocks = [bullets(of.sentences)]
    if of.thresholds:
        rows = [THRESHOLD_TITLES, *(threshold_row(each) for each in of.thresholds)]
        blocks.append(table(rows, INDENT))
    blocks.append(table([REGION_TITLES, *region_rows(of.cells or of.boxes)], INDENT))
    if of.share.agreeing < of.share.decisions:
        rows = [("robot \\ spec", *of.choices), *confusion_rows(of)]
        blocks.append(table(rows, INDENT))
    return section("decisions", blocks)


def threshold_row(each: Threshold) -> tuple[str, ...]:
    """The comparison, the spec's value, where the robot's lies, and what follows."""
    return (each.comparison, exact(each.value, each.unit), _where(each), str(each.standing))


def _where(each: Threshold) -> str:
    low, high = each.interval.low, each.interval.high
    if math.isinf(low) and math.isinf(high):
        return "anywhere"
    if math.isinf(low):
        return f"at most {exact(high, each.unit)}"
    return f"at least {exact(low, each.unit)}" if math.isinf(high) else span(low, high, each.unit)


def region_rows(regions: tuple[Region, ...]) -> tuple[tuple[str, ...], ...]:
    """The worst regions: what holds there, and how far decisions agree."""
    return tuple(
        (
            ", ".join(each.conditions),
            str(each.share.decisions),
            f"{number(100.0 * each.share.value, 4)} %",
            _percents(each.share.interval),
            str(each.standing),
        )
        for each in regions[:MOST_CELLS]
    )


def _percents(interval: Interval) -> str:
    return f"{number(100.0 * interval.low)} to {number(100.0 * interval.high)} %"


def confusion_rows(of: Arbitration) -> tuple[tuple[str, ...], ...]:
    """A row for each choice of the robot: how often the spec has which."""
    return tuple(
        (choice, *(str(count) for count in row))
        for choice, row in zip(of.choices, of.confusion.tolist(), strict=True)
    )
