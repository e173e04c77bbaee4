"""The section of a page that says how a robot's arbiter decides."""

from specc.pages.page import Block, Part, Table
from verifier.report.arbitration import Arbitration
from verifier.report.arbitration_text import (
    REGION_TITLES,
    THRESHOLD_TITLES,
    confusion_rows,
    region_rows,
    threshold_row,
)


def arbitration_part(of: Arbitration) -> Part:
    """Sentences, thresholds, a table of confusion, and where decisions agree."""
    blocks = [Block("", of.sentences, is_list=True)]
    if of.thresholds:
        rows = tuple(threshold_row(each) for each in of.thresholds)
        names = (*THRESHOLD_TITLES[:-1], "judgement")
        blocks.append(Block("Thresholds", table=Table(names, rows, first=3)))
    choices = ("the robot's choice \\ the spec's", *of.choices)
    blocks.append(Block("Choices", table=Table(choices, confusion_rows(of))))
    regions = (("By the thresholds", of.cells), ("By what was read", of.boxes))
    titles = (*REGION_TITLES[:-1], "judgement")
    blocks += [
        Block(title, table=Table(titles, region_rows(found), last=1))
        for title, found in regions
        if found
    ]
    return Part("Decisions", tuple(blocks))
