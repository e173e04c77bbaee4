"""Requirements on a run, as JSON values and as text."""

import math
from collections.abc import Sequence

from verifier.report.layout import INDENT, section, table
from verifier.report.requirement_results import RequirementResult


def requirements_record(results: Sequence[RequirementResult]) -> list[dict[str, object]]:
    """Robustness stands in the unit that is named, null where nothing bounds it; values in SI."""
    return [
        {
            "require": each.text,
            "outcome": str(each.outcome),
            "unit": each.unit.text,
            "robustness": [_number(each.low, each), _number(each.high, each)],
            "witness": None
            if each.witness is None
            else {"time": each.witness.time, "values": each.witness.values},
            "sentence": each.sentence,
            "origin": each.origin,
        }
        for each in results
    ]


def requirements_text(results: Sequence[RequirementResult]) -> str:
    """A row for each requirement: as written, and what the run says of it."""
    return section("requirements", [table([(r.text, r.sentence) for r in results], INDENT)])


def _number(value: float, result: RequirementResult) -> float | None:
    return value / result.unit.scale if math.isfinite(value) else None
