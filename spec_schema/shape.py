"""The shape of a document against its model: all mistakes in one go.

Pydantic stops at a mapping whose keys are wrong: its own rules are not looked at. So a misspelt key
is taken for what it was probably meant to be, and the document checked again.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from itertools import islice
from typing import Generic, TypeVar, final

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from spec_schema.diagnostics import MOST
from spec_schema.explain import empty_value, meant_key, mistakes_of, unknown_key
from spec_schema.mistake import Mistake
from spec_schema.node import Plain
from spec_schema.places import Path

_ROUNDS = 6
"""A round of repair makes the inside of misspelt keys visible: one level of nesting each."""

_ENOUGH = 4 * MOST
"""More mistakes of a kind are not looked into: a hostile text could hold a hundred thousand."""

Model = TypeVar("Model", bound=BaseModel)


@final
@dataclass(frozen=True, slots=True)
class Shape(Generic[Model]):
    """The model of a document, or why there is none.

    written: how the keys were written that were taken for others, by what they were taken for.
    """

    spec: Model | None
    mistakes: tuple[Mistake, ...]
    written: Mapping[Path, str] = field(default_factory=dict)


def check_shape(model: type[Model], data: dict[str, Plain]) -> Shape[Model]:
    """Check `data`, which is changed on the way, against the model."""
    repairs = _Repairs(model, data)
    for _ in range(_ROUNDS):
        try:
            spec = model.model_validate(data)
        except ValidationError as error:
            errors = error.errors(include_url=False)
            unknown = [found["loc"] for found in errors if found["type"] == "extra_forbidden"]
            if not unknown:
                return Shape(None, repairs.all_mistakes(errors), repairs.written)
            repairs.repair(unknown)
        else:
            found = repairs.all_mistakes([])
            return Shape(None if found else spec, found, repairs.written)
    return Shape(None, repairs.all_mistakes([]), repairs.written)


@final
@dataclass(slots=True)
class _Repairs(Generic[Model]):
    """The document as it was probably meant, and how its keys were written."""

    model: type[Model]
    data: dict[str, Plain]
    mistakes: list[Mistake] = field(default_factory=list)
    written: dict[Path, str] = field(default_factory=dict)

    def repair(self, unknown: list[Path]) -> None:
        """Rename the unknown keys to those that were meant, or take them out."""
        for path in unknown[:_ENOUGH]:
            self._repair(path)
        for path in unknown[_ENOUGH:]:
            mapping = _at(self.data, path[:-1])
            assert isinstance(mapping, dict), "pydantic finds unknown keys in mappings alone"
            del mapping[str(path[-1])]

    def _repair(self, path: Path) -> None:
        mapping = _at(self.data, path[:-1])
        assert isinstance(mapping, dict), "pydantic finds unknown keys in mappings alone"
        value = mapping.pop(str(path[-1]))
        self.mistakes.append(self._as_written(unknown_key(self.model, path, mapping)))
        meant = meant_key(self.model, path, mapping)
        if meant is not None:
            mapping[meant] = value
            self.written[(*path[:-1], meant)] = str(path[-1])

    def all_mistakes(self, errors: list[ErrorDetails]) -> tuple[Mistake, ...]:
        """The mistakes of all rounds; `errors` are those of the last."""
        empty = dict.fromkeys(_empty_values(self.data, ()))
        found = [
            m
            for error in errors[:_ENOUGH]
            for m in mistakes_of(self.model, error)
            if m.at not in empty
        ]
        found.extend(empty_value(self.model, path) for path in islice(empty, _ENOUGH))
        if errors and not found and not self.mistakes:
            found = [Mistake("S103", f"this does not fit: {errors[0]['msg']}", at=errors[0]["loc"])]
        return (*self.mistakes, *map(self._as_written, found))

    def _as_written(self, mistake: Mistake) -> Mistake:
        at = tuple(
            self.written.get(mistake.at[: depth + 1], step) for depth, step in enumerate(mistake.at)
        )
        return Mistake(mistake.code, mistake.message, mistake.help, at, mistake.on_key)


def _at(data: Plain, path: Path) -> Plain:
    for step in path:
        if isinstance(data, dict):
            data = data[str(step)]
        elif isinstance(data, list):
            data = data[int(step)]
    return data


def _empty_values(data: Plain, path: Path) -> Iterator[Path]:
    """The keys with nothing after them."""
    if isinstance(data, dict):
        for key, value in data.items():
            if value is None:
                yield (*path, key)
            yield from _empty_values(value, (*path, key))
    if isinstance(data, list):
        for index, value in enumerate(data):
            yield from _empty_values(value, (*path, index))
