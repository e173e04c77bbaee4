"""Many recordings judged in one call: an outcome for each, and a verdict on all together."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path
from typing import Final, TypeAlias, final

from runtime.program import Program
from spec_schema.diagnostics import SpecError
from specc.verifying import Clock, Verification, program_for_verify, verify_by
from specc.verifying_recording import attached_architectures, verify_recording
from verifier.fidelity.together import pooled
from verifier.report.examination import Examination
from verifier.report.report import Report, Verdict
from verifier.traces.files.log import Progress

WORST_FIRST: Final = (Verdict.FAIL, Verdict.INCONCLUSIVE, Verdict.PASS)


@final
@dataclass(frozen=True, slots=True)
class Unusable:
    """A recording without a verdict: it, or its spec, can't be used."""

    source: str
    error: SpecError


Outcome: TypeAlias = Verification | Unusable


def source_of(outcome: Outcome) -> str:
    """The recording that it is about."""
    return outcome.source if isinstance(outcome, Unusable) else outcome.report.trace.source


def verify_each(
    traces: Sequence[Path | str],
    spec: Path | str | Program | None = None,
    clock: Clock = "auto",
    *,
    strict: bool = False,
    only_verdict: bool = False,
    progress: Callable[[str, str], None] | None = None,
    reading: Progress | None = None,
) -> Iterator[Outcome]:
    """Judge recordings one after the other, each like `verify`; a spec is compiled only once.

    One that can't be used does not stop the others. The recording of a scenario has an outcome
    for each node of each robot.

    Args:
        strict: any loss in a log is an error.
        only_verdict: leave out what explains the verdicts.
        progress: is told which recording it is, and what is done next.
        reading: is told now and then how many bytes of how many of it were read.

    Raises:
        SpecError: the spec that was named can't be used.
    """
    program_of = cache(program_for_verify)
    if spec is not None and not isinstance(spec, Program):
        program_of(Path(spec))
    for trace in traces:
        tell = None if progress is None else partial(progress, str(trace))
        try:
            attached = attached_architectures(Path(trace)) if spec is None else {}
            if attached:
                yield from verify_recording(
                    Path(trace), attached, only_verdict=only_verdict, progress=tell
                )
                continue
            yield verify_by(
                Path(trace),
                spec,
                clock,
                program_of,
                strict=strict,
                only_verdict=only_verdict,
                progress=tell,
                reading=reading,
            )
        except SpecError as error:
            yield Unusable(str(trace), error)


def verifications(outcomes: Sequence[Outcome]) -> tuple[Verification, ...]:
    """Those that have a verdict."""
    return tuple(each for each in outcomes if isinstance(each, Verification))


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
    """The outcome of each recording, and those of one spec together."""

    outcomes: tuple[Outcome, ...]
    pools: tuple[Pool, ...]

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
    strict: bool = False,
    only_verdict: bool = False,
    progress: Callable[[str, str], None] | None = None,
) -> Runs:
    """Judge recordings each by itself, and all of one spec together.

    Short ones may decide together what none of them does. Arguments and errors: see `verify_each`.
    """
    each = verify_each(
        traces, spec, clock, strict=strict, only_verdict=only_verdict, progress=progress
    )
    return runs_of(tuple(each))


def runs_of(outcomes: Sequence[Outcome]) -> Runs:
    """The outcomes, with a common verdict on those of each spec."""
    by_spec: dict[tuple[str, str], list[Verification]] = {}
    for each in verifications(outcomes):
        if each.judgement is None:
            continue  # decisions of several logs are not put together
        spec = each.report.spec
        by_spec.setdefault((spec.name, spec.sha256), []).append(each)
    pools = tuple(_pool(members) for members in by_spec.values() if len(members) > 1)
    return Runs(tuple(outcomes), pools)


def _pool(members: Sequence[Verification]) -> Pool:
    program = members[0].found.program
    assert isinstance(program, Program), "what has a judgement was judged by a program"
    report = pooled(program, [each.judgement for each in members if each.judgement])
    return Pool(tuple(members), Examination(report, origins=members[0].examination.origins))


def counted(outcomes: Sequence[Outcome]) -> str:
    """`5 recordings: 1 fail, 3 pass, 1 can't be used`."""
    found = [each.report.verdict for each in verifications(outcomes)]
    parts = [f"{found.count(v)} {v}" for v in WORST_FIRST if v in found]
    lost = len(unusable(outcomes))
    parts += [f"{lost} can't be used"] if lost else []
    total = len(outcomes)
    return f"{total} recording{'' if total == 1 else 's'}: {', '.join(parts) or 'none judged'}"
