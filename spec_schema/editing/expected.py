"""What is to be read of a text after its edits, worked out on the data alone."""

import re
from typing import Final

from spec_schema.editing.edits import Edit, NewKey, NewLines, NewNumber
from spec_schema.node import Plain
from spec_schema.places import Path
from spec_schema.scalars import resolve

FIRST_NUMBER: Final = re.compile(r"^(\s*)[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")


def after(data: Plain, edits: tuple[Edit, ...]) -> Plain:
    """The data with the edits made."""
    for edit in edits:
        data = _changed(data, edit.path, edit)
    return data


def _changed(data: Plain, path: Path, edit: Edit) -> Plain:
    if isinstance(edit, NewKey) and len(path) == 1 and edit.bare and not isinstance(data, dict):
        data = {edit.bare: data}
    if not path:
        return _value(data, edit)
    step, rest = path[0], path[1:]
    match data:
        case dict():
            return data | {str(step): _changed(data.get(str(step)), rest, edit)}
        case list() if isinstance(step, int):
            return [
                _changed(item, rest, edit) if i == step else item for i, item in enumerate(data)
            ]
        case _:
            return data


def _value(old: Plain, edit: Edit) -> Plain:
    if isinstance(edit, NewLines):
        return edit.data
    if isinstance(edit, NewKey):
        return resolve(edit.text)
    if not isinstance(edit, NewNumber):
        return edit.text
    if isinstance(old, str):
        return FIRST_NUMBER.sub(lambda found: f"{found[1]}{edit.number}", old, count=1)
    return resolve(edit.number)
