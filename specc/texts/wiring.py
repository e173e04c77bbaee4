"""The wiring of an architecture, for people and for programs."""

from dataclasses import asdict
from typing import Any

from specc.wired import Box, Mouth, Port, Sort, Wired


def record(wired: Wired) -> dict[str, Any]:
    """All boxes, sensors, channels and nets, for JSON."""
    return asdict(wired)


def summary(wired: Wired) -> str:
    """The floors from above, each node with its wires; then the channels."""
    lines = [f"{wired.name}: {wired.about}" if wired.about else wired.name]
    sources: dict[tuple[str, str], str] = {}
    for net in wired.nets:
        for target in net.targets:
            known = sources.get(target)
            name = ".".join(net.source)
            sources[target] = f"{known} or {name}" if known else name
    for level in range(max(box.level for box in wired.boxes), -1, -1):
        lines += ["", "base behaviors" if level == 0 else f"control modules, level {level}"]
        for box in wired.boxes:
            if box.level == level:
                lines += _box(box, wired, sources)
    lines += ["", f"body {wired.body}"]
    lines += [line for mouth in wired.mouths for line in _mouth(mouth)]
    unread = [eye.name for eye in wired.eyes if not eye.readings]
    if unread:
        lines.append(f"  sensors that no node reads: {', '.join(unread)}")
    return "\n".join(lines)


def _box(box: Box, wired: Wired, sources: dict[tuple[str, str], str]) -> list[str]:
    lines = [f"  {box.name} ({box.what}): {box.clock}"]
    lines += [f"    {note}" for note in box.notes]
    lines += [f"    senses {_set(port, box, sources)}" for port in box.senses]
    lines += [f"    control {_set(port, box, sources)}" for port in box.controls]
    if box.outputs:
        lines.append(f"    tells {', '.join(port.name for port in box.outputs)}")
    for net in wired.nets:
        if net.source[0] == box.name and net.sort is Sort.CHOICE:
            does = ", ".join(".".join(target) for target in net.targets)
            lines.append(f"    chooses {net.source[1]}: {does}")
    lines += [
        f"    commands {port.name}" + (f" by {port.note}" if port.note else "")
        for port in box.tells
        if (box.name, port.name) not in _choices(wired)
    ]
    return lines


def _choices(wired: Wired) -> set[tuple[str, str]]:
    named = {net.source for net in wired.nets if net.sort is Sort.COMMAND}
    return {(b.name, p.name) for b in wired.boxes for p in b.tells} - named


def _set(port: Port, box: Box, sources: dict[tuple[str, str], str]) -> str:
    source = sources.get((box.name, port.name))
    if source is None:
        return f"{port.name} = {port.note}" if port.note else port.name
    return f"{port.name} from {source}" + (f" ({port.note})" if port.note else "")


def _mouth(mouth: Mouth) -> list[str]:
    who = ", ".join(port.name for port in mouth.claims)
    line = f"  {mouth.name}: {mouth.what}" + (f" ({who})" if who else "")
    return [f"{line}; at rest: {mouth.rest}", *([f"    {mouth.proof}"] if mouth.proof else [])]
