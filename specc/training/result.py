"""What came of a training: the arbiter with its rules, how it does, and what that took."""

from dataclasses import dataclass
from pathlib import Path
from time import perf_counter
from typing import Final, final

import numpy as np

from compiler.architecture.arbiters import lower_arbiter
from compiler.architecture.library import Library
from compiler.findings import Findings
from lcs.policies.decision_list import DecisionList, always, uncounted
from lcs.policies.steps import joined
from lcs.rules.table import RuleTable
from runtime.arbiter import Arbiter
from runtime.progress import Progress
from runtime.scenario import Scenario
from spec_schema.arbiter import ArbiterSpec
from spec_schema.diagnostics import Diagnostic
from spec_schema.editing.edits import EditError
from spec_schema.load import Loaded, load, load_source
from spec_schema.source import Source
from specc.faults import fault
from specc.training.challengers import policy_of
from specc.training.compaction import Trials, compacted
from specc.training.course import Course, Generation, Trial, trial_of
from specc.training.episode import Task, trained_arbiter
from specc.training.folder import Begun
from specc.training.judging import Judged, judged
from specc.training.last_race import last_race
from specc.training.pace import Pace, paced
from specc.training.remembered import Remembered
from specc.training.spelled import with_rules
from specc.training.workers import Workers
from specc.training.worlds import For, world

PACED: Final = 8
"""Episodes by which the pace is measured: one alone may be over after a few decisions."""

BY_HAND: Final = "write `by:` with its learner on a line below, as in docs/training.md"


@final
@dataclass(frozen=True, eq=False, slots=True)
class Kept:
    """The list that is kept, how it did in the last race, and how it did before it was plain."""

    rules: DecisionList
    trial: Trial
    before: Trial


@final
@dataclass(frozen=True, slots=True)
class Ended:
    """Seconds of the end: for the last race, for making its winner plain, and for judging."""

    racing: float
    plain: float
    judging: float


@final
@dataclass(frozen=True, eq=False, slots=True)
class Trained:
    """What came of a training.

    scenario: as it was begun with. source, edited: the arbiter's text, and that with its rules.
    arbiter: compiled from the latter; warnings: on the way. course: all generations. best: the one
    whose list won the last race. kept: the rules that were made of that list. table: all rules that
    are learnt from everything, in the first draw. judged: these beside others, where any worlds
    were held out. ended: what the end took, by a clock.
    """

    begun: Begun
    scenario: Scenario
    source: Source
    edited: Source
    arbiter: Arbiter
    warnings: tuple[Diagnostic, ...]
    course: Course
    best: Generation
    kept: Kept
    table: RuleTable
    judged: tuple[Judged, ...]
    ended: Ended
    pace: Pace
    jobs: int


def concluded(
    begun: Begun,
    scenario: Scenario,
    loaded: Loaded,
    course: Course,
    workers: Workers,
    tell: Progress,
    remembered: Remembered,
) -> Trained:
    """What came of a training that is over.

    Args:
        begun: what was trained, and how.
        scenario: as it was begun with.
        loaded: the arbiter's text, as `text_of` reads it.
        course: all that was lived and learnt.
        workers: live the episodes in which it is judged.
        tell: is told what is done, how much of it, and of how much.
        remembered: what its end found out before it was interrupted.

    Raises:
        NoRoomError, UserCodeError, LearnerError, SpecError: as `go_on`.
    """
    clock = [perf_counter()]
    race = last_race(course, begun.settings, workers, tell, remembered)
    clock.append(perf_counter())
    plain = compacted(race.winner, Trials(race.worlds, workers, tell, remembered))
    clock.append(perf_counter())
    tell("learning from everything", 0, 1)
    lived = joined((*course.lived, *(each.steps for each in plain.episodes)))
    found = policy_of(lived, scenario, begun.settings, len(course.generations))
    rules, table = found.counted(plain.rules), found.tables[0]
    before = trained_arbiter(scenario)
    beside = judged((rules, table), before, begun.held_out, workers, tell) if begun.held_out else ()
    clock.append(perf_counter())
    edited = with_rules(loaded, before, begun.settings.learner, rules)
    arbiter, warnings = _compiled(edited)
    tell("measuring the pace", 0, 1)
    seeds = [world(For.CHOOSING, i) for i in range(PACED)]
    pace = paced(scenario, [Task(seed, rules, 0.0) for seed in seeds])
    return Trained(
        begun=begun,
        scenario=scenario,
        source=loaded.source,
        edited=edited,
        arbiter=arbiter,
        warnings=warnings,
        course=course,
        best=race.best,
        kept=Kept(rules, trial_of(plain.episodes), trial_of(race.winner.episodes)),
        table=table,
        judged=beside,
        ended=Ended(*np.diff(clock).tolist()),
        pace=pace,
        jobs=workers.processes,
    )


def text_of(scenario: Scenario, learner: str) -> Loaded:
    """The text of the arbiter that is trained, into which rules can be written.

    Raises:
        SpecError: it can't be read, or is written in a way that can't be changed in place (V415).
    """
    arbiter = trained_arbiter(scenario)
    loaded = load(Path(arbiter.source.file))
    nothing = np.full((1, len(arbiter.reads)), np.inf)
    one_rule = uncounted(np.zeros(1, np.int64), -nothing, nothing, 0)
    try:
        for rules in (always(0, len(arbiter.reads)), one_rule):
            with_rules(loaded, arbiter, learner, rules)
    except EditError as error:
        message = f"rules can't be written into this arbiter: {error}"
        raise fault("V415", arbiter.source.file, message, BY_HAND) from error
    return loaded


def _compiled(source: Source) -> tuple[Arbiter, tuple[Diagnostic, ...]]:
    loaded = load_source(source)
    assert isinstance(loaded.spec, ArbiterSpec), "it was one before its rules changed"
    findings = Findings(loaded)
    arbiter = lower_arbiter(loaded.spec, loaded, Library(), findings)
    return arbiter, findings.diagnostics
