"""What is left of a document when its faulty parts are taken out: enough for the later passes.

A wrong number in one place must not hide a wrong dimension in another. So the parts that the
models refuse are taken out, each with the smallest mapping that can do without it, and what is
left is checked on; names that went with them are remembered, and nothing is said about those.
Where a name's unit is known, a stand-in keeps its place, so that formulas can still be checked.
Lists close up where an item went: `kept` leads back to the items as they were written.
"""

import copy
from collections.abc import Iterable, Mapping, MutableMapping
from dataclasses import dataclass
from typing import Final, Generic, TypeVar, final

from pydantic import BaseModel, ValidationError

from spec_schema.explain import mistakes_of
from spec_schema.mistake import Mistake
from spec_schema.node import Plain
from spec_schema.places import Path, as_written

_ROUNDS = 12
_NAMED = frozenset(
    {"state", "control", "constants", "output", "reads", "nodes", "channels"}
    | {"sensors", "things", "scatter", "lights", "robots"}
)
"""The sections whose keys are names that other parts refer to."""
_MEASURES: Final[Path] = ("train", "measures")
"""Another such section, deeper down."""

_ROLES: Final = ("sensed", "driven", "both")
_STAND_INS: Final[Mapping[str, Mapping[str, Plain]]] = {
    "state": {
        "domain": [-1, 1],
        "role": "both",
        "relates": {"agent": "unknown", "environment": "unknown"},
    },
    "control": {"domain": [-1, 1], "default": 0},
    "constants": {"value": 1},
}
"""What takes the place of a declaration, beside its unit (and of a state its role)."""

Model = TypeVar("Model", bound=BaseModel)


@final
@dataclass(frozen=True, slots=True)
class Salvaged(Generic[Model]):
    """A valid model of what is left, and the declared names that were taken out.

    spec: None where nothing useful is left.
    kept: for each list that lost items, by its path in the text, the indices of the others.
    hidden: mistakes that came to light when others were taken out, at their places in the text.
    """

    spec: Model | None
    lost: frozenset[str]
    kept: Mapping[Path, tuple[int, ...]]
    hidden: tuple[Mistake, ...]


def salvage(model: type[Model], data: dict[str, Plain]) -> Salvaged[Model]:
    """The model of `data` without its faulty parts."""
    rest = _Rest(copy.deepcopy(data))
    hidden: list[Mistake] = []
    for _ in range(_ROUNDS):
        try:
            spec = model.model_validate(rest.data)
        except ValidationError as error:
            found = [m for e in error.errors(include_url=False) for m in mistakes_of(model, e)]
            if not found or any(_is_vital(mistake.at) for mistake in found):
                break
            hidden += rest.news(found, data)
            rest.take_out(mistake.at for mistake in found)
        else:
            return Salvaged(spec, frozenset(rest.lost), rest.kept, tuple(hidden))
    return Salvaged(None, frozenset(rest.lost), rest.kept, tuple(hidden))


def _is_name(path: Path) -> bool:
    """Whether a name is declared there that other parts refer to."""
    return (path[0] in _NAMED and len(path) == 2) or path[:-1] == _MEASURES


def _is_vital(path: Path) -> bool:
    """Whether nothing useful is left without what stands there."""
    return path == () or (len(path) == 1 and path[0] in _NAMED)


@final
class _Rest:
    """A document that parts are taken out of, and where the others stood."""

    def __init__(self, data: dict[str, Plain]) -> None:
        self.data = data
        self.lost: set[str] = set()
        self.kept: dict[Path, tuple[int, ...]] = {}
        self._gone: set[Path] = set()

    def news(self, found: Iterable[Mistake], written: Plain) -> list[Mistake]:
        """The mistakes, where they are written, that no part taken out so far can have caused."""
        if not self._gone:
            return []  # they are told already
        placed = [
            Mistake(m.code, m.message, m.help, as_written(m.at, self.kept), m.on_key) for m in found
        ]
        return [m for m in placed if all(_apart(m.at, path, written) for path in self._gone)]

    def take_out(self, paths: Iterable[Path]) -> None:
        """Remove what stands at the paths, the last items of lists first."""
        for path in sorted(set(paths), key=_order, reverse=True):
            holder, step = _holder(self.data, path), path[-1]
            written = as_written(path, self.kept)
            if isinstance(holder, dict) and step in holder:
                if _is_name(path):
                    self._lose(str(path[0]), str(step), holder)
                else:
                    del holder[str(step)]
            elif isinstance(holder, list) and isinstance(step, int) and step < len(holder):
                left = self.kept.get(written[:-1], tuple(range(len(holder))))
                self.kept[written[:-1]] = (*left[:step], *left[step + 1 :])
                del holder[step]
            self._gone.add(written)

    def _lose(self, section: str, name: str, holder: MutableMapping[str, Plain]) -> None:
        """Remember a name whose declaration can't be used, and put a stand-in there, once."""
        stand_in = None if name in self.lost else _stand_in(section, holder[name])
        self.lost.add(name)
        if stand_in is None:
            del holder[name]
        else:
            holder[name] = stand_in


def _stand_in(section: str, declared: Plain) -> dict[str, Plain] | None:
    """What takes the place of a declaration: its unit is kept; None where it has none."""
    if section not in _STAND_INS or not isinstance(declared, dict) or "values" in declared:
        return None
    unit, role = declared.get("unit"), declared.get("role")
    if not isinstance(unit, str):
        return None
    found: dict[str, Plain] = {**_STAND_INS[section], "unit": unit}
    if section == "state" and role in _ROLES:
        found["role"] = role
    return found


def _order(path: Path) -> tuple[tuple[int, str], ...]:
    return tuple((step, "") if isinstance(step, int) else (-1, step) for step in path)


def _apart(path: Path, gone: Path, written: Plain) -> bool:
    """Whether `path` is in a list item that is a mapping, and `gone` in another such item.

    Or in another part of the document altogether: beside one another in one mapping, two parts may
    well depend on one another.
    """
    depths = [k for k in range(2, len(path) + 1) if _is_item(path[:k], written)]
    if not depths:
        return False
    depth = depths[-1]
    item, around = path[:depth], path[: depth - 2]
    if gone[:depth] == item:
        return False
    return gone[: depth - 2] != around or _is_item(gone[:depth], written)


def _is_item(path: Path, written: Plain) -> bool:
    """Whether a mapping stands there as an item of a list."""
    if not path or not isinstance(path[-1], int):
        return False
    holder = _holder(written, path)
    return (
        isinstance(holder, list) and path[-1] < len(holder) and isinstance(holder[path[-1]], dict)
    )


def _holder(data: Plain, path: Path) -> Plain:
    """What holds the last step of the path; None where that was taken out before."""
    for step in path[:-1]:
        if isinstance(data, dict) and step in data:
            data = data[str(step)]
        elif isinstance(data, list) and isinstance(step, int) and step < len(data):
            data = data[step]
        else:
            return None
    return data
