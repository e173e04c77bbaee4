"""The claims of a spec, put to the judge."""

from pathlib import Path

from runtime.program import Program
from runtime.progress import Progress, in_silence
from specc.loading import as_program
from verifier.topology.claims.findings import Finding
from verifier.topology.claims.judge import judge


def check_claims(
    spec: Program | Path | str, progress: Progress = in_silence
) -> tuple[Finding, ...]:
    """What is found of each claim under `expect:`: proved, holds, refuted or undecided.

    `progress(what, done, of)` is called before each claim.

    Raises:
        SpecError: the spec is wrong, or the artifact is damaged.
    """
    return judge(as_program(spec), None, progress)
