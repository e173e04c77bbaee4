"""What came of runs in a world, as text."""

from collections.abc import Sequence

import numpy as np

from specc.learning.world_summary import WorldSummary
from specc.texts.amounts import counted, percent
from verifier.report.layout import INDENT, section, table


def run_text(one: WorldSummary) -> str:
    """What came of a run."""
    rows = [
        ("steps to the goal", f"{one.steps:.2f} on average, optimum {one.optimal_steps:.2f}"),
        ("return", f"{one.returns:.2f} on average, optimum {one.optimal_returns:.2f}"),
        ("tested on", f"{counted(one.starts, 'start')}, by the best actions{_missed(one)}"),
        ("boxes", _boxes(one)),
        ("learnt from", _learnt_from(one)),
        ("speed", f"{one.per_second:,.0f} episodes a second"),
    ]
    return section(f"seed {one.seed}", [table(rows, INDENT)])


def _missed(one: WorldSummary) -> str:
    if one.reached == 1.0:
        return "; all led to the goal"
    return f"; {percent(1.0 - one.reached)} did not lead to the goal in 500 steps"


def _boxes(one: WorldSummary) -> str:
    if one.first_grown is None:
        return "none yet: nothing is known, and all actions are taken at random"
    few = one.thinned
    told = f"{one.boxes:,} at the end, first grown after {counted(one.first_grown, 'episode')}"
    return f"{told}; {few.rules:,} rules after compaction say the same in {percent(few.accuracy)}"


def _learnt_from(one: WorldSummary) -> str:
    tries = "try" if one.tried == 1 else "tries"
    return f"{one.tried:,} {tries} at random in {counted(one.episodes, 'episode')}"


def mean_text(summaries: Sequence[WorldSummary]) -> list[str]:
    """The mean over several runs."""
    if len(summaries) < 2:
        return []
    rows = [
        (name, f"{np.mean(all_):.2f} ({min(all_):.2f} to {max(all_):.2f})")
        for name, all_ in (
            ("steps to the goal", [each.steps for each in summaries]),
            ("optimum", [each.optimal_steps for each in summaries]),
            ("return", [each.returns for each in summaries]),
            ("optimum", [each.optimal_returns for each in summaries]),
        )
    ]
    return [section("mean of all runs", [table(rows, INDENT)])]
