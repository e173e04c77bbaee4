"""Many recordings judged in one call: an outcome for each, and a verdict on all together."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache, partial
from pathlib import Path
from typing import TypeAlias, final

from runtime.arbiter import Arbiter
from runtime.program import Program
from spec_schema.diagnostics import SpecError
from specc.verifying.architecture import NotJudged
from specc.verifying.recording import REQUIREMENTS, verify_carried
from specc.verifying.standard import carried_by, is_of_runs
from specc.verifying.trace import Clock, Verification, program_for_verify, verify_by
from verifier.arbitration.together import pooled_decisions
from verifier.architectures.telling import without_logs
from verifier.fidelity.together import pooled
from verifier.report.examination import Depth, Examination
from verifier.report.report import WORST_FIRST, Report, Verdict
from verifier.report.wording import listed
from verifier.traces.files.log import Progress


@final
@dataclass(frozen=True, slots=True)
class Unusable:
    """A recording without a verdict: it, or its spec, can't be used."""

    source: str
    error: SpecError


Outcome: TypeAlias = Verification | NotJudged | Unusable


def source_of(outcome: Outcome) -> str:
    """The recording that it is about, and which part of it."""
    return outcome.report.trace.source if isinstance(outcome, Verification) else outcome.source


def verify_each(
    traces: Sequence[Path | str],
    spec: Path | str | Program | None = None,
    clock: Clock = "auto",
    *,
    allow_code: bool = False,
    strict: bool = False,
    depth: Depth = "all",
    progress: Callable[[str, str], None] | None = None,
    reading: Progress | None = None,
) -> Iterator[Outcome]:
    """Judge recordings one after the other, each like `verify`; a spec is compiled only once.

    One that can't be used does not stop the others. The recording of a scenario has an outcome
    for what it requires, and for each node of each robot.

    Args:
        allow_code: whether arbiters that are code of the user's own may be run.
        strict: any loss in a log is an error.
        depth: what is found out beside the verdict.
        progress: is told which recording it is, and what is done next.
        reading: is told now and then how many bytes of how many of it were read.

    Raises:
        SpecError: the spec that was named can't be used.
    """
    program_of = cache(partial(program_for_verify, allow_code=allow_code))
    named = spec if spec is None or isinstance(spec, Program) else Path(spec)
    if isinstance(named, Path) and not is_of_runs(named):
        program_of(named)
    how = _How(named, clock, program_of, allow_code, strict, depth, reading)
    for trace in distinct(traces):
        tell = None if progress is None else partial(progress, str(trace))
        try:
            yield from _judged(Path(trace), how, tell)
        except SpecError as error:
            yield Unusable(str(trace), error)


def distinct(traces: Sequence[Path | str]) -> tuple[Path | str, ...]:
    """The files, each once, however often and by whatever path it is named."""
    return tuple({Path(each).resolve(): each for each in reversed(traces)}.values())[::-1]


@final
@dataclass(frozen=True, eq=False, slots=True)
class _How:
    """How each of many recordings is judged: see `verify_each`."""

    spec: Path | Program | None
    clock: Clock
    program_of: Callable[[Path], Program | Arbiter]
    allow_code: bool
    strict: bool
    depth: Depth
    reading: Progress | None


def _judged(trace: Path, how: _How, tell: Callable[[str], None] | None) -> Iterator[Outcome]:
    """The outcomes of one recording.

    Raises:
        SpecError: it or its spec can't be used.
    """
    carried = carried_by(trace)
    if carried is None:
        yield verify_by(
            trace,
            how.spec,
            how.clock,
            how.program_of,
            strict=how.strict,
            depth=how.depth,
            progress=tell,
            reading=how.reading,
        )
        return
    run = verify_carried(
        trace,
        carried,
        how.spec,
        how.program_of,
        allow_code=how.allow_code,
        strict=how.strict,
        depth=how.depth,
        progress=tell,
        reading=how.reading,
    )
    yield from run.judged
    yield from run.not_judged


def verifications(outcomes: Sequence[Outcome]) -> tuple[Verification, ...]:
    """Those that have a verdict."""
    return tuple(each for each in outcomes if isinstance(each, Verification))


def not_judged(outcomes: Sequence[Outcome]) -> tuple[NotJudged, ...]:
    """Nodes of which nothing can be said."""
    return tuple(each for each in outcomes if isinstance(each, NotJudged))


def unusable(outcomes: Sequence[Outcome]) -> tuple[Unusable, ...]:
    """Those that have none."""
    return tuple(each for each in outcomes if isinstance(each, Unusable))


@final
@dataclass(frozen=True, eq=False, slots=True)
class Pool:
    """Two or more recordings of one spec, and the verdict on them together."""

    members: tuple[Verification, ...]
    examination: Examination

    @property
    def report(self) -> Report:
        """The common verdict and its evidence."""
        return self.examination.report


@final
@dataclass(frozen=True, eq=False, slots=True)
class Runs:
    """The outcome of each recording, and those of one spec together.

    is_whole: whether all recordings that were named have an outcome.
    """

    outcomes: tuple[Outcome, ...]
    pools: tuple[Pool, ...]
    is_whole: bool = True

    @property
    def only(self) -> Verification | None:
        """The one verdict, where one recording was judged by one spec."""
        first = self.outcomes[0] if self.is_whole and len(self.outcomes) == 1 else None
        return first if isinstance(first, Verification) and not first.part else None

    @property
    def members(self) -> frozenset[Verification]:
        """The recordings whose verdict is part of a common one."""
        return frozenset(each for pool in self.pools for each in pool.members)

    @property
    def verdict(self) -> Verdict | None:
        """FAIL where one recording fails; None where one can't be used; else that of all together.

        With recordings of several specs, the worst.
        """
        judged, members = verifications(self.outcomes), self.members
        if any(each.report.verdict is Verdict.FAIL for each in judged):
            return Verdict.FAIL
        if unusable(self.outcomes):
            return None
        found = {each.report.verdict for each in judged if each not in members}
        found |= {pool.report.verdict for pool in self.pools}
        return next((verdict for verdict in WORST_FIRST if verdict in found), None)


def verify_together(
    traces: Sequence[Path | str],
    spec: Path | str | Program | None = None,
    clock: Clock = "auto",
    *,
    allow_code: bool = False,
    strict: bool = False,
    depth: Depth = "all",
    progress: Callable[[str, str], None] | None = None,
) -> Runs:
    """Judge recordings each by itself, and all of one spec together.

    Short ones may decide together what none of them does. Arguments and errors: see `verify_each`.
    """
    each = verify_each(
        traces,
        spec,
        clock,
        allow_code=allow_code,
        strict=strict,
        depth=depth,
        progress=progress,
    )
    return runs_of(tuple(each))


def runs_of(outcomes: Sequence[Outcome], *, is_whole: bool = True) -> Runs:
    """The outcomes, with a common verdict on those of each spec."""
    by_spec: dict[tuple[str, str, str], list[Verification]] = {}
    for each in verifications(outcomes):
        if isinstance(each.found.program, tuple):
            continue  # what is required holds in each run, or does not
        spec = each.report.spec
        by_spec.setdefault((spec.name, spec.sha256, each.part), []).append(each)
    pools = tuple(_pool(members) for members in by_spec.values() if len(members) > 1)
    return Runs(tuple(outcomes), pools, is_whole)


def _pool(members: Sequence[Verification]) -> Pool:
    examination = _together(members)
    if part := members[0].part:
        report = examination.report
        trace = replace(report.trace, source=f"{report.trace.source}: {part}")
        examination = without_logs(replace(examination, report=replace(report, trace=trace)))
    return Pool(tuple(members), examination)


def _together(members: Sequence[Verification]) -> Examination:
    program = members[0].found.program
    if isinstance(program, Arbiter):
        return pooled_decisions([each.examination for each in members])
    assert isinstance(program, Program), "requirements are not judged together"
    report = pooled(program, [each.judgement for each in members if each.judgement])
    return Examination(report, origins=members[0].examination.origins)


def failing(pool: Pool) -> tuple[Verification, ...]:
    """The recordings that fail by themselves."""
    return tuple(each for each in pool.members if each.report.verdict is Verdict.FAIL)


def decided(pool: Pool) -> Verdict:
    """FAIL where one recording fails by itself, else the verdict on all together."""
    return Verdict.FAIL if failing(pool) else pool.report.verdict


def counted(runs: Runs) -> str:
    """`5 recordings: 1 fail, 3 pass, 1 can't be used`.

    What scenarios require, and a node of theirs, counts once for all recordings of it.
    """
    found = [*_verdicts(runs)]
    parts = [f"{found.count(v)} {v}" for v in WORST_FIRST if v in found]
    lost, skipped = len(unusable(runs.outcomes)), len(_unjudged_parts(runs))
    parts += [f"{skipped} not judged"] if skipped else []
    parts += [f"{lost} can't be used"] if lost else []
    return f"{_things(runs)}: {', '.join(parts) or 'none judged'}"


def _verdicts(runs: Runs) -> Iterator[Verdict]:
    """Of each recording by itself; of a scenario's requirements and nodes of all together."""
    pooled = {each for pool in runs.pools if pool.members[0].part for each in pool.members}
    required: dict[str, set[Verdict]] = {}
    for each in verifications(runs.outcomes):
        if each.part == REQUIREMENTS:
            required.setdefault(each.report.spec.name, set()).add(each.report.verdict)
        elif each not in pooled:
            yield each.report.verdict
    yield from (next(v for v in WORST_FIRST if v in found) for found in required.values())
    yield from (decided(pool) for pool in runs.pools if pool.members[0].part)


def _unjudged_parts(runs: Runs) -> set[tuple[str, str]]:
    """Nodes of which nothing can be said, and why."""
    return {
        (each.source.removeprefix(recording_of(each)), each.why)
        for each in not_judged(runs.outcomes)
    }


def _things(runs: Runs) -> str:
    """`5 recordings`; of scenarios' `requirements and 4 nodes of 1 recording`."""
    every = [each for each in verifications(runs.outcomes) if each.part]
    pools = [pool for pool in runs.pools if pool.members[0].part]
    saved = sum(len(pool.members) - 1 for pool in pools)
    has_required = any(each.part == REQUIREMENTS for each in every)
    nodes = sum(each.part != REQUIREMENTS for each in every) - saved + len(_unjudged_parts(runs))
    told = ["requirements"] if has_required else []
    told += [_plural(nodes, "node")] if nodes else []
    recordings = _plural(len({recording_of(each) for each in runs.outcomes}), "recording")
    if not told:
        return recordings
    return f"{listed(told)} {'of' if is_of_one(runs.outcomes) else 'in'} {recordings}"


def is_of_one(outcomes: Sequence[Outcome]) -> bool:
    """Whether all is about one recording, whose name need not be said."""
    return len({recording_of(each) for each in outcomes}) == 1


def recording_of(outcome: Outcome) -> str:
    """The file that it is about."""
    if isinstance(outcome, Unusable):
        return outcome.source
    source = source_of(outcome)
    is_part = isinstance(outcome, NotJudged) or outcome.part
    return source.rpartition(": ")[0] if is_part else source


def _plural(count: int, what: str) -> str:
    return f"{count} {what}" if count == 1 else f"{count} {what}s"
