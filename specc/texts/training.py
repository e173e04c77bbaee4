"""What came of a training, as text for people and as a record for programs."""

from dataclasses import asdict
from typing import Any, Final

from specc.texts.amounts import counted
from specc.texts.arbiters import arbiter_record, arbiter_summary
from specc.training.course import Course
from specc.training.episode import training_of
from specc.training.judging import CONFIDENCE, Judged
from specc.training.last_race import LAST
from specc.training.result import Ended, Trained
from specc.training.speed import Shares, shares_of
from verifier.report.layout import INDENT, bullets, section, table, wrapped
from verifier.report.wording import number, percent

FEW: Final = 5
"""So many seeds of failures are told; the record has all."""
SAME: Final = 1e-3
"""A smaller share of the reward is no difference."""
COLUMNS: Final = ("", "rules", "success (95 %)", "reward", "seconds")


def training_text(trained: Trained) -> str:
    """What was learnt, how well it does beside others, what it says, and what it took."""
    parts = [_head(trained), _judged_text(trained), arbiter_summary(trained.arbiter)]
    return "\n\n".join(part for part in (*parts, _speed_text(trained)) if part)


def generation_text(course: Course, worlds: int) -> str:
    """How the last generation went, in a line: its race was in so many worlds."""
    last = course.generations[-1]
    who = "a new list" if last.is_new else "the same list"
    took = last.took.exploring + last.took.learning + last.took.trying
    return (
        f"generation {len(course.generations)}: {who} is best, with success in "
        f"{percent(last.tried.success)} of {counted(worlds, 'world')} and reward "
        f"{number(last.tried.reward)}; {counted(course.episodes, 'episode')} so far; "
        f"this one took {took:,.0f} s"
    )


def training_record(trained: Trained) -> dict[str, Any]:
    """The same for programs, with each generation."""
    begun, course = trained.begun, trained.course
    return {
        "scenario": begun.scenario,
        "settings": asdict(begun.settings),
        "held_out": begun.held_out,
        "arbiter": arbiter_record(trained.arbiter),
        "best": course.generations.index(trained.best) + 1,
        "final": asdict(trained.kept.trial),
        "generations": [
            {
                "episodes": each.episodes,
                "decisions": each.decisions,
                "explored": asdict(each.explored),
                "tried": asdict(each.tried),
                "failed": [asdict(failure) for failure in each.failed],
                "rules": len(each.rules),
                "is_new": each.is_new,
                "raced": each.raced,
                "took": asdict(each.took),
            }
            for each in course.generations
        ],
        "judged": [{**asdict(each), "failed": list(each.failed)} for each in trained.judged],
        "confidence": CONFIDENCE,
        "compaction": _compaction_record(trained),
        "speed": asdict(shares_of(trained.course, trained.pace, trained.jobs)),
        "ended": asdict(trained.ended),
    }


def _head(trained: Trained) -> str:
    settings, course = trained.begun.settings, trained.course
    trains = training_of(trained.scenario).arbiter
    last, count = course.generations[-1], len(course.generations)
    steps = f"{counted(course.episodes, 'episode')}, {last.decisions + last.raced:,} decisions"
    lived = f"lived {steps}, in {counted(count, 'generation')}{_ending(trained)}"
    worlds = counted(LAST * settings.tried_in, "world")
    head = f"{trained.scenario.name}: {settings.learner} learnt how {trains} decides"
    return "\n".join([head, wrapped(lived), wrapped(_plainer(trained, worlds))])


def _plainer(trained: Trained, worlds: str) -> str:
    """What was given up of the best list, and what that cost where it was tried."""
    was, now, kept = trained.best.rules, trained.kept.rules, trained.kept
    if not len(now) and not len(was):
        always = trained.arbiter.choices[now.otherwise]
        return (
            f"no list did better than to choose {always} always: that succeeds in "
            f"{percent(kept.trial.success)} of {worlds}, with a reward of "
            f"{number(kept.trial.reward)}; more episodes may help"
        )
    if (len(was), was.conditions) == (len(now), now.conditions):
        return (
            f"the best list was tried in {worlds} more, and no rule or condition of it could be "
            f"given up; there it succeeds in {percent(kept.trial.success)}, with a reward of "
            f"{number(kept.trial.reward)}"
        )
    few = f"{counted(len(now), 'rule')} with {counted(now.conditions, 'condition')}"
    return (
        f"the best list was made plain by trials in {worlds} more: {few} instead of {len(was)} "
        f"with {was.conditions}; there it succeeds in {percent(kept.trial.success)} instead of "
        f"{percent(kept.before.success)}, with a reward of {number(kept.trial.reward)} instead of "
        f"{number(kept.before.reward)}"
    )


def _ending(trained: Trained) -> str:
    settings, course = trained.begun.settings, trained.course
    if course.episodes >= settings.episodes or not course.is_stale(settings):
        return ""
    most, after = f"{settings.episodes:,}", counted(settings.patience, "race")
    return f" (it stopped before {most}: nothing beat the same list in {after})"


def _judged_text(trained: Trained) -> str:
    if not trained.judged:
        return ""
    rows = [COLUMNS, *(_row(each) for each in trained.judged)]
    said = [*_compaction(trained), *_failures(trained)]
    worlds = counted(trained.begun.held_out, "world")
    title = f"in {worlds} held out: nothing was learnt or chosen in them"
    return section(title, [table(rows, INDENT), bullets(said)])


def _row(one: Judged) -> tuple[str, ...]:
    success = f"{one.trial.success:.0%} ({100 * one.low:.0f} to {one.high:.0%})".replace("%", " %")
    rules = "" if one.rules is None else f"{one.rules:,}"
    return one.what, rules, success, f"{one.trial.reward:.4g}", f"{one.trial.seconds:.1f}"


def _compaction(trained: Trained) -> list[str]:
    """What it costs that the rules are few."""
    few, votes = trained.judged[0], trained.judged[1]
    cost = votes.trial.reward - few.trial.reward
    decided = f"to decide by {counted(few.rules or 0, 'rule')} and not by the vote of {votes.rules}"
    if abs(cost) <= SAME * abs(votes.trial.reward):
        return [f"{decided} costs no reward"]
    if cost > 0.0:
        return [f"{decided} costs {number(cost)} of the reward of an episode"]
    return [f"{decided} costs nothing: it gets {number(-cost)} more in an episode"]


def _failures(trained: Trained) -> list[str]:
    """Seeds by which failures can be looked at."""
    failed = trained.judged[0].failed
    if not failed:
        return []
    seeds = ", ".join(str(seed) for seed in failed[:FEW])
    more = f" and {len(failed) - FEW} more" if len(failed) > FEW else ""
    return [f"what was learnt fails with the seeds {seeds}{more} (specc simulate --seed)"]


def _compaction_record(trained: Trained) -> dict[str, Any]:
    before, after = len(trained.table), len(trained.kept.rules)
    record: dict[str, Any] = {"rules_before": before, "rules": after}
    was, kept = trained.best.rules, trained.kept
    record["plainer"] = {
        "rules": [len(was), len(kept.rules)],
        "conditions": [was.conditions, kept.rules.conditions],
        "success": [kept.before.success, kept.trial.success],
        "reward": [kept.before.reward, kept.trial.reward],
    }
    if trained.judged:
        few, votes = trained.judged[0].trial, trained.judged[1].trial
        record["reward_lost"] = votes.reward - few.reward
    return record


def _speed_text(trained: Trained) -> str:
    shares = shares_of(trained.course, trained.pace, trained.jobs)
    return section("what it took", [table(_speed_rows(shares, trained.ended), INDENT)])


def _speed_rows(shares: Shares, ended: Ended) -> list[tuple[str, str]]:
    processes = "one process" if shares.jobs == 1 else f"{shares.jobs} processes"
    parts = (
        ("the world", shares.world),
        ("control", shares.control),
        ("beginning and rewards", shares.rewards),
        ("learning", shares.learning),
    )
    bare = f"{shares.per_second_bare:,.0f} decisions a second: the same commands, and nothing else"
    return [
        ("generations", f"{shares.seconds:,.1f} s on {processes}"),
        ("the last race", f"{ended.racing:,.1f} s, and {ended.plain:,.1f} s of trials"),
        ("judging", f"{ended.judging:,.1f} s, with learning once more from all that was lived"),
        ("speed", f"{shares.per_second:,.0f} decisions a second"),
        ("the world alone", f"{bare}, on one process"),
        ("shares", ", ".join(f"{what} {100 * share:.0f} %" for what, share in parts)),
    ]
