"""The section of a page that says whether a run is as its scenario requires."""

from collections.abc import Sequence

from specc.pages.page import Block, Part, Table
from verifier.report.requirement_results import RequirementResult

TITLES = ("required", "outcome", "what decides")


def requirements_part(results: Sequence[RequirementResult]) -> Part:
    """A row for each requirement."""
    rows = tuple((each.text, str(each.outcome), each.detail) for each in results)
    return Part("Requirements", (Block("", table=Table(TITLES, rows, first=1, last=1)),))
