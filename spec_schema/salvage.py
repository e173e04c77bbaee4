"""What is left of a document when its faulty parts are taken out: enough for the later passes.

A wrong number in one place must not hide a wrong dimension in another. So the parts that the
models refuse are taken out, each with the smallest mapping that can do without it, and what is
left is checked on; names that went with them are remembered, and nothing is said about those.
"""

import copy
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Generic, TypeVar, final

from pydantic import BaseModel, ValidationError

from spec_schema.explain import mistakes_of
from spec_schema.node import Plain
from spec_schema.places import Path

_ROUNDS = 12
_NAMED = frozenset({"state", "control", "constants", "output"})
"""The sections whose keys are names that other parts refer to."""

Model = TypeVar("Model", bound=BaseModel)


@final
@dataclass(frozen=True, slots=True)
class Salvaged(Generic[Model]):
    """A valid model of what is left, and the declared names that were taken out."""

    spec: Model
    lost: frozenset[str]


def salvage(model: type[Model], data: dict[str, Plain]) -> Salvaged[Model] | None:
    """The model of `data` without its faulty parts; None where nothing useful is left."""
    rest = copy.deepcopy(data)
    lost: set[str] = set()
    for _ in range(_ROUNDS):
        try:
            return Salvaged(model.model_validate(rest), frozenset(lost))
        except ValidationError as error:
            found = [m.at for e in error.errors(include_url=False) for m in mistakes_of(model, e)]
            if any(path == () or (len(path) == 1 and path[0] in _NAMED) for path in found):
                return None
            lost.update(_taken_out(rest, found))
    return None


def _taken_out(data: dict[str, Plain], paths: Iterable[Path]) -> set[str]:
    """Remove what stands at the paths, the last items of lists first; the names that went."""
    gone: set[str] = set()
    for path in sorted(set(paths), key=repr, reverse=True):
        holder = _holder(data, path)
        if isinstance(holder, dict) and path[-1] in holder:
            del holder[str(path[-1])]
            if path[0] in _NAMED and len(path) == 2:
                gone.add(str(path[1]))
        elif isinstance(holder, list) and isinstance(path[-1], int) and path[-1] < len(holder):
            del holder[path[-1]]
    return gone


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
