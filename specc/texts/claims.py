"""What was found of claims, as text for people and as records for programs."""

import math
from collections import Counter
from collections.abc import Iterator, Sequence
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
    head = f"{finding.claim.origin}: {finding.ruling}: {_claim_words(program, finding)}"
    lines = [head, f"  {finding.sentence}", f"  {finding.how}"]
    witness = finding.witness
    if witness is not None:
        settings = settings_words(program, witness.settings)
        place = settings_words(program, witness.place)
        at = f"at {place}" if place else ""
        if settings or at:
            lines.append(f"  witness: {'; '.join(words for words in (settings, at) if words)}")
    lines += [f"  {line}" for line in _boundary_lines(program, finding.boundaries)]
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
        "claim": _claim_words(program, finding),
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


def _claim_words(program: Program, finding: Finding) -> str:
    """The claim with all its conditions."""
    parts = _parts(program)
    spans = [
        f"{span.control} from {value_words(parts[span.control], span.low)} "
        f"to {value_words(parts[span.control], span.high)}"
        for span in finding.claim.over
    ]
    return f"{finding.claim.text}, over {' and '.join(spans)}" if spans else finding.claim.text


def _boundary_lines(program: Program, boundaries: Sequence[Boundary]) -> Iterator[str]:
    """A line for each interval of a control on which the claim holds."""
    waiting: Boundary | None = None
    for boundary in boundaries:
        if waiting is not None and (boundary.above or boundary.control != waiting.control):
            yield _one_sided(program, waiting)
            waiting = None
        if boundary.above:
            waiting = boundary
        elif waiting is not None:
            yield _two_sided(program, waiting, boundary)
            waiting = None
        else:
            yield _one_sided(program, boundary)
    if waiting is not None:
        yield _one_sided(program, waiting)


def _one_sided(program: Program, boundary: Boundary) -> str:
    side, other = ("above", "below") if boundary.above else ("below", "above")
    text = f"holds for {boundary.control} {side} {_edge(program, boundary)}"
    text += f" (± {_known(program, boundary)})"
    if boundary.change is Change.OTHER:
        return f"{text}; {other}: {boundary.about}"
    return f"{text}: {boundary.change}, {boundary.about}"


def _two_sided(program: Program, low: Boundary, high: Boundary) -> str:
    ends = [_edge(program, low), _edge(program, high)]
    rough = max(low, high, key=lambda boundary: boundary.within)
    text = f"holds for {low.control} from {ends[0]} to {ends[1]} (± {_known(program, rough)})"
    for boundary, end in zip((low, high), ends, strict=True):
        if boundary.change is Change.OTHER:
            text += f"; {'below' if boundary.above else 'above'} {end}: {boundary.about}"
        else:
            text += f"; at {end}: {boundary.change}, {boundary.about}"
    return text


def _edge(program: Program, boundary: Boundary) -> str:
    """Where it is, in as many digits as are known."""
    part = _parts(program)[boundary.control]
    step = 10.0 ** math.floor(math.log10(boundary.within)) if boundary.within > 0.0 else 1e-12
    return value_words(part, step * round(boundary.value / step))


def _known(program: Program, boundary: Boundary) -> str:
    return f"{boundary.within / _parts(program)[boundary.control].unit.scale:.1g}"


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
