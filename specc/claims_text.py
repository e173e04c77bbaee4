"""What was found of claims, as text for people and as records for programs."""

import math
from collections import Counter
from collections.abc import Sequence
from typing import Final

from runtime.program import Control, Program, State
from verifier.topology.branches.continuation import Change
from verifier.topology.claims.findings import Boundary, Finding, Ruling
from verifier.topology.features import Settings
from verifier.topology.words import settings_words, value_words

STYLES: Final = {
    Ruling.HOLDS_PROVED: "bold green",
    Ruling.HOLDS_SAMPLED: "green",
    Ruling.REFUTED: "bold red",
    Ruling.UNDECIDED: "bold yellow",
}


def finding_text(program: Program, finding: Finding) -> str:
    """A claim and what was found of it, in a few lines."""
    head = f"{finding.claim.origin}: {finding.ruling}: {finding.claim.text}"
    lines = [f"{head}{_span_words(program, finding)}", f"  {finding.sentence}", f"  {finding.how}"]
    witness = finding.witness
    if witness is not None:
        settings = settings_words(program, witness.settings) or "there are no controls"
        place = settings_words(program, witness.place)
        lines.append(f"  witness: {settings}" + (f"; at {place}" if place else ""))
    lines += [f"  {_boundary_text(program, boundary)}" for boundary in finding.boundaries]
    return "\n".join(lines)


def totals_text(findings: Sequence[Finding]) -> str:
    """`3 claims: 1 proved, 1 holds, 1 refuted`."""
    counts = Counter(finding.ruling for finding in findings)
    parts = [f"{counts[ruling]} {_in_total(ruling, counts[ruling])}" for ruling in counts]
    count = len(findings)
    return f"{count} claim{'' if count == 1 else 's'}: {', '.join(parts) or 'nothing to check'}"


def finding_record(program: Program, finding: Finding) -> dict[str, object]:
    """What `specc check --claims --format json` prints for one claim; values in their own units."""
    claim, witness = finding.claim, finding.witness
    return {
        "behavior": program.name,
        "claim": claim.text,
        "origin": claim.origin,
        "ruling": str(finding.ruling),
        "sentence": finding.sentence,
        "how": finding.how,
        "proved_share": finding.proved_share,
        "witness": None
        if witness is None
        else {
            "settings": _record(program, witness.settings),
            "place": _record(program, witness.place),
            "what": witness.what,
        },
        "boundaries": [_boundary_record(program, boundary) for boundary in finding.boundaries],
    }


def _in_total(ruling: Ruling, count: int) -> str:
    return "hold" if ruling is Ruling.HOLDS_SAMPLED and count > 1 else str(ruling)


def _span_words(program: Program, finding: Finding) -> str:
    parts = _parts(program)
    spans = [
        f"{span.control} from {value_words(parts[span.control], span.low)} "
        f"to {value_words(parts[span.control], span.high)}"
        for span in finding.claim.over
    ]
    return f", {' and '.join(spans)}" if spans else ""


def _boundary_text(program: Program, boundary: Boundary) -> str:
    part = _parts(program)[boundary.control]
    side = "above" if boundary.above else "below"
    step = 10.0 ** math.floor(math.log10(boundary.within)) if boundary.within > 0.0 else 1e-12
    value = value_words(part, step * round(boundary.value / step))
    known = f"± {boundary.within / part.unit.scale:.1g}"
    what = "" if boundary.change is Change.OTHER else f"{boundary.change}, "
    return f"holds for {boundary.control} {side} {value} ({known}): {what}{boundary.about}"


def _boundary_record(program: Program, boundary: Boundary) -> dict[str, object]:
    scale = _parts(program)[boundary.control].unit.scale
    return {
        "control": boundary.control,
        "value": boundary.value / scale,
        "within": boundary.within / scale,
        "holds": "above" if boundary.above else "below",
        "change": str(boundary.change),
        "about": boundary.about,
    }


def _record(program: Program, settings: Settings) -> dict[str, float | str]:
    parts = _parts(program)
    return {name: _value(parts[name], value) for name, value in settings}


def _value(part: State | Control, value: float) -> float | str:
    if isinstance(part, State) and part.values:
        return part.values[round(value)]
    return value / part.unit.scale


def _parts(program: Program) -> dict[str, State | Control]:
    named: list[State | Control] = [*program.states, *program.controls]
    return {part.name: part for part in named}
