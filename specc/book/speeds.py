"""How fast a behavior moves its states over what it senses, where a portrait would tell nothing."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Final

import numpy as np

from runtime.flow import flow_of, rates, registers
from runtime.machine import evaluate
from runtime.program import Kind, Program, State
from specc.book.formulas import in_mode, reads
from specc.book.manifest import Setting
from specc.book.tables import per_second
from specc.figures.quantities import quantity
from specc.figures.rate_plane import Exit, RatePlane
from verifier.topology.features import AxisRange

NODES: Final = 81
WIDE: Final = 2
SEEN: Final = 0.02
"""A line that cuts off less than this share of a plane is not seen there."""


def moves_alike(program: Program, index: int) -> bool:
    """Whether what a mode moves does not depend on where that is: its portrait is empty."""
    field = program.field
    if field.formula is None:
        return False
    moving = {s.name for s in program.states if s.is_driven and s.kind is not Kind.DISCRETE}
    driven = zip(field.driven, field.formula, strict=True)
    return all(
        not reads(in_mode(code, field.mode, index)) & moving
        for name, code in driven
        if name in moving
    )


def speeds_at(program: Program, settings: Sequence[Setting]) -> tuple[RatePlane, ...]:
    """The planes of each mode whose portrait is empty, at the first setting of the controls."""
    mode = next((s for s in program.states if s.name == program.field.mode), None)
    if mode is None:
        return ()
    return tuple(
        plane
        for index in range(len(mode.values))
        if moves_alike(program, index)
        for plane in _planes(program, mode, index, settings[0].controls)
    )


def _planes(
    program: Program, mode: State, index: int, controls: Mapping[str, float]
) -> Iterator[RatePlane]:
    """A plane for each state that the mode moves, over the two sensed ones that matter in it."""
    field = program.field
    assert field.formula is not None, "what moves alike is a formula"
    guards = [guard for guard in field.guards if guard.mode == index]
    codes = [*field.formula, *(guard.condition for guard in guards)]
    read = {name for code in codes for name in reads(in_mode(code, field.mode, index))}
    sensed = [s for s in program.states if s.name in read and s.kind is Kind.CONTINUOUS]
    if len(sensed) != WIDE:
        return
    axes = tuple(AxisRange(s.name, s.unit, s.low, s.high, periodic=False) for s in sensed)
    nodes = tuple(np.linspace(s.low, s.high, NODES) for s in sensed)
    names = [state.name for state in program.states]
    x = np.broadcast_to([state.hold for state in program.states], (NODES, NODES, len(names))).copy()
    x[..., names.index(mode.name)] = index
    for state, grid in zip(sensed, np.meshgrid(*nodes, indexing="ij"), strict=True):
        x[..., names.index(state.name)] = grid
    flow, u = flow_of(program), np.array([controls[c.name] for c in program.controls])
    found, register = rates(flow, x, u), registers(flow, x, u)
    conditions = [guard.condition for guard in guards]
    values = (
        evaluate(conditions, program.register, register) if guards else np.zeros((*x.shape[:2], 0))
    )
    if not all(SEEN <= np.mean(values[..., k] >= 0.0) <= 1.0 - SEEN for k in range(len(guards))):
        return
    units = {control.name: control.unit for control in program.controls}
    held = ", ".join(f"{n} = {quantity(v, units[n], 6)}" for n, v in controls.items() if n in read)
    for name in (n for n in field.driven if n != mode.name):
        state = program.states[names.index(name)]
        yield RatePlane(
            name=program.name,
            title=f"{mode.name} is {mode.values[index]}: how fast {name} moves",
            held=held,
            state=name,
            unit=per_second(state.unit.text),
            axes=(axes[0], axes[1]),
            nodes=(nodes[0], nodes[1]),
            rates=found[..., names.index(name)] / state.unit.scale,
            exits=tuple(
                Exit(mode.values[guard.target], values[..., k]) for k, guard in enumerate(guards)
            ),
        )
