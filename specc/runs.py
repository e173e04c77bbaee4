"""Many recordings judged in one call: an outcome for each, and what they come to together."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path
from typing import Final, TypeAlias, final

from runtime.program import Program
from spec_schema.diagnostics import SpecError
from specc.verifying import Clock, Verification, program_for_verify, verify_by
from verifier.report.report import Verdict

WORST_FIRST: Final = (Verdict.FAIL, Verdict.INCONCLUSIVE, Verdict.PASS)


@final
@dataclass(frozen=True, slots=True)
class Unusable:
    """A recording without a verdict: it, or its spec, can't be used."""

    source: str
    error: SpecError


Outcome: TypeAlias = Verification | Unusable


def verify_each(
    traces: Sequence[Path | str],
    spec: Path | str | Program | None = None,
    clock: Clock = "auto",
    *,
    strict: bool = False,
    only_verdict: bool = False,
    progress: Callable[[str, str], None] | None = None,
) -> Iterator[Outcome]:
    """Judge recordings one after the other, each like `verify`; a spec is compiled only once.

    One that can't be used does not stop the others.

    Args:
        strict: any loss in a log is an error.
        only_verdict: leave out what explains the verdicts.
        progress: is told which recording it is, and what is done next.

    Raises:
        SpecError: the spec that was named can't be used.
    """
    program_of = cache(program_for_verify)
    if spec is not None and not isinstance(spec, Program):
        program_of(Path(spec))
    for trace in traces:
        tell = None if progress is None else partial(progress, str(trace))
        try:
            yield verify_by(
                Path(trace),
                spec,
                clock,
                program_of,
                strict=strict,
                only_verdict=only_verdict,
                progress=tell,
            )
        except SpecError as error:
            yield Unusable(str(trace), error)


def verifications(outcomes: Sequence[Outcome]) -> tuple[Verification, ...]:
    """Those that have a verdict."""
    return tuple(each for each in outcomes if isinstance(each, Verification))


def unusable(outcomes: Sequence[Outcome]) -> tuple[Unusable, ...]:
    """Those that have none."""
    return tuple(each for each in outcomes if isinstance(each, Unusable))


def together(outcomes: Sequence[Outcome]) -> Verdict | None:
    """FAIL where one recording fails; None where one can't be used; else the worst verdict."""
    found = {each.report.verdict for each in verifications(outcomes)}
    if unusable(outcomes) and Verdict.FAIL not in found:
        return None
    return next((verdict for verdict in WORST_FIRST if verdict in found), None)


def counted(outcomes: Sequence[Outcome]) -> str:
    """`5 recordings: 1 fail, 3 pass, 1 can't be used`."""
    found = [each.report.verdict for each in verifications(outcomes)]
    parts = [f"{found.count(v)} {v}" for v in WORST_FIRST if v in found]
    lost = len(unusable(outcomes))
    parts += [f"{lost} can't be used"] if lost else []
    total = len(outcomes)
    return f"{total} recording{'' if total == 1 else 's'}: {', '.join(parts) or 'none judged'}"
