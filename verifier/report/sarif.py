"""Findings as SARIF 2.1.0 (OASIS 2020), which code hosts show beside the spec's lines."""

import hashlib
import re
from collections.abc import Sequence
from pathlib import PurePosixPath, PureWindowsPath
from typing import Final
from urllib.parse import quote

from verifier.report.findings import MEANINGS, Finding, Rule
from verifier.report.places import Place, place_of

SCHEMA: Final = "https://json.schemastore.org/sarif-2.1.0.json"
NAMES: Final = {rule: "".join(word.title() for word in rule.split("-")) for rule in Rule}
DRIVE: Final = re.compile(r"^[A-Za-z]:[\\/]")


def as_sarif(runs: Sequence[tuple[str, Sequence[Finding]]], version: str) -> dict[str, object]:
    """One SARIF log with one run: the findings of each trace, `(source, findings)`.

    Everything that holds is silent: only what is wrong or open is a result.
    """
    results = [_result(finding, source) for source, findings in runs for finding in findings]
    driver = {
        "name": "specc",
        "semanticVersion": version,
        "rules": [
            {
                "id": str(rule),
                "name": NAMES[rule],
                "shortDescription": {"text": MEANINGS[rule]},
            }
            for rule in Rule
        ],
    }
    run = {"tool": {"driver": driver}, "columnKind": "unicodeCodePoints", "results": results}
    return {"$schema": SCHEMA, "version": "2.1.0", "runs": [run]}


def _result(finding: Finding, source: str) -> dict[str, object]:
    place = place_of(finding.origin)
    physical = {} if place is None else {"physicalLocation": _physical(place)}
    logical = {"name": finding.subject or str(finding.rule), "kind": "variable"}
    identity = f"{finding.rule}\n{finding.subject}\n{source}"
    return {
        "ruleId": str(finding.rule),
        "ruleIndex": list(Rule).index(finding.rule),
        "level": str(finding.level),
        "message": {"text": f"{source}: {finding.message}"},
        "locations": [physical | {"logicalLocations": [logical]}],
        # The same finding keeps its identity when its numbers or its line change.
        "partialFingerprints": {"finding/v1": hashlib.sha256(identity.encode()).hexdigest()},
        "properties": {"trace": source},
    }


def _physical(place: Place) -> dict[str, object]:
    physical: dict[str, object] = {"artifactLocation": {"uri": uri_of(place.file)}}
    if place.line:
        physical["region"] = {"startLine": place.line, "startColumn": place.column}
    return physical


def uri_of(file: str) -> str:
    r"""A file as a URI reference: relative to the repository, or `file:` for an absolute path.

    >>> uri_of("specs/a b.yaml"), uri_of("/tmp/a.yaml"), uri_of(r"C:\specs\a.yaml")
    ('specs/a%20b.yaml', 'file:///tmp/a.yaml', 'file:///C:/specs/a.yaml')
    """
    if DRIVE.match(file):
        return "file:///" + quote(PureWindowsPath(file).as_posix(), safe="/:")
    path = PurePosixPath(file)
    return ("file://" if path.is_absolute() else "") + quote(str(path))
