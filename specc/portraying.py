"""A phase portrait, from what a user gives: names, and numbers in the variables' own units."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final, TypeAlias, final

import numpy as np

from runtime.program import Control, Kind, Program, State
from runtime.progress import Progress, in_silence
from spec_schema.diagnostics import SpecError
from specc.faults import fault
from specc.given import Value, settings_for
from specc.loading import as_program
from verifier.topology.branches.branching import find_branches
from verifier.topology.branches.continuation import Branches
from verifier.topology.features import Portrait
from verifier.topology.hybrid.portrait import FIELD_OF, OF_EACH_PANEL
from verifier.topology.portrait import Detail
from verifier.topology.portrait import portrait as look
from verifier.topology.slices import SliceError

FULL: Final = Detail(basins=96)
"""Everything, with the basins of attraction in cells of a 96th of each axis, as claims have it."""

SMALL: Final = Detail(trajectories=2, basins=48)
"""For one of many panels."""

MOST_PANELS: Final = 24
MOST_AXES: Final = 3


@final
@dataclass(frozen=True, slots=True)
class Sweep:
    """Portraits over the same axes, at several values of `name`."""

    name: str
    portraits: tuple[Portrait, ...]


Found: TypeAlias = Portrait | Sweep | Branches
"""What can be drawn, printed and recorded."""


def portrait(
    spec: Program | Path | str,
    axes: Sequence[str] | None = None,
    held: Mapping[str, Value] | None = None,
) -> Portrait:
    """The phase portrait over one to three states, everything else held, as numbers.

    Raises:
        SpecError: an axis or a name that it does not have, or a value outside its domain.
    """
    return _portrait(as_program(spec), axes, held or {}, FULL)


def sweep(
    spec: Program | Path | str,
    name: str,
    values: str | Sequence[Value],
    axes: Sequence[str] | None = None,
    held: Mapping[str, Value] | None = None,
) -> Sweep:
    """The portraits at several values of a control, or of a state that is held: slices.

    values: a list, or a text as `0.1:0.8:6` (low, high, count) or `5` (how many slices).

    Raises:
        SpecError: as `portrait`; or too many values, or another form of text.
    """
    program = as_program(spec)
    chosen = swept_values(program, name, values) if isinstance(values, str) else values
    if not 1 <= len(chosen) <= MOST_PANELS:
        raise _count_refused(name, len(chosen))
    names = _without(program, axes, name)
    given = held or {}
    panels = [_portrait(program, names, {**given, name: v}, SMALL) for v in chosen]
    if name == program.field.mode:
        panels = [_of_its_mode(panel) for panel in panels]
    return Sweep(name, tuple(panels))


def _count_refused(name: str, count: int) -> SpecError:
    message = f"a sweep shows 1 to {MOST_PANELS} values (got {count})"
    return fault("V342", name, message, f"write {name}=LOW:HIGH:COUNT")


def _of_its_mode(panel: Portrait) -> Portrait:
    """A panel of a sweep over the modes: the note on whose field it is, as one for all."""
    notes = (OF_EACH_PANEL if note.startswith(FIELD_OF) else note for note in panel.notes)
    return replace(panel, notes=tuple(notes))


def branches(
    spec: Program | Path | str,
    name: str,
    ends: str | None = None,
    held: Mapping[str, Value] | None = None,
    progress: Progress = in_silence,
) -> Branches:
    """The bifurcation diagram against a control: over its domain, or over `low:high`.

    `progress(what, done, of)` is called before each portrait that it is made of.

    Raises:
        SpecError: no such control, values outside its domain, or another form of text.
    """
    program = as_program(spec)
    part = next((c for c in program.controls if c.name == name), None)
    if part is None:
        known = ", ".join(c.name for c in program.controls) or "none"
        raise fault("V341", name, f"no control is named '{name}'", f"there are {known}")
    pieces = [piece.strip() for piece in (ends or "").split(":")]
    if ends is not None and len(pieces) != 2:
        message = "this is no range of values"
        raise fault("V342", f"{name}={ends}", message, f"write {name}=LOW:HIGH")
    limits = None if ends is None else _ends(part, pieces)
    parts: tuple[State | Control, ...] = (*program.states, *program.controls)
    settings = settings_for(parts, held or {}, "state or control")
    try:
        return find_branches(program, name, settings, limits, progress=progress)
    except SliceError as error:
        raise fault("V342", program.source.file, str(error)) from error


def swept_values(program: Program, name: str, text: str) -> tuple[Value, ...]:
    """`0.1:0.8:6` as six values of a control or state in its own unit; `5` as five in its domain.

    The ends may have units: `10 cm/s:80 cm/s:6`. Slices of a whole domain are as many middles.
    `a,b,c` are values one by one, as the names of a discrete state's.

    Raises:
        SpecError: another form, an unknown name, values outside the domain.
    """
    part = _part(program, name)
    if "," in text or (isinstance(part, State) and part.kind is Kind.DISCRETE):
        return tuple(value.strip() for value in text.split(","))
    pieces = [piece.strip() for piece in text.split(":")]
    if len(pieces) in {1, 3} and pieces[-1].isdigit() and not 1 <= int(pieces[-1]) <= MOST_PANELS:
        raise _count_refused(name, int(pieces[-1]))
    if len(pieces) not in {1, 3} or not pieces[-1].isdigit():
        message = "this is no range of values"
        raise fault("V342", f"{name}={text}", message, f"write {name}=LOW:HIGH:COUNT or a count")
    count = int(pieces[-1])
    if len(pieces) == 1:
        step = (part.high - part.low) / count
        ends = (part.low + 0.5 * step, part.high - 0.5 * step)
    else:
        ends = _ends(part, pieces)
    return tuple(float(v) / part.unit.scale for v in np.linspace(*ends, count))


def _ends(part: State | Control, pieces: Sequence[str]) -> tuple[float, float]:
    """The two ends of a range in SI."""
    low, high = (settings_for([part], {part.name: end}, "name")[part.name] for end in pieces[:2])
    return low, high


def _without(program: Program, axes: Sequence[str] | None, name: str) -> Sequence[str] | None:
    """The axes without the state that is cut into slices."""
    if axes is not None:
        return [axis for axis in axes if axis != name]
    if name in {state.name for state in program.states}:
        moving = [s.name for s in program.states if s.is_driven and s.kind is not Kind.DISCRETE]
        return [axis for axis in moving if axis != name][:2]
    return None


def _part(program: Program, name: str) -> State | Control:
    """The control or state of this name.

    Raises:
        SpecError: there is none.
    """
    parts: tuple[State | Control, ...] = (*program.controls, *program.states)
    for part in parts:
        if part.name == name:
            return part
    known = ", ".join(part.name for part in parts)
    raise fault("V341", name, f"no control or state is named '{name}'", f"there are {known}")


def _portrait(
    program: Program, axes: Sequence[str] | None, held: Mapping[str, Value], detail: Detail
) -> Portrait:
    if axes is not None and len(axes) > MOST_AXES:
        message = f"a portrait has at most {MOST_AXES} axes (got {', '.join(axes)})"
        raise fault("V346", program.source.file, message, "hold the other states by `--at`")
    parts: tuple[State | Control, ...] = (*program.states, *program.controls)
    settings = settings_for(parts, held, "state or control")
    try:
        return look(program, None if axes is None else tuple(axes), settings, detail)
    except SliceError as error:
        raise fault("V346", program.source.file, str(error)) from error
