"""Aims as edits of the user's text: the number as it is written there, in its own unit."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, final

from spec_schema.editing.edits import Edit, EditError, NewKey, NewNumber, NewText
from spec_schema.editing.in_place import edited
from spec_schema.load import Loaded
from spec_schema.node import Plain, plain
from spec_schema.source import Source
from spec_schema.units import parse_quantity
from specc.faults import fault
from specc.fitting.aims import Aim, AnyAim
from specc.fitting.rounding import rounded

ROUNDING: Final = 1e-13
"""What a number may lose on its way to SI and back: `15 deg` comes back as 15.000000000000002."""


@final
@dataclass(frozen=True, slots=True)
class Move:
    """One value of the spec as it was written, empty where it was not, and as it is now.

    place: `file:line:column`. sentence: what was found of the robot.
    """

    name: str
    old: str
    new: str
    place: str
    path: str
    sentence: str
    edit: Edit


def moves_of(loaded: Loaded, aims: Sequence[AnyAim]) -> tuple[Move, ...]:
    """The moves that change anything in the digits that the intervals support."""
    found = (_move(loaded, aim) for aim in aims)
    return tuple(move for move in found if move is not None)


def moved(source: Source, moves: Sequence[Move]) -> Source:
    """The text with the moves made.

    Raises:
        SpecError: a number is written in a way that can't be changed in place (V372).
    """
    try:
        return edited(source, tuple(move.edit for move in moves))
    except EditError as error:
        names = ", ".join(move.name for move in moves if move.edit.path == error.path)
        what = names or "a value"
        remedy = "write it in one line, as a number with or without its unit"
        raise fault("V372", source.name, f"{what} can't be moved: {error.why}", remedy) from error


def _move(loaded: Loaded, aim: AnyAim) -> Move | None:
    is_there = loaded.places.written(aim.path) == aim.path
    old = _written(loaded, aim) if is_there else None
    if not isinstance(aim, Aim):
        edit: Edit = NewText(aim.path, aim.text) if is_there else _key(aim, aim.text)
        new = aim.text
    else:
        number = rounded(aim.value / _scale(old, aim), aim.half / _scale(old, aim))
        if _is_same(old, number):
            return None
        unit = "" if aim.unit == "1" or aim.path[0] != "trace" else f" {aim.unit}"
        new = number if is_there else f"{number}{unit}"
        edit = NewNumber(aim.path, number) if is_there else _key(aim, new)
    return Move(
        name=aim.name,
        old="" if old is None else str(old),
        new=new + _behind(old) if isinstance(aim, Aim) else new,
        place=loaded.origin(aim.path),
        path=loaded.places.dotted(aim.path),
        sentence=aim.sentence,
        edit=edit,
    )


def _key(aim: AnyAim, text: str) -> NewKey:
    """A key that is missing; in `trace:`, a bare path is short for `{path: ...}`."""
    return NewKey(aim.path, text, "path" if aim.path[0] == "trace" else "")


def _written(loaded: Loaded, aim: AnyAim) -> Plain:
    value = plain(loaded.places.root)
    for step in aim.path:
        value = value[step]  # type: ignore[index]  # it stands there
    return value


def _scale(old: Plain, aim: Aim) -> float:
    """What one of the written number is in SI: of the unit behind it, else of its own."""
    return parse_quantity(old).unit.scale if isinstance(old, str) else aim.scale


def _is_same(old: Plain, number: str) -> bool:
    if old is None:
        return float(number) == 0.0
    written = float(old) if isinstance(old, int | float) else _number_of(str(old))
    return math.isclose(written, float(number), rel_tol=ROUNDING)


def _number_of(text: str) -> float:
    quantity = parse_quantity(text)
    return quantity.value / quantity.unit.scale


def _behind(old: Plain) -> str:
    """The unit behind the number, as it stands there."""
    if not isinstance(old, str):
        return ""
    return f" {parse_quantity(old).unit.text}"
