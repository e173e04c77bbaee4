"""What an architecture stands on: imitations, hypothetical behaviors, and nodes without effect."""

from collections.abc import Mapping

from compiler.architecture.graph import governed_by
from compiler.architecture.parts import Part, Parts
from compiler.findings import Findings
from runtime.architecture import Command, Input, Signal
from spec_schema.wording import listed

IMITATION = "S222"


def check_standing(
    inputs: Mapping[str, tuple[Input, ...]],
    commands: Mapping[str, tuple[Command, ...]],
    board: tuple[Signal, ...],
    parts: Parts,
    findings: Findings,
) -> None:
    """Warnings on what a robot can't rely on, and on what nobody reads; notes on the rest."""
    read = {board[one.signal].name for many in inputs.values() for one in many if one.signal >= 0}
    _note_sensors(read, parts, findings)
    for part in parts.nodes.values():
        if not part.is_known:
            continue
        _check_feasible(part, findings)
        _check_effect(part, read, commands[part.name], parts, findings)
        _note_defaults(part, parts, findings)
        _note_learned(part, findings)


def _note_learned(part: Part, findings: Findings) -> None:
    """A note on how many rules an arbiter learned, and what it chooses where none of them holds."""
    if part.arbiter is None or not part.arbiter.learner:
        return
    arbiter, count = part.arbiter, len(part.arbiter.rules) - 1
    otherwise = arbiter.choices[arbiter.rules[-1].choice]
    learner = arbiter.learner.upper()
    if not count:
        findings.note(f"{part.name} has learned no rules by {learner} yet: it chooses {otherwise}")
        return
    rules = f"{count} rule{'s' * (count > 1)} learned by {learner}"
    findings.note(f"{part.name} decides by {rules}; where none holds it chooses {otherwise}")


def _note_sensors(read: set[str], parts: Parts, findings: Findings) -> None:
    """A note on sensors of the body whose readings no node reads."""
    sensors = () if parts.body is None else parts.body.body.sensors
    owners = {name.partition(".")[0] for name in read}
    idle = [sensor.name for sensor in sensors if sensor.name not in owners]
    if idle:
        findings.note(f"no node reads the sensor{'s' * (len(idle) > 1)} {listed(idle, last='and')}")


def _check_feasible(part: Part, findings: Findings) -> None:
    if part.program is None:
        return
    path = (*part.path, "behavior")
    if any(warning.code == IMITATION for warning in part.warnings):
        message = f"{part.program.name} reads nothing that is sensed: an imitation"
        remedy = "let its field depend on what it senses (thesis, section 2.3, caveat 1)"
        findings.warning("S362", path, message, remedy)
    feasible = part.program.feasibility
    if feasible is not None and feasible.level == "hypothetical":
        message = f"nobody has shown that a robot can do {part.program.name}: it is hypothetical"
        remedy = "use a behavior that is demonstrated or plausible, or give evidence in its spec"
        findings.warning("S363", path, message, remedy)


def _check_effect(
    part: Part,
    read: set[str],
    commands: tuple[Command, ...],
    parts: Parts,
    findings: Findings,
) -> None:
    """Of what acts on nothing and is read by nobody: a warning; of outputs unread: a note."""
    told = [f"{part.name}.{entry.name}" for entry in part.tells]
    unread = [name for name in told if name not in read]
    named = any(acting.act or acting.set for acting in part.spec.choices.values())
    if commands or (part.spec.choices and (named or governed_by(part, parts))):
        outputs = [] if part.program is None else unread
        realized = {command.entry for command in commands}
        outputs = [name for name in outputs if name.partition(".")[2] not in realized]
        if outputs:
            findings.note(f"no node reads {', '.join(outputs)}")
        return
    if len(unread) == len(told):
        what = "reads what it tells" if told else "is told anything by it"
        message = f"{part.name} acts on nothing, and no node {what}"
        remedy = "let it realize a channel, wire what it tells, or remove it"
        findings.warning("S337", part.path, message, remedy, key=True)


def _note_defaults(part: Part, parts: Parts, findings: Findings) -> None:
    """Controls that nobody sets."""
    chosen = {
        key for other in parts.nodes.values() for a in other.spec.choices.values() for key in a.set
    }
    for entry in part.controls:
        full = f"{part.name}.{entry.name}"
        if entry.name in part.spec.set or entry.unit is None or entry.default is None:
            continue
        shown = f"{entry.default / entry.unit.scale:g} {entry.unit.text}".removesuffix(" 1")
        if full not in chosen:
            findings.note(f"{full} stays at its default, {shown}")
