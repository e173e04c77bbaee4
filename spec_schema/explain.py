"""Pydantic's findings in our words: a code, a sentence, what to write, and where to point."""

from collections.abc import Collection, Iterator
from typing import Any

from pydantic import BaseModel
from pydantic_core import ErrorDetails

from spec_schema.kinds import MODELS
from spec_schema.mistake import TYPE, Mistake, carried
from spec_schema.model_walk import choices_at, example_at, keys_at, lengths_at
from spec_schema.places import Path
from spec_schema.suggest import did_you_mean, nearest
from spec_schema.wording import as_yaml, described, number, quoted

_WANTED = {
    "string_type": "text",
    "int_type": "a whole number",
    "int_from_float": "a whole number",
    "float_type": "a number",
    "bool_type": "true or false",
    "tuple_type": "a list",
    "mapping_type": "a mapping",
    "dict_type": "a mapping",
    "model_type": "a mapping",
    "model_attributes_type": "a mapping",
}
_TRUTHS = {
    **dict.fromkeys(("yes", "on", "y", "true"), "true"),
    **dict.fromkeys(("no", "off", "n", "false"), "false"),
}
"""What YAML 1.1 took for a truth value, and what it is called now."""
_CALLED = {
    "is": "kind of point",
    "keep": "way to keep a field",
    "fill": "way to fill",
    "between": "interpolation",
}
"""What a word is that stands under a key which is no noun for it."""
_BOUNDS = {
    "greater_than": ("gt", "more than"),
    "greater_than_equal": ("ge", "at least"),
    "less_than": ("lt", "less than"),
    "less_than_equal": ("le", "at most"),
}


def mistakes_of(model: type[BaseModel], error: ErrorDetails) -> Iterator[Mistake]:
    """The mistakes behind one of pydantic's errors; `at` counts from the document."""
    path: Path = error["loc"]
    at_key = bool(path) and path[-1] == "[key]"
    if at_key:
        path = path[:-1]
    context: dict[str, Any] = error.get("ctx", {})
    if error["type"] == TYPE:
        for found in carried(context):
            where = (*path, *found.at)
            yield Mistake(found.code, found.message, found.help, where, found.on_key or at_key)
        return
    if error["type"] == "too_short" and len(error["input"]) >= context["min_length"]:
        return  # pydantic does not count the items that are wrong themselves
    yield _mistake(model, error["type"], path, error["input"], context) or Mistake(
        "S103", f"{error['msg'][:1].lower()}{error['msg'][1:]}", "", path
    )


def _mistake(
    model: type[BaseModel], kind: str, path: Path, got: Any, context: dict[str, Any]
) -> Mistake | None:
    """One of pydantic's own errors; None for a type that no model of ours can cause."""
    found: Mistake | None = None
    if kind == "missing":
        found = _missing(model, path)
    elif kind == "extra_forbidden":
        found = unknown_key(model, path, ())
    elif kind == "literal_error":
        found = _unknown_word(model, path, got)
    elif kind in _WANTED:
        found = _wrong_type(model, kind, path, got)
    elif kind in {"too_short", "too_long"}:
        found = _wrong_length(model, path, got, context)
    elif kind in _BOUNDS:
        found = _out_of_bounds(model, kind, path, got, context)
    return found


def unknown_key(model: type[BaseModel], path: Path, beside: Collection[str]) -> Mistake:
    """The key at `path` is not one of the language; `beside` it stand other keys."""
    word = str(path[-1])
    known = keys_at(model, path[:-1])
    meant = meant_key(model, path, beside)
    remedy = f"did you mean '{meant}'?" if meant else f"the keys here are: {', '.join(known)}"
    return Mistake("S102", f"unknown key {quoted(word)}", remedy, path, on_key=True)


def meant_key(model: type[BaseModel], path: Path, beside: Collection[str]) -> str | None:
    """The key that the unknown one at `path` was probably meant to be: one that is not there."""
    absent = [key for key in keys_at(model, path[:-1]) if key not in beside]
    return nearest(str(path[-1]), absent)


def empty_value(model: type[BaseModel], path: Path) -> Mistake:
    """A key stands at `path` with nothing after it."""
    return Mistake("S110", f"{quoted(str(path[-1]))} has no value", _write(model, path), path)


def _missing(model: type[BaseModel], path: Path) -> Mistake:
    message = f"{quoted(str(path[-1]))} is missing"
    return Mistake("S101", message, _write(model, path, "add"), path[:-1])


def _unknown_word(model: type[BaseModel], path: Path, got: Any) -> Mistake:
    known = tuple(MODELS) if path == ("kind",) else choices_at(model, path)
    is_key = path == ("kind",) or str(path[-1]) in keys_at(model, path[:-1])
    what = _CALLED.get(str(path[-1]), str(path[-1])) if is_key else "word"
    if not isinstance(got, str):
        return Mistake(
            "S103", f"expected one of {', '.join(known)}, got {described(got)}", "", path
        )
    likely = did_you_mean(got, known)
    remedy = f"{likely}\n" if likely else ""
    message = f"unknown {what} {quoted(got)}"
    return Mistake("S104", message, f"{remedy}expected one of: {', '.join(known)}", path)


def _wrong_type(model: type[BaseModel], kind: str, path: Path, got: Any) -> Mistake:
    message = f"expected {_WANTED[kind]}, got {described(got)}"
    if kind == "string_type" and isinstance(got, bool | int | float):
        return Mistake("S103", message, f'put it in quotes: "{described(got).split()[-1]}"', path)
    if kind == "bool_type":
        meant = _TRUTHS.get(got.lower()) if isinstance(got, str) else None
        return Mistake("S103", message, f"write {meant or 'true or false'}", path)
    return Mistake("S103", message, _write(model, path), path)


def _wrong_length(model: type[BaseModel], path: Path, got: Any, context: dict[str, Any]) -> Mistake:
    what = "mapping" if isinstance(got, dict) else "list"
    if got:
        least, most = lengths_at(model, path)
        limit, words = (
            (context["min_length"], "at least")
            if "min_length" in context
            else (context["max_length"], "at most")
        )
        words = "exactly" if least == most == limit else words
        message = f"{_called(path)} takes {words} {limit} (got {len(got)})"
        return Mistake("S262", message, _write(model, path), path)
    return Mistake("S110", f"{_called(path)} is an empty {what}", _write(model, path), path)


def _called(path: Path) -> str:
    """A value by its key; of a list by its number."""
    last = path[-1]
    if isinstance(last, str):
        return quoted(last)
    return f"number {last + 1} of {_called(path[:-1])}" if path[:-1] else f"number {last + 1}"


def _out_of_bounds(
    model: type[BaseModel], kind: str, path: Path, got: float, context: dict[str, Any]
) -> Mistake:
    key, words = _BOUNDS[kind]
    message = f"expected {words} {number(context[key])}, got {number(got)}"
    return Mistake("S106", message, _write(model, path), path)


def _write(model: type[BaseModel], path: Path, verb: str = "write") -> str:
    """What to write, by an example; of a list's item that of the list; nothing without one."""
    while len(path) > 1 and isinstance(path[-1], int):
        path = path[:-1]
    example = example_at(model, path)
    if example is None:
        return ""
    return f"{verb} e.g. '{path[-1]}: {as_yaml(example)}'"
