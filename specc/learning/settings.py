"""Constants and readings of a learner by name: `explore=0.5`, `mutation_is=always`.

A config is a frozen dataclass of numbers, enumerations and further dataclasses of them; what is
inside one is named by its field alone, or as `readings.mutation_is` where a name occurs twice.
"""

import dataclasses
import math
from collections.abc import Iterator, Mapping
from enum import Enum
from typing import Any, Final, TypeVar

from spec_schema.diagnostics import Diagnostic, SpecError
from spec_schema.suggest import did_you_mean, did_you_mean_one_of
from specc.faults import mistake

Config = TypeVar("Config")

YES: Final = ("yes", "true", "on", "1")
NO: Final = ("no", "false", "off", "0")


def configured(config: Config, given: Mapping[str, str], learner: str) -> Config:
    """The config with what is given.

    Raises:
        SpecError: each name that it has not (V341), and each value that it can't take (V342).
    """
    known = dict(_leaves(config, ()))
    values: dict[tuple[str, ...], object] = {}
    problems: list[Diagnostic] = []
    for name, text in given.items():
        path = _path(name, known)
        if path is None:
            problems.append(_unknown(name, text, known, learner))
            continue
        try:
            values[path] = _allowed(value_of(text, known[path]))
        except ValueError as error:
            problems.append(mistake("V342", f"{name}={text}", str(error), choices(known[path])))
    if problems:
        raise SpecError(problems)
    found: Config = _replaced(config, values)
    return found


def listed(config: object) -> list[tuple[str, object]]:
    """The name and the value of everything that can be set, in the order of the config."""
    known = dict(_leaves(config, ()))
    return [(_shortest(path, known), value) for path, value in known.items()]


def value_of(text: str, like: object) -> object:
    """What is written, as a value of the same type as another.

    >>> value_of("0.5", 1.0), value_of("12", 3), value_of("0.25,0.75", (0.5,))
    (0.5, 12, (0.25, 0.75))

    Raises:
        ValueError: it is none; with a sentence.
    """
    match like:
        case bool():
            return _flag(text)
        case Enum():
            return _member(text, type(like))
        case tuple():
            return tuple(_number(part) for part in text.split(","))
        case int():
            number = _number(text)
            if number != int(number):
                raise ValueError(f"'{text}' is no whole number")
            return int(number)
        case float():
            return _number(text)
    return text


def shown(value: object) -> str:
    """A value as it would be written.

    >>> shown(0.25), shown((0.25, 0.75)), shown(True)
    ('0.25', '0.25,0.75', 'yes')
    """
    match value:
        case bool():
            return YES[0] if value else NO[0]
        case Enum():
            return value.name.lower()
        case tuple():
            return ",".join(shown(each) for each in value)
        case float():
            return f"{value:.6g}"
    return str(value)


def choices(value: object) -> str:
    """What may be written in the place of a value."""
    match value:
        case bool():
            return "write yes or no"
        case Enum():
            return f"write {' or '.join(each.name.lower() for each in type(value))}"
        case tuple():
            return f"write numbers parted by commas, such as {shown(value)}"
        case int() | float():
            return f"write a number, such as {shown(value)}"
    return f"write a word, such as {value or 'name'}"


def _allowed(value: object) -> object:
    """A constant: none of any learner is below 0."""
    if isinstance(value, int | float) and value < 0:
        raise ValueError(f"{value:g} is negative")
    return value


def _leaves(config: object, path: tuple[str, ...]) -> Iterator[tuple[tuple[str, ...], object]]:
    for each in dataclasses.fields(config):  # type: ignore[arg-type]  # a dataclass
        value = getattr(config, each.name)
        if dataclasses.is_dataclass(value):
            yield from _leaves(value, (*path, each.name))
        else:
            yield (*path, each.name), value


def _path(name: str, known: Mapping[tuple[str, ...], object]) -> tuple[str, ...] | None:
    """Where the value of this name is; of several that end so the outermost."""
    parts = _folded(name).split(".")
    fitting = [path for path in known if _folded(".".join(path)).split(".")[-len(parts) :] == parts]
    return min(fitting, key=len, default=None)


def _folded(name: str) -> str:
    return name.replace("-", "_").lower()


def _shortest(path: tuple[str, ...], known: Mapping[tuple[str, ...], object]) -> str:
    return path[-1] if _path(path[-1], known) == path else ".".join(path)


def _unknown(
    name: str, text: str, known: Mapping[tuple[str, ...], object], learner: str
) -> Diagnostic:
    remedy = did_you_mean(name, [_shortest(path, known) for path in known])
    if not remedy:
        holding = [_shortest(path, known) for path in known if _folded(name) in _folded(path[-1])]
        remedy = did_you_mean_one_of(holding[:4])
    remedy = remedy or "`specc learn --list` tells all that can be set"
    return mistake("V341", f"{name}={text}", f"{learner} has no constant '{name}'", remedy)


def _replaced(config: Any, values: Mapping[tuple[str, ...], object]) -> Any:
    own = {path[0]: value for path, value in values.items() if len(path) == 1}
    inner = {path[0] for path in values if len(path) > 1}
    for name in inner:
        below = {path[1:]: value for path, value in values.items() if path[0] == name and path[1:]}
        own[name] = _replaced(getattr(config, name), below)
    return dataclasses.replace(config, **own)


def _number(text: str) -> float:
    try:
        number = float(text)
    except ValueError:
        raise ValueError(f"'{text.strip()}' is no number") from None
    if not math.isfinite(number):
        raise ValueError(f"'{text.strip()}' is not finite")
    return number


def _flag(text: str) -> bool:
    if text.lower() in YES:
        return True
    if text.lower() in NO:
        return False
    raise ValueError(f"'{text}' is neither yes nor no")


def _member(text: str, kind: type[Enum]) -> Enum:
    word = text.strip().upper().replace("-", "_").replace(" ", "_")
    for each in kind:
        if each.name == word:
            return each
    remedy = did_you_mean(text, [each.name.lower() for each in kind])
    raise ValueError(f"'{text}' is no reading of it" + (f"; {remedy}" if remedy else ""))
