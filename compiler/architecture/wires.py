"""Wires: for every entry of a node the signal or the value that it takes, checked end to end."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final, final

from compiler.architecture.bodies import FAR
from compiler.architecture.parts import Entry, Part, Parts, holds_always
from compiler.architecture.signals import why_unknown
from compiler.findings import Findings
from compiler.quantities import ONE, si_within
from runtime.architecture import Input, Outside, Signal
from runtime.program import Kind, Unit
from spec_schema.places import Path
from spec_schema.suggest import did_you_mean, nearest, there_are
from spec_schema.units import parse_unit
from spec_schema.wires import Wire
from spec_schema.wording import quoted

SLACK: Final = 1e-9
"""By how much of a domain's width a signal may lie outside: rounding of units."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Board:
    """The signals, and where each stands."""

    signals: tuple[Signal, ...]
    places: Mapping[str, int]


def inputs_of(part: Part, board: Board, parts: Parts, findings: Findings) -> tuple[Input, ...]:
    """The inputs of a node: all that it reads, then its controls; findings for what can't be."""
    if not part.is_known:
        return ()
    reads = {entry.name: entry for entry in part.reads}
    controls = {entry.name: entry for entry in part.controls}
    _check_names(part, reads, controls, findings)
    found = [_read(entry, part, board, parts, findings) for entry in part.reads]
    found += [_control(entry, part, board, parts, findings) for entry in part.controls]
    return tuple(one for one in found if one is not None)


def _check_names(
    part: Part, reads: Mapping[str, Entry], controls: Mapping[str, Entry], findings: Findings
) -> None:
    """A finding for each wire that leads to nothing."""
    for name in part.spec.sense:
        if name not in reads:
            message, remedy = _why_not_read(name, part, reads, controls)
            findings.error("S334", (*part.path, "sense", name), message, remedy, key=True)
    for name in part.spec.set:
        if name not in controls:
            known = list(controls)
            remedy = did_you_mean(name, known) or there_are(known)
            if name in reads:
                remedy = "it is sensed: wire it under `sense`"
            message = f"'{name}' is no control of {part.name}"
            findings.error("S334", (*part.path, "set", name), message, remedy, key=True)


def _why_not_read(
    name: str, part: Part, reads: Mapping[str, Entry], controls: Mapping[str, Entry]
) -> tuple[str, str]:
    if name in controls:
        return f"'{name}' is a control of {part.name}", "wire it under `set`"
    if part.program is not None and name in {state.name for state in part.program.states}:
        return f"{part.name} drives '{name}' and does not sense it", "remove the wire"
    known = list(reads)
    return f"{part.name} reads no '{name}'", did_you_mean(name, known) or there_are(known)


def _read(entry: Entry, part: Part, board: Board, parts: Parts, findings: Findings) -> Input | None:
    wire = part.spec.sense.get(entry.name)
    path: Path = (*part.path, "sense", entry.name)
    if wire is None:
        if _is_misspelt(entry.name, part):
            return None  # which is told at the wire
        at: Path = (*part.path, "sense") if part.spec.sense else part.path
        message = f"nothing is wired to '{entry.name}', which {part.name} senses"
        example = next(iter(_fitting(entry, board)), "SENSOR.READING")
        findings.error("S331", at, message, f"add '{entry.name}: {example}'", key=True)
        return None
    return _wired(entry, wire, path, board, parts, findings)


def _is_misspelt(name: str, part: Part) -> bool:
    """Whether a wire is probably meant for what the node reads, under another name."""
    reads = [entry.name for entry in part.reads]
    return any(nearest(other, reads) == name for other in part.spec.sense if other not in reads)


def _fitting(entry: Entry, board: Board) -> list[str]:
    """Signals of the entry's dimension, those that are most like it first."""
    if entry.unit is None:
        return []
    wanted = parse_unit(entry.unit.text).dimension
    found = [s for s in board.signals if parse_unit(s.unit.text).dimension == wanted]

    def unlike(signal: Signal) -> tuple[bool, bool]:
        return signal.name.rpartition(".")[2] != entry.name, signal.kind is not entry.kind

    return [signal.name for signal in sorted(found, key=unlike)]


def _control(
    entry: Entry, part: Part, board: Board, parts: Parts, findings: Findings
) -> Input | None:
    wire = part.spec.set.get(entry.name)
    path: Path = (*part.path, "set", entry.name)
    if wire is None:
        origin = findings.origin(part.path)
        return Input(entry.name, -1, entry.default or 0.0, 1.0, Outside.CLIP, origin)
    return _wired(entry, wire, path, board, parts, findings)


def _wired(
    entry: Entry, wire: Wire, path: Path, board: Board, parts: Parts, findings: Findings
) -> Input | None:
    if (wire.source is None) == (wire.value is None):
        message = "a wire comes from one signal, or is one value"
        findings.error("S336", path, message, "write 'from: SENSOR.READING' or 'value: 0.2'")
        return None
    origin = findings.origin(path)
    if wire.source is None:
        assert wire.value is not None, "one of both is there"
        value = _value(entry, wire.value, path, board, findings)
        return None if value is None else Input(entry.name, -1, value, 1.0, Outside.CLIP, origin)
    place = board.places.get(wire.source)
    at = findings.written((*path, "from"))
    if place is None:
        message = f"there is no signal {quoted(wire.source)}"
        if _could_be_told(wire.source, parts):
            return None
        findings.error("S330", at, message, why_unknown(wire.source, board.places, parts))
        return None
    signal = board.signals[place]
    if not _agree(entry, signal, wire, at, parts, findings):
        return None
    outside = Outside(wire.outside) if wire.outside is not None else Outside.CLIP
    return Input(entry.name, place, 0.0, wire.scale, outside, origin)


def _could_be_told(source: str, parts: Parts) -> bool:
    """Whether the signal's owner is a file with mistakes, so that nothing is known of it."""
    owner = source.partition(".")[0]
    part = parts.nodes.get(owner)
    return (part is not None and not part.is_known) or (part is None and parts.body is None)


def _value(
    entry: Entry, value: float | str, path: Path, board: Board, findings: Findings
) -> float | None:
    """A value that does not change, in SI and within the domain of what it is for."""
    if entry.values or entry.kind is Kind.DISCRETE:
        return _choice(entry, value, path, findings)
    if isinstance(value, str) and value.isidentifier():
        owned = [name for name in board.places if name.startswith(f"{value}.")]
        remedy = f"write one of {', '.join(owned)}" if owned else "write SENSOR.READING, or a value"
        findings.error("S330", path, f"{quoted(value)} is no signal", remedy)
        return None
    unit = ONE if entry.unit is None else parse_unit(entry.unit.text)
    return si_within(value, entry.name, (entry.low, entry.high), unit, "S333", path, findings)


def _choice(entry: Entry, value: float | str, path: Path, findings: Findings) -> float | None:
    if isinstance(value, float) and value in range(round(entry.high - entry.low) + 1):
        return float(value)
    if value in entry.values:
        return float(entry.values.index(str(value)))
    remedy = did_you_mean(str(value), entry.values) or there_are(entry.values)
    findings.error("S335", path, f"'{entry.name}' has no value {quoted(str(value))}", remedy)
    return None


def _agree(
    entry: Entry, signal: Signal, wire: Wire, path: Path, parts: Parts, findings: Findings
) -> bool:
    """Whether a signal can be what an entry is; a finding where it can't."""
    if entry.kind is Kind.DISCRETE:
        alike = _agree_discrete(entry, signal, path, findings)
        return alike and _is_always_one(entry, signal, wire, path, parts, findings)
    if entry.unit is not None:
        wanted, given = parse_unit(entry.unit.text), parse_unit(signal.unit.text)
        if wanted.dimension != given.dimension:
            message = f"'{signal.name}' is in {given.text}, and '{entry.name}' is in {wanted.text}"
            findings.error("S332", path, message, "wire it to a signal of its own dimension")
            return False
    if entry.unit is None or wire.outside is not None or _wraps(entry, signal, wire):
        return True
    ends = (wire.scale * signal.low, wire.scale * signal.high)
    low, high = max(min(ends), -FAR), min(max(ends), FAR)
    slack = SLACK * (entry.high - entry.low) if entry.high - entry.low < FAR else 0.0
    if entry.low - slack <= low and high <= entry.high + slack:
        return True
    scaled = f"{wire.scale:g} * " if wire.scale != 1.0 else ""
    message = (
        f"'{scaled}{signal.name}' is {_range(low, high, entry.unit)}, "
        f"and '{entry.name}' is known {_range(entry.low, entry.high, entry.unit)}"
    )
    short = f"from: {signal.name}" + (f", scale: {wire.scale:g}" if scaled else "")
    remedy = (
        f"write '{entry.name}: {{{short}, outside: clip}}' to take the edge of the domain, "
        "or 'outside: inhibit' to keep the node from acting there"
    )
    findings.error("S333", path, message, remedy)
    return False


def _wraps(entry: Entry, signal: Signal, wire: Wire) -> bool:
    """Whether an angle is wired to an angle: each wraps to the other's range."""
    turn = entry.high - entry.low
    whole = math.isclose(abs(wire.scale), 1.0) and math.isclose(turn, math.tau)
    return entry.kind is Kind.PERIODIC and (signal.kind is not Kind.PERIODIC or whole)


def _agree_discrete(entry: Entry, signal: Signal, path: Path, findings: Findings) -> bool:
    if signal.kind is not Kind.DISCRETE:
        message = f"'{signal.name}' is a number, and '{entry.name}' is one of some values"
        findings.error("S335", path, message, "wire it to a discrete signal, or write a value")
        return False
    count = round(signal.high - max(signal.low, 0.0)) + 1
    named = signal.values == entry.values or not signal.values or not entry.values
    if count == round(entry.high - entry.low) + 1 and named:
        return True
    told = ", ".join(signal.values) or f"{count} values"
    message = f"'{signal.name}' is {told}, and '{entry.name}' is {', '.join(entry.values)}"
    findings.error("S335", path, message, "give both the same values in the same order")
    return False


def _is_always_one(
    entry: Entry, signal: Signal, wire: Wire, path: Path, parts: Parts, findings: Findings
) -> bool:
    """Whether the values have one for whatever is told; a finding where they may not."""
    if signal.low >= entry.low or wire.outside is not None:
        return True
    first = entry.values[0] if entry.values else f"{entry.low:g}"
    when, instead = _why_none(parts.nodes[signal.name.partition(".")[0]])
    message = f"'{signal.name}' is none of its values {when}"
    remedy = (
        f"write '{entry.name}: {{from: {signal.name}, outside: inhibit}}' to keep the node from "
        f"acting there, or 'outside: clip' to take {first}; or {instead}"
    )
    findings.error("S333", path, message, remedy)
    return False


def _why_none(part: Part) -> tuple[str, str]:
    """When no choice of an arbiter is made, and what would change that."""
    if part.arbiter is not None and holds_always(part.arbiter):
        late = f"{1000 * part.response_time:g} ms after the start"
        when = f"before the first decision has effect, {late}"
        return when, f"give {part.name} a response_time of 0"
    return "where no choice holds", "let one choice hold always"


def _range(low: float, high: float, unit: Unit | None) -> str:
    if low <= -FAR and high >= FAR:
        return "without limits"
    if high >= FAR:
        return f"from {_shown(low, unit)} on without limit"
    if low <= -FAR:
        return f"up to {_shown(high, unit)} without a lower limit"
    return f"from {_shown(low, unit)} to {_shown(high, unit)}"


def _shown(value: float, unit: Unit | None) -> str:
    if unit is None:
        return f"{value:g}"
    shown = float(f"{value / unit.scale:.4g}")
    return f"{shown:g}" if unit.text == "1" else f"{shown:g} {unit.text}"
