"""What came of an experiment of learners, as text for people and as a record for programs."""

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any, Final

import numpy as np

from lcs.problems.steps import Plane
from lcs.problems.table import Table
from lcs.rules.words import in_words, reward_text
from specc.learning.experiment import record_of, usual
from specc.learning.learners import called
from specc.learning.learning import Learnt
from specc.learning.summary import Summary
from specc.learning.teaching_worlds import tolerance_of
from specc.learning.thinning import names_of
from specc.texts.amounts import counted, percent
from specc.texts.episodes import mean_text, run_text
from verifier.report.layout import INDENT, bullets, section, table

MOST_RULES: Final = 16
"""So many are printed; more are in files."""

NOTABLE: Final = 0.005
"""The share of problems beyond what was learnt from that is worth a word."""


def learning_text(learnt: Learnt) -> str:
    """What was learnt in each run, and what the figures mean."""
    experiment = learnt.experiment
    runs = "a run" if len(learnt.runs) == 1 else f"{len(learnt.runs)} runs"
    cycles = counted(experiment.cycles, usual(experiment.problem).unit)
    head = f"{learnt.problem.name} by {called(experiment.learner)}: {runs} of {cycles}"
    summaries = [each.summary for each in learnt.outcomes]
    if isinstance(learnt.problem, Plane):
        runs_text = [run_text(each) for each in summaries]
        means = mean_text(summaries)
    else:
        is_table = isinstance(learnt.problem, Table)
        runs_text = [_run_text(each, is_table=is_table) for each in summaries]
        means = _mean_text(summaries)
    return "\n\n".join([head, *runs_text, *means, *_rules_text(learnt)])


def _rules_text(learnt: Learnt) -> list[str]:
    """The rules of the first run that choose an action, where they are few enough to be read."""
    first, names = learnt.outcomes[0], names_of(learnt.problem)
    few = first.compacted.table
    choosing = few.prediction == few.prediction.max(initial=-np.inf)
    if not 0 < choosing.sum() <= MOST_RULES:
        return []
    sentences = in_words(few, names, first.seen.inputs)
    said = [str(each) for each in sentences if choosing[each.rule]]
    title = "rules that choose an action, after compaction"
    if isinstance(learnt.problem, Plane):
        lost = reward_text(tolerance_of(learnt.problem))
        title = f"where a move is as good as the best, or loses {lost} of return at most"
    return [section(f"{title} (seed {first.summary.seed})", [bullets(said)])]


def _run_text(one: Summary, *, is_table: bool) -> str:
    """is_table: whether problems are rows, some kept to test on and the others shown repeatedly."""
    rest = " kept to test on" if is_table else ""
    asked = f"{counted(one.fresh, 'row' if is_table else 'fresh problem')}{rest}"
    shown = "showings of rows" if is_table else "problems"
    rows = [
        ("accuracy", f"{percent(one.accuracy)} of {asked}{_unknown(one)}"),
        ("performance", _performance(one)),
        ("rules", _rules(one)),
        ("births and deaths", f"{one.births:,} and {one.deaths:,}"),
        ("learnt from", f"{one.tried:,} of {counted(one.cycles, 'cycle')}; the others tested"),
        ("speed", f"{one.per_second:,.0f} {shown} a second"),
    ]
    return section(f"seed {one.seed}", [table(rows, INDENT)])


def _unknown(one: Summary) -> str:
    told = ""
    if one.uncovered:
        told += f"; {percent(one.uncovered)} count as wrong, since an action has no rule there"
    if one.beyond >= NOTABLE:
        told += f"; {percent(one.beyond)} lie beyond what was learnt from, taken at its end"
    return told


def _performance(one: Summary) -> str:
    if one.performance is None or one.error is None:
        return "no cycle was a test"
    last = f"the last {one.tests:,} tests" if one.tests > 1 else "the only test"
    told = f"{percent(one.performance)} of {last}, system error {percent(one.error)}"
    if one.right_of_last is not None:
        told += f"; {one.right_of_last:,} of the last 10,000"
    return told


def _rules(one: Summary) -> str:
    told = f"{one.rules:,} at the end, {one.most_rules:,} at most"
    told += f" (after learning from {counted(one.most_rules_at, 'cycle')})"
    few = one.thinned
    return f"{told}; {few.rules:,} after compaction, {percent(few.accuracy)} right"


def _mean_text(summaries: Sequence[Summary]) -> list[str]:
    """The mean over several runs."""
    if len(summaries) < 2:
        return []
    accuracy = [100.0 * each.accuracy for each in summaries]
    rules = [each.rules for each in summaries]
    rows = [
        ("accuracy", f"{np.mean(accuracy):.2f} % ({min(accuracy):.2f} to {max(accuracy):.2f})"),
        ("rules", f"{np.mean(rules):,.0f} ({min(rules):,} to {max(rules):,})"),
    ]
    return [section("mean of all runs", [table(rows, INDENT)])]


def learning_record(learnt: Learnt) -> dict[str, Any]:
    """The same for programs; only `seconds` and `per_second` differ between two equal runs."""
    return {
        "experiment": record_of(learnt.experiment),
        "runs": [
            {**asdict(each.summary), "per_second": each.summary.per_second}
            for each in learnt.outcomes
        ],
    }
