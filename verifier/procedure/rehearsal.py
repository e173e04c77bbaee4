"""A procedure driven by the spec itself, with noisy sensors, and judged as recordings are.

So a procedure is tried before anybody drives it: a faithful robot must pass, and one that departs
by more than the tolerance must fail. What departs is planted as a push: a constant that is added
to the rate of one variable.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Integers
from runtime.code import Code
from runtime.program import Program, Term
from verifier.fidelity.judging.part_means import CLUSTER_HORIZONS
from verifier.fidelity.judging.parts import LEAST
from verifier.fidelity.judging.sentences import times_more
from verifier.fidelity.together import pooled
from verifier.fidelity.verify import Judgement, fidelity_of, judgement_of
from verifier.procedure.driving import Paths, Plans, driven_paths
from verifier.procedure.model import Planted, Rehearsal, Signal, WayTime
from verifier.procedure.robot import Robot
from verifier.procedure.sampled import sampled_paths
from verifier.report.report import Report, Standing, Verdict
from verifier.report.switching import Timing
from verifier.traces.trace import Series, Trace

FORBIDDEN: Final = 2.0
"""A planted robot is carried away by so many tolerances at the horizon, on average."""
MOST_REPEATS: Final = 40
"""Nobody repeats a run more often."""
MOST_RECORDINGS: Final = 150
"""Nobody makes more of one behavior."""
ENOUGH: Final = 16
"""So often, at most, for the sake of what is planted, or of changes of mode."""
SPARE: Final = 1.3
"""So many times as much as the verifier asks for, since its figures are not known better."""
FASTEST: Final = 8.0
"""By which repeats grow at once."""
SEEDS_APART: Final = 1000
OTHER_SEEDS: Final = (100007, 200007)
"""Of rehearsals on other days."""
SWITCHES: Final = 16
"""A way out of a mode is taken so often: at ticks, it is late by anything up to a period."""
PLENTY: Final = 16
"""So many recordings are not rehearsed again."""
TRIES: Final = 4
"""So often a push is corrected until it carries that far."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Staging:
    """What is rehearsed: plans of C runs that last (C,) seconds, sampled `every` seconds.

    program: that is judged by. near: the same within the reach of the sensors, which drives.
    """

    program: Program
    near: Program
    robot: Robot
    plans: Plans
    lasts: Array
    signals: tuple[Signal, ...]
    every: float
    seed: int


def rehearsed(staging: Staging, names: Sequence[str]) -> tuple[int, Rehearsal]:
    """How often each run is repeated until the verifier decides, and what it then says.

    names: the variables along which a robot is pushed, each in turn.
    """
    repeats = _fewest(staging)
    judgements = _judgements(staging, staging.near, range(repeats))
    report = _together(staging, judgements)
    while report.verdict is Verdict.INCONCLUSIVE:
        more = _repeats(repeats, report, len(staging.plans.start))
        if more <= repeats:
            break
        judgements += _judgements(staging, staging.near, range(repeats, more))
        repeats, report = more, _together(staging, judgements)
    planted = tuple(_planted(staging, name, repeats) for name in names)
    most = min(ENOUGH, MOST_RECORDINGS // len(staging.plans.start))
    while report.verdict is Verdict.PASS and not (
        all(each.is_caught for each in planted)
        and all(way.count >= SWITCHES for way in _way_times(judgements))
        and _again(staging, names, repeats)
    ):
        more = 2 * repeats
        if more > most:
            break
        judgements += _judgements(staging, staging.near, range(repeats, more))
        repeats, report = more, _together(staging, judgements)
        planted = tuple(_planted(staging, name, repeats) for name in names)
    coverage = report.coverage
    share = 0.0 if coverage is None else coverage.share
    judged = report.trace.judged
    ways = _way_times(judgements)
    return repeats, Rehearsal(report.verdict, share, judged, report.reasons, planted, ways)


def _way_times(judgements: Sequence[Judgement]) -> tuple[WayTime, ...]:
    """What is asked of each way out of a mode that was taken, on average over its switches."""
    timed: dict[tuple[str, str], list[Timing]] = {}
    for each in judgements:
        for way in each.switching.ways if each.switching is not None else ():
            if way.timing is not None and np.isfinite(way.timing.allowed):
                timed.setdefault((way.source, way.target), []).append(way.timing)
    found = []
    for (source, target), several in timed.items():
        counts = [timing.count for timing in several]
        allowed = float(np.average([timing.allowed for timing in several], weights=counts))
        found.append(WayTime(source, target, sum(counts), allowed, several[0].basis))
    return tuple(found)


def _fewest(staging: Staging) -> int:
    """So often that twice what the smallest judged part needs is there: real robots are worse."""
    horizon = max(fidelity_of(staging.program).horizon, staging.program.field.every)
    wanted = 2.0 * LEAST * CLUSTER_HORIZONS * horizon
    return int(np.ceil(wanted / max(float(np.sum(staging.lasts)), staging.every)))


def _again(staging: Staging, names: Sequence[str], repeats: int) -> bool:
    """Whether other days would have given the same verdicts; many recordings are sure to."""
    if repeats * len(staging.plans.start) > PLENTY:
        return True
    for seed in OTHER_SEEDS:
        other = replace(staging, seed=seed)
        report = _together(other, _judgements(other, other.near, range(repeats)))
        if report.verdict is not Verdict.PASS:
            return False
        if not all(_planted(other, name, repeats).is_caught for name in names):
            return False
    return True


def _repeats(repeats: int, report: Report, runs: int) -> int:
    """How often to try next: as much more as the verifier itself would ask for."""
    most = min(MOST_REPEATS, max(MOST_RECORDINGS // runs, 1))
    short = [r for r in report.variables if r.standing is Standing.UNDECIDED]
    factor = max((times_more(result) for result in short), default=0.0)
    wanted = repeats * min(max(SPARE * factor, 2.0), FASTEST)
    return int(min(np.ceil(wanted), most if short else min(most, ENOUGH)))


def _together(staging: Staging, judgements: Sequence[Judgement]) -> Report:
    return pooled(_plainly_logged(staging.program), judgements)


def _judgements(staging: Staging, robot: Program, repeats: range) -> list[Judgement]:
    """Of each run where `robot` drives, and the spec is the staging's program."""
    again = np.tile(np.arange(len(staging.plans.start)), len(repeats))
    seed = staging.seed + SEEDS_APART * repeats.start
    paths = _driven(staging, robot, again, seed)
    spec, rng = _plainly_logged(staging.program), np.random.default_rng(seed)
    traces = [_trace(staging, paths, c, rng) for c in range(len(again)) if paths.alive[c] > 1]
    return [replace(judgement_of(spec, each), study=None) for each in traces]


def _driven(staging: Staging, program: Program, runs: Integers, seed: int) -> Paths:
    """Some of the runs, driven by a robot with this field and the staging's timing and sensors."""
    plans, every = staging.plans.part(runs), staging.every
    if staging.robot.is_prompt or program.field.is_map:
        paths = driven_paths(program, plans, every, seed)
    else:
        told = {each.name: each.noise for each in staging.signals}
        noise = np.array([told.get(state.name, 0.0) for state in program.states])
        paths = sampled_paths(program, plans, staging.robot, every, seed, noise)
    most = np.floor(staging.lasts[runs] / every + 1e-9).astype(np.int64) + 1
    return replace(paths, alive=np.minimum(paths.alive, most))


def _plainly_logged(program: Program) -> Program:
    """The program judged in all of a recording: nobody interferes with a rehearsal."""
    return replace(program, judge_when=None)


def _trace(staging: Staging, paths: Paths, run: int, rng: np.random.Generator) -> Trace:
    """What the sensors make of one run."""
    alive = int(paths.alive[run])
    times = paths.times[:alive]
    series = {}
    register = staging.program.register
    for each in staging.signals:
        values = paths.register[run, :alive, register.index(each.name)]
        noisy = values + each.noise * rng.standard_normal(alive) if each.noise else values
        series[each.name] = Series(each.name, times, noisy, f"/{each.name}", "sensor")
    return Trace(f"run {run}", series, {}, float(run), (), ())


def _planted(staging: Staging, name: str, repeats: int) -> Planted:
    """A robot that is pushed along one variable."""
    tolerance = fidelity_of(staging.program).tolerance[name]
    push, carried = _push(staging, name, FORBIDDEN * tolerance)
    robot = pushed(staging.near, name, push)
    report = _together(staging, _judgements(staging, robot, range(repeats)))
    named = [r.name for r in report.variables if r.standing is Standing.EXCEEDED]
    return Planted(name, push, carried, report.verdict, name in named)


def _push(staging: Staging, name: str, wanted: float) -> tuple[float, float]:
    """A push that carries `wanted` away at the horizon, on average, and how far it does."""
    program = staging.program
    horizon = max(fidelity_of(program).horizon, program.field.every)
    push = wanted / max(horizon / (program.field.every or horizon), 1.0)
    push /= 1.0 if program.field.is_map else horizon
    carried = 0.0
    for _ in range(TRIES):
        carried = _carried(staging, name, push, horizon)
        if carried <= 0.0 or abs(carried - wanted) < 0.1 * wanted:
            break
        push *= wanted / carried
    return push, carried


def _carried(staging: Staging, name: str, push: float, horizon: float) -> float:
    """How far a push carries one variable from where the spec goes, after one horizon."""
    samples = max(round(horizon / staging.every), 1)
    short = replace(staging.plans, held=staging.plans.held[:, :1], seconds=samples * staging.every)
    ends = [
        _at_end(driven_paths(robot, short, staging.every, staging.seed), name, staging.program)
        for robot in (staging.near, pushed(staging.near, name, push))
    ]
    apart = np.abs(ends[1] - ends[0])
    apart = apart[np.isfinite(apart)]
    return float(np.mean(apart)) if apart.size else 0.0


def _at_end(paths: Paths, name: str, program: Program) -> Array:
    return np.asarray(paths.register[:, -1, program.register.index(name)])


def pushed(program: Program, name: str, push: float) -> Program:
    """The program with a constant added to one rate (of a step map: to its next value)."""
    field = program.field
    place = field.driven.index(name)
    if field.terms:
        term = Term(place, Code(repr(push)), -1, 0)
        return replace(program, field=replace(field, terms=(*field.terms, term)))
    assert field.formula is not None, "a field without tables is a formula"
    codes = list(field.formula)
    codes[place] = Code(f"{codes[place].text} {push!r} add")
    return replace(program, field=replace(field, formula=tuple(codes)))
