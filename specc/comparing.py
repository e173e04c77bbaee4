"""One behavior held against another, from what a user gives."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

from runtime.program import Control, Kind, Program, State
from spec_schema.units import describe, parse_unit
from specc.faults import fault
from specc.given import Value, settings_for
from specc.loading import as_program
from verifier.topology.comparing.comparison import (
    Comparison,
    ComparisonError,
    Side,
    Tolerances,
    compare,
)
from verifier.topology.portrait import Detail, portrait
from verifier.topology.slices import SliceError

FEATURES = Detail(trajectories=0, separatrices=False)
"""What is compared: fixed points and cycles."""

USUAL: Final = Tolerances()

REMEDIES: Final = {
    "V362": "give both a domain around the same place",
    "V363": "compare a map with a map, a flow with a flow",
}


def compare_behaviors(
    found: Program | Path | str,
    wanted: Program | Path | str,
    axes: Sequence[str] | None = None,
    held: Mapping[str, Value] | None = None,
    tolerances: Tolerances = USUAL,
) -> Comparison:
    """Hold a behavior, such as code, against one that is wanted, such as a sketch.

    held: values of states and controls; each goes to those of the two that have it.

    Raises:
        SpecError: a name or a value that can't be used, or behaviors that can't be compared.
    """
    found, wanted = as_program(found), as_program(wanted)
    given = held or {}
    known = {part.name: part for part in (*_parts(found), *_parts(wanted))}
    unknown = {name: value for name, value in given.items() if name not in known}
    settings_for(tuple(known.values()), unknown, "state or control")
    _require_like_units(found, wanted)
    ours, theirs = _side(found, axes, given), _side(wanted, axes, given)
    try:
        return compare(ours, theirs, tolerances)
    except ComparisonError as error:
        remedy = _shared_axes(found, wanted) if error.code == "V361" else REMEDIES[error.code]
        raise fault(error.code, found.source.file or found.name, str(error), remedy) from error


def _shared_axes(found: Program, wanted: Program) -> str:
    """What to compare over instead, of the states that move in both."""
    moving = [
        [s.name for s in program.states if s.is_driven and s.kind is not Kind.DISCRETE]
        for program in (found, wanted)
    ]
    both = [name for name in moving[0] if name in moving[1]]
    if not both:
        return "no state moves in both: they can't be compared"
    return f"name states that both have: `--axes {','.join(both[:2])}`"


def _parts(program: Program) -> tuple[State | Control, ...]:
    return (*program.states, *program.controls)


def _side(program: Program, axes: Sequence[str] | None, held: Mapping[str, Value]) -> Side:
    parts = _parts(program)
    names = {part.name for part in parts}
    own = {name: value for name, value in held.items() if name in names}
    settings = settings_for(parts, own, "state or control")
    try:
        shown = portrait(program, None if axes is None else tuple(axes), settings, FEATURES)
    except SliceError as error:
        raise fault("V346", program.source.file, str(error)) from error
    return Side(program, shown)


def _require_like_units(found: Program, wanted: Program) -> None:
    """States of one name measure one thing."""
    others = {state.name: state for state in wanted.states}
    for state in found.states:
        other = others.get(state.name)
        if other is None:
            continue
        here, there = parse_unit(state.unit.text), parse_unit(other.unit.text)
        if here.dimension != there.dimension:
            message = (
                f"'{state.name}' is in {here.text} ({describe(here.dimension)}) in "
                f"'{found.name}', in {there.text} ({describe(there.dimension)}) in '{wanted.name}'"
            )
            remedy = "states of one name must measure the same: rename one of them"
            raise fault("V361", found.source.file or found.name, message, remedy)
