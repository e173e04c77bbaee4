"""The phase portraits of a behavior that a book shows: at each setting, of each mode."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import final

from runtime.program import Kind, Program
from specc.book.formulas import in_mode, reads
from specc.book.manifest import Setting
from specc.figures.quantities import quantity
from specc.given import Value
from specc.portraying import portrait
from verifier.topology.features import Portrait

WIDE = 2
"""Axes of a portrait."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class View:
    """A portrait. title: at which values of controls, in which mode."""

    title: str
    portrait: Portrait


def views_of(program: Program, setting: Setting) -> tuple[View, ...]:
    """The portraits of a behavior at one setting of its controls, one for each mode."""
    units = {control.name: control.unit for control in program.controls}
    given: dict[str, Value] = {
        name: value / units[name].scale for name, value in setting.controls.items()
    }
    at = ", ".join(
        f"{name} = {quantity(value, units[name], 6)}" for name, value in setting.controls.items()
    )
    mode = program.field.mode
    values = next((s.values for s in program.states if s.name == mode), ())
    if not values:
        return tuple(_alone(program, given, at))
    found = []
    for index, value in enumerate(values):
        held = {**given, mode: value}
        title = f"{mode} is {value}" + (f"; {at}" if at else "")
        found.append(View(title, portrait(program, _axes(program, index), held)))
    return tuple(found)


def _alone(program: Program, given: dict[str, Value], at: str) -> Iterator[View]:
    """The portrait of a field without modes; and of what it drives alone, if that is another."""
    title = at or "The field"
    whole = portrait(program, None, given)
    driven = tuple(s.name for s in program.states if s.is_driven and s.kind is not Kind.DISCRETE)
    yield View(title, whole)
    if not {axis.name for axis in whole.axes} <= set(driven) and len(driven) <= WIDE:
        alone = portrait(program, driven, given)
        rest = [h for h in alone.held if h.name not in given]
        held = ", ".join(f"{h.name} = {h.label or quantity(h.value, h.unit, 6)}" for h in rest)
        yield View(f"What it drives alone, with {held} held; {at}", alone)


def _axes(program: Program, index: int) -> tuple[str, ...] | None:
    """The one or two states that move by themselves in a mode and decide when it is left.

    None where no such ones are known: then the first ones are shown.
    """
    field = program.field
    if field.formula is None:
        return None
    moving = [s.name for s in program.states if s.is_driven and s.kind is not Kind.DISCRETE]
    needs = {
        name: reads(in_mode(code, field.mode, index)) & set(moving)
        for name, code in zip(field.driven, field.formula, strict=True)
    }
    guards = [guard.condition for guard in field.guards if guard.mode == index]
    decides = {name for code in guards for name in reads(in_mode(code, field.mode, index))}
    closed = [part for name in moving if len(part := _closed(name, needs)) <= WIDE]
    if not closed:
        return None
    best = max(closed, key=lambda part: (len(part & decides), len(part)))
    return tuple(name for name in moving if name in best)


def _closed(name: str, needs: dict[str, set[str]]) -> frozenset[str]:
    """The states that a state's rate depends on, directly and by way of others, with itself."""
    found = {name}
    while (more := {n for each in found for n in needs.get(each, set())} | found) != found:
        found = more
    return frozenset(found)
