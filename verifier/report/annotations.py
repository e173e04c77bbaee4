"""Findings as annotations of GitHub Actions: workflow commands on standard output, a line each.

https://docs.github.com/en/actions/reference/workflows-and-actions/workflow-commands
"""

from collections.abc import Iterable
from typing import Final

from verifier.report.findings import Finding, Level
from verifier.report.places import place_of

COMMANDS: Final = {Level.ERROR: "error", Level.WARNING: "warning", Level.NOTE: "notice"}


def as_annotations(findings: Iterable[Finding], source: str = "") -> str:
    """`::error file=a.yaml,line=3,col=1,title=…::message`, a line each; `source` is the trace."""
    return "\n".join(
        annotation(
            COMMANDS[finding.level],
            finding.origin,
            f"{finding.rule} {finding.subject}".strip(),
            f"{source}: {finding.message}" if source else finding.message,
        )
        for finding in findings
    )


def annotation(command: str, origin: str, title: str, message: str) -> str:
    """One annotation, with whatever would end it early escaped."""
    place = place_of(origin)
    properties: dict[str, str] = {}
    if place is not None:
        properties["file"] = place.file
        if place.line:
            properties |= {"line": str(place.line), "col": str(place.column)}
    properties["title"] = title
    listed = ",".join(f"{name}={_property(value)}" for name, value in properties.items())
    return f"::{command} {listed}::{_data(message)}"


def _data(text: str) -> str:
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _property(text: str) -> str:
    return _data(text).replace(":", "%3A").replace(",", "%2C")
