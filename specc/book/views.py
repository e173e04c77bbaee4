"""The phase portraits of a behavior that a book shows: at each setting, of each mode."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import final

from runtime.arbiter import Arbiter
from runtime.program import Kind, Program
from specc.book.formulas import in_mode, reads
from specc.book.manifest import Setting
from specc.book.speeds import moves_alike
from specc.figures.quantities import quantity
from specc.given import Value
from specc.portraying import portrait
from specc.portraying_arbiters import ArbiterPortrait, arbiter_portrait
from verifier.deciding.rulings import DRAWN
from verifier.topology.features import Portrait

WIDE = 2
"""Axes of a portrait."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class View:
    """A portrait. title: at which values of controls, in which mode."""

    title: str
    portrait: Portrait


@final
@dataclass(frozen=True, eq=False, slots=True)
class Decisions:
    """What an arbiter decides where. title: at which values of its controls."""

    title: str
    portrait: ArbiterPortrait


def views_at(program: Program, settings: Sequence[Setting]) -> tuple[View, ...]:
    """The portraits of a behavior: at each setting of the controls that its field reads."""
    reading = field_reads(program)
    told = [{n: v for n, v in one.controls.items() if n in reading} for one in settings]
    distinct = [values for k, values in enumerate(told) if values not in told[:k]]
    return tuple(view for values in distinct for view in views_of(program, values))


def decisions_at(arbiter: Arbiter, settings: Sequence[Setting]) -> tuple[Decisions, ...]:
    """What an arbiter decides where, at each setting of its controls; none of what remembers."""
    if arbiter.paradigm not in DRAWN:
        return ()
    units = {control.name: control.unit for control in arbiter.controls}
    told = [one.controls for one in settings]
    found = []
    for controls in (values for k, values in enumerate(told) if values not in told[:k]):
        at = ", ".join(f"{name} = {quantity(v, units[name], 6)}" for name, v in controls.items())
        given: dict[str, Value] = {name: v / units[name].scale for name, v in controls.items()}
        found.append(Decisions(at, arbiter_portrait(arbiter, None, given)))
    return tuple(found)


def field_reads(program: Program) -> set[str]:
    """The names that the rates, closures and switches of a field depend on."""
    field = program.field
    codes = [*(field.formula or ()), *(term.coefficient for term in field.terms)]
    codes += [each.code for each in field.coordinates]
    codes += [guard.condition for guard in field.guards]
    codes += [code for guard in field.guards for _, code in guard.resets]
    codes += [state.closure for state in program.states if state.closure is not None]
    axes = {axis.name for table in field.tables for axis in table.axes}
    return axes | {name for code in codes for name in reads(in_mode(code, "", 0))}


def views_of(program: Program, controls: Mapping[str, float]) -> tuple[View, ...]:
    """The portraits at values (SI) of controls, one for each mode that has one to tell of."""
    units = {control.name: control.unit for control in program.controls}
    given: dict[str, Value] = {name: v / units[name].scale for name, v in controls.items()}
    at = ", ".join(f"{name} = {quantity(v, units[name], 6)}" for name, v in controls.items())
    mode = program.field.mode
    values = next((s.values for s in program.states if s.name == mode), ())
    if not values:
        return tuple(_alone(program, given, at))
    found = []
    for index, value in enumerate(values):
        if moves_alike(program, index):
            continue
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
        yield View(f"What it drives alone, with {held} held" + (f"; {at}" if at else ""), alone)


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
