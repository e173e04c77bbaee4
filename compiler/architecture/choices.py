"""Names of choices, where a way of deciding names one."""

from collections.abc import Sequence

from compiler.findings import Findings
from spec_schema.places import Path
from spec_schema.suggest import did_you_mean, there_are


def check_choice(
    name: str, choices: Sequence[str], path: Path, findings: Findings, *, key: bool = False
) -> None:
    """A finding where the arbiter has no choice of that name."""
    if name not in choices:
        remedy = did_you_mean(name, choices) or there_are(choices)
        findings.error("S323", path, f"the arbiter has no choice '{name}'", remedy, key=key)
