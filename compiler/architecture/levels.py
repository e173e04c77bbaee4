"""Levels: modules that control others stand above them, and should leave fewer things to set."""

from collections.abc import Mapping

from compiler.architecture.graph import controls_of, governed_by, levels_of
from compiler.architecture.parts import Parts
from compiler.findings import Findings
from runtime.architecture import Input, Signal
from spec_schema.wording import counted, listed


def check_levels(
    inputs: Mapping[str, tuple[Input, ...]],
    board: tuple[Signal, ...],
    parts: Parts,
    findings: Findings,
) -> dict[str, int]:
    """The level of each node; warnings for circles, and for levels that add control parameters.

    "Each level reduces the number of control parameters" (thesis, section 3.2.3): a level takes
    away those that it sets, with one for each node that it lets act or not, and adds its own.
    """
    controls = controls_of(inputs, board, parts)
    levels, circles = levels_of(controls)
    for circle in circles:
        message = f"{listed(circle, last='and')} control one another, so none is above the other"
        remedy = "let one of them be sensed instead of set"
        findings.warning("S361", ("nodes", circle[0]), message, remedy, key=True)
    for level in range(1, max(levels.values(), default=0) + 1):
        _check_level(level, levels, inputs, board, parts, findings)
    return levels


def _check_level(
    level: int,
    levels: Mapping[str, int],
    inputs: Mapping[str, tuple[Input, ...]],
    board: tuple[Signal, ...],
    parts: Parts,
    findings: Findings,
) -> None:
    members = [name for name in levels if levels[name] == level]
    taken = {
        f"{other}.{key}"
        for name in members
        for acting in parts.nodes[name].spec.choices.values()
        for other, _, key in (full.partition(".") for full in acting.set)
    }
    taken |= {other for name in members for other in governed_by(parts.nodes[name], parts)}
    for name, many in inputs.items():
        settable = {entry.name for entry in parts.nodes[name].controls}
        taken |= {
            f"{name}.{one.entry}"
            for one in many
            if one.entry in settable
            and one.signal >= 0
            and board[one.signal].name.partition(".")[0] in members
        }
    added = [
        f"{name}.{entry.name}"
        for name in members
        for entry in parts.nodes[name].controls
        if entry.name not in parts.nodes[name].spec.set
    ]
    if len(added) > len(taken):
        message = (
            f"level {level} adds {counted(len(added), 'control parameter')} and takes "
            f"{len(taken)} away: {', '.join(added)}"
        )
        remedy = "set some of them here, or make constants of them"
        findings.warning("S360", ("nodes", members[0]), message, remedy, key=True)
