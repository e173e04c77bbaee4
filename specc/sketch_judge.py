"""Whether a compiled sketch looks as it was drawn: the verifier's word to the compiler."""

from dataclasses import replace
from typing import Final

from runtime.program import Control, Program
from verifier.topology.claims.findings import Finding, Ruling
from verifier.topology.claims.judge import judge
from verifier.topology.features import Settings

SHARES: Final = ((0.02, 0.98), (0.98, 0.02))
"""Beside the defaults: every other control near one end of its domain, the rest near the other."""


def faults_of(program: Program) -> tuple[str, ...]:
    """What the program's field lacks of its sketch, or has beside it, in sentences.

    Looked at with the controls at their defaults and near opposite corners of their domains.
    """
    corners = [_corner(program.controls, shares) for shares in SHARES] if program.controls else []
    for settings in ((), *corners):
        claims = tuple(replace(c, settings=settings) for c in program.claims if c.sketched)
        found = judge(program, claims)
        faults = tuple(_told(f) for f in found if f.ruling is Ruling.REFUTED)
        if faults:
            return faults
    return ()


def _corner(controls: tuple[Control, ...], shares: tuple[float, float]) -> Settings:
    return tuple(
        (control.name, control.low + shares[i % 2] * (control.high - control.low))
        for i, control in enumerate(controls)
    )


def _told(finding: Finding) -> str:
    settings = ", ".join(f"{name} = {value:.4g}" for name, value in finding.claim.settings)
    where = f" (at {settings}, SI)" if settings else ""
    return f"{finding.claim.text}: {finding.sentence}{where}"
