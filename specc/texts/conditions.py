"""Conditions in words: `0.2 m < ahead <= near (0.5 m) and lamp is shown`."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final, final

from runtime.arbiter import Arbiter
from runtime.code import Code
from runtime.program import Unit
from verifier.arbitration.comparisons import infix
from verifier.deciding.boxes import value_of
from verifier.deciding.conditions import TURNED, All, Compared, Condition, Some, Values
from verifier.deciding.reading import NOTHING_SET, values_of
from verifier.report.wording import exact

SIGNS: Final = MappingProxyType(
    {"lt": "<", "le": "<=", "gt": ">", "ge": ">=", "eq": "=", "ne": "is not"}
)
PLAIN: Final = Unit("1", 1.0)


@final
@dataclass(frozen=True, slots=True)
class Speech:
    """What is needed to speak of an arbiter's quantities.

    values: SI, of the names that stand for a number. units: of all names. labels: of reads that
    are discrete.
    """

    values: Values
    units: Mapping[str, Unit]
    labels: Mapping[str, tuple[str, ...]]


def speech_of(arbiter: Arbiter, set_to: Values = NOTHING_SET) -> Speech:
    """How one speaks of an arbiter; set_to: of controls that are not at their defaults."""
    units = {read.name: read.unit for read in arbiter.reads}
    units |= {control.name: control.unit for control in arbiter.controls}
    units |= {constant.name: constant.unit for constant in arbiter.constants}
    labels = {read.name: read.values for read in arbiter.reads if read.values}
    return Speech(values_of(arbiter, set_to), units, labels)


def phrase(condition: Condition, speech: Speech) -> str:
    """A condition in words."""
    match condition:
        case Compared():
            return _compared(condition, speech)
        case Some(()):
            return "never"
        case All(()):
            return "always"
        case Some(parts):
            return " or ".join(_part(each, speech) for each in parts)
        case All(parts):
            return " and ".join(_all_of(parts, speech))


def _part(condition: Condition, speech: Speech) -> str:
    text = phrase(condition, speech)
    return f"({text})" if isinstance(condition, All | Some) and len(condition.parts) > 1 else text


def _all_of(parts: Sequence[Condition], speech: Speech) -> list[str]:
    """Phrases, two ends of one quantity in one: `0.2 m < ahead <= 0.5 m`."""
    found: dict[object, str] = {}
    bounds: dict[str, dict[str, tuple[str, str]]] = {}
    for part in parts:
        turned = _bound(part, speech)
        if turned is None:
            found[part] = (
                f"({phrase(part, speech)})" if isinstance(part, Some) else _part(part, speech)
            )
            continue
        name, word, side = turned
        ends = bounds.setdefault(name, {})
        way = "above" if word in {"gt", "ge"} else "below"
        if way in ends:
            found[part] = phrase(part, speech)
            continue
        ends[way] = (word, side)
        found[name] = _between(name, ends)
    return list(found.values())


def _bound(part: Condition, speech: Speech) -> tuple[str, str, str] | None:
    """Quantity, word and the side's words, of a comparison that gives an end of a range."""
    if not isinstance(part, Compared) or part.word in {"eq", "ne"}:
        return None
    turned = _reading_first(part, speech)
    if turned is None:
        return None
    return infix(turned.left), turned.word, _side(turned.right, turned.left, speech)


def _between(name: str, ends: Mapping[str, tuple[str, str]]) -> str:
    low, high = ends.get("above"), ends.get("below")
    if low is not None and high is not None:
        return f"{low[1]} {SIGNS[TURNED[low[0]]]} {name} {SIGNS[high[0]]} {high[1]}"
    word, side = low or high or ("eq", "")
    return f"{name} {SIGNS[word]} {side}"


def _compared(compared: Compared, speech: Speech) -> str:
    turned = _reading_first(compared, speech)
    if turned is None:
        return f"{infix(compared.left)} {SIGNS[compared.word]} {infix(compared.right)}"
    name = infix(turned.left)
    labels = speech.labels.get(turned.left.text)
    if labels and turned.word in {"eq", "ne"}:
        value = value_of(turned.right, speech.values)
        place = -1 if value is None else round(value)
        if 0 <= place < len(labels):
            return (
                f"{name} is {labels[place]}"
                if turned.word == "eq"
                else _is_not(name, labels, place)
            )
    return f"{name} {SIGNS[turned.word]} {_side(turned.right, turned.left, speech)}"


def _is_not(name: str, labels: tuple[str, ...], place: int) -> str:
    """Of two values the other one; of more what it is not."""
    if len(labels) == 2:
        return f"{name} is {labels[1 - place]}"
    return f"{name} is not {labels[place]}"


def _reading_first(compared: Compared, speech: Speech) -> Compared | None:
    """The comparison with the number on its right; None where both sides read, or neither."""
    left, right = (value_of(side, speech.values) for side in (compared.left, compared.right))
    if left is None and right is not None:
        return compared
    if left is not None and right is None:
        return Compared(compared.right, TURNED[compared.word], compared.left)
    return None


def _side(side: Code, reading: Code, speech: Speech) -> str:
    """A number with its unit; named ones with their value: `near + margin (0.21 m)`."""
    value = value_of(side, speech.values)
    unit = unit_of(reading, side, speech)
    told = exact(0.0 if value is None else value, unit)
    is_named = any(token in speech.units for token in side.tokens)
    return f"{infix(side)} ({told})" if is_named else told


def unit_of(reading: Code, side: Code, speech: Speech) -> Unit:
    """The unit in which a threshold is told: that of the first name in it, else of what is read."""
    for code in (side, reading):
        found = [speech.units[token] for token in code.tokens if token in speech.units]
        if found:
            return found[0]
    return PLAIN
