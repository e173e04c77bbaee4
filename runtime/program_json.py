"""Programs as JSON: every dataclass an object with its fields, read back by their types.

Code is its text, an enumeration its value; a table's coefficients are the name of the member that
holds them. Keys are sorted, floats are the shortest text that reads back the same, and there is one
way to write each program: what reads back to something else is refused.
"""

import dataclasses
import json
import math
import types
import typing
from collections.abc import Callable, Iterable, Iterator
from enum import StrEnum
from typing import Any, Final

import numpy as np

from runtime.arrays import Array
from runtime.code import Code
from runtime.container import ArtifactError
from runtime.program import Program

FORMAT: Final = 3
"""The version of what stands in `program.json`; a change of meaning raises it."""

Load = Callable[[str, tuple[int, ...]], Array]


def to_json(program: Program, members: Iterable[str]) -> bytes:
    """The program as JSON; `members` names those that hold the tables' coefficients, in order.

    Raises:
        ArtifactError: a number is not finite, or a text is no Unicode.
    """
    document = {"format": FORMAT, "program": _plain(Program, program, iter(members))}
    try:
        text = json.dumps(document, sort_keys=True, allow_nan=False, ensure_ascii=False, indent=1)
        return (text + "\n").encode()
    except ValueError as problem:
        raise ArtifactError(f"the program cannot be written: {problem}") from problem


def from_json(content: bytes, load: Load) -> Program:
    """The program; `load(name, shape)` gives the coefficients that a member holds.

    Raises:
        ArtifactError: the document is not one that `to_json` writes.
    """
    try:
        document = json.loads(content.decode())
    except (ValueError, RecursionError) as problem:
        raise ArtifactError(f"program.json is not JSON: {problem}") from problem
    if not isinstance(document, dict) or set(document) != {"format", "program"}:
        raise ArtifactError("program.json holds no program")
    if document["format"] != FORMAT:
        raise ArtifactError(
            f"the artifact has format {document['format']!r}, this version reads {FORMAT}; "
            "compile the spec again"
        )
    program: Program = _typed(Program, document["program"], "program", load)
    return program


def to_plain(kind: Any, value: Any) -> Any:
    """What JSON can say of a value without tables, by the type `kind`."""
    return _plain(kind, value, iter(()))


def from_plain(kind: Any, value: Any, at: str, load: Load) -> Any:
    """The value of type `kind` that `to_plain` wrote; `at` names it in messages.

    Raises:
        ArtifactError: it is not exactly what would be written.
    """
    return _typed(kind, value, at, load)


def _plain(kind: Any, value: Any, members: Iterator[str]) -> Any:
    """What JSON can say of a value of the type `kind`."""
    if isinstance(value, np.ndarray):
        return {"member": next(members), "shape": list(value.shape)}
    if isinstance(value, Code):
        return value.text
    if isinstance(value, tuple):
        kinds = _item_kinds(typing.get_args(_present(kind)), len(value), "a tuple")
        return [_plain(k, item, members) for k, item in zip(kinds, value, strict=True)]
    if isinstance(value, dict):
        entry = typing.get_args(kind)[1]
        return {key: _plain(entry, item, members) for key, item in value.items()}
    if dataclasses.is_dataclass(value):
        hints = _hints(type(value))
        return {k: _plain(hint, getattr(value, k), members) for k, hint in hints.items()}
    # A whole number may stand for a real one in Python; in the file it has its point.
    return float(value) if _present(kind) is float and value is not None else value


def _present(kind: Any) -> Any:
    """The type without the `None` that may stand in its place."""
    if typing.get_origin(kind) is types.UnionType:
        return next(a for a in typing.get_args(kind) if a is not type(None))
    return kind


def _typed(kind: Any, value: Any, at: str, load: Load) -> Any:  # noqa: PLR0911  # one case per kind
    """The value of type `kind` that the plain `value` stands for; `at` names it in messages."""
    arguments = typing.get_args(kind)
    match typing.get_origin(kind):
        case types.UnionType:
            return None if value is None else _typed(_present(kind), value, at, load)
        case origin if origin is tuple:
            items = _a(list, value, at)
            kinds = _item_kinds(arguments, len(items), at)
            pairs = enumerate(zip(kinds, items, strict=True))
            return tuple(_typed(k, item, f"{at}[{i}]", load) for i, (k, item) in pairs)
        case origin if origin is dict:
            entries = _a(dict, value, at)
            return {k: _typed(arguments[1], v, f"{at}.{k}", load) for k, v in entries.items()}
        case np.ndarray:
            return _coefficients(value, at, load)
    if kind is Code:
        return Code(_a(str, value, at))
    if dataclasses.is_dataclass(kind):
        return _object(typing.cast("type[Any]", kind), value, at, load)
    if issubclass(kind, StrEnum):
        if value not in tuple(kind):
            raise ArtifactError(f"{at} is {value!r}, not one of {', '.join(kind)}")
        return kind(value)
    return _a(kind, value, at)


def _object(kind: type[Any], value: Any, at: str, load: Load) -> Any:
    entries = _a(dict, value, at)
    hints = _hints(kind)
    if set(entries) != set(hints):
        odd = ", ".join(sorted(set(entries) ^ set(hints)))
        raise ArtifactError(f"{at} lacks or has too much: {odd}")
    return kind(**{k: _typed(hint, entries[k], f"{at}.{k}", load) for k, hint in hints.items()})


def _hints(kind: Any) -> dict[str, Any]:
    """The types of a dataclass's fields, in order."""
    hints = typing.get_type_hints(kind)
    return {field.name: hints[field.name] for field in dataclasses.fields(kind)}


def _item_kinds(arguments: tuple[Any, ...], count: int, at: str) -> tuple[Any, ...]:
    if len(arguments) == 2 and arguments[1] is Ellipsis:
        return (arguments[0],) * count
    if len(arguments) != count:
        raise ArtifactError(f"{at} must have {len(arguments)} entries (got {count})")
    return arguments


def _a(kind: type[Any], value: Any, at: str) -> Any:
    """The value, if it is exactly of the kind: True is no number, and 1 is no 1.0."""
    if type(value) is not kind:
        raise ArtifactError(f"{at} must be a {kind.__name__} (got {value!r:.60})")
    if kind is float and not math.isfinite(value):
        raise ArtifactError(f"{at} is not finite")
    return value


def _coefficients(value: Any, at: str, load: Load) -> Array:
    entries = _a(dict, value, at)
    if set(entries) != {"member", "shape"}:
        raise ArtifactError(f"{at} names no member of the artifact")
    shape = tuple(_a(int, size, f"{at}.shape") for size in _a(list, entries["shape"], at))
    return load(_a(str, entries["member"], at), shape)
