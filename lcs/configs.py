"""Configs as they are given: a config of a learner's own kind, whose constants are of its types."""

import dataclasses
from collections.abc import Iterator
from enum import Enum
from numbers import Integral, Real
from typing import Any, TypeVar, get_type_hints

from lcs.faults import LearnerError

Config = TypeVar("Config")


def config_of(kind: type[Config], given: Config | None) -> Config:
    """The config that is given, or the usual one.

    Raises:
        LearnerError: it is of another kind, or a constant is of another type than it has to be.
    """
    if given is None:
        return kind()
    if not isinstance(given, kind):
        raise LearnerError(
            f"config is a {kind.__module__}.{kind.__qualname__}, and {given!r} is none"
        )
    for name, value, expected in _unfit(given):
        raise LearnerError(f"{name} is {_called(expected)}, and {value!r} is none")
    return given


def _unfit(config: Any) -> Iterator[tuple[str, Any, Any]]:
    """The name, the value and the type of each constant that is of another type."""
    hints = get_type_hints(type(config))
    for each in dataclasses.fields(config):
        value, expected = getattr(config, each.name), hints[each.name]
        if not _fits(value, expected):
            yield each.name, value, expected
        elif dataclasses.is_dataclass(value):
            yield from _unfit(value)


def _fits(value: Any, expected: Any) -> bool:
    if expected is float:
        return isinstance(value, Real) and not isinstance(value, bool)
    if expected is int:
        return isinstance(value, Integral) and not isinstance(value, bool)
    return isinstance(value, expected)


def _called(expected: Any) -> str:
    """A type, in words."""
    if issubclass(expected, Enum):
        return f"one of {', '.join(f'{expected.__name__}.{each.name}' for each in expected)}"
    words = {float: "a number", int: "a whole number", bool: "True or False"}
    return words.get(expected, f"a {expected.__qualname__}")
