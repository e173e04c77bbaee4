"""Whether a compiled sketch looks as it was drawn: the verifier's word to the compiler."""

from dataclasses import replace

from runtime.program import Program
from verifier.topology.claims import judge
from verifier.topology.findings import Ruling


def faults_of(program: Program) -> tuple[str, ...]:
    """What the program's field lacks of its sketch, or has beside it, at the controls' defaults.

    Over whole domains of controls the same claims are judged by `specc check --claims`.
    """
    claims = tuple(replace(claim, over=()) for claim in program.claims if claim.sketched)
    found = judge(program, claims)
    return tuple(
        f"{finding.claim.text}: {finding.sentence}"
        for finding in found
        if finding.ruling is Ruling.REFUTED
    )
