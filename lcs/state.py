"""All that a learner is, as plain values and arrays: what is saved, and made into a learner again.

A learner says `state()` and is made by `from_state`. Fields are found by themselves, so one that is
added to a config or to a tuple of arrays is saved from then on.
"""

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from types import UnionType
from typing import (
    Any,
    Final,
    NamedTuple,
    Protocol,
    Self,
    TypeAlias,
    TypeVar,
    final,
    get_args,
    get_origin,
    get_type_hints,
)

import numpy as np
import numpy.typing as npt

from lcs.faults import LearnerError

Arrays: TypeAlias = Mapping[str, npt.NDArray[Any]]

Tuple = TypeVar("Tuple", bound=NamedTuple)
Data = TypeVar("Data")

CHANCES: Final = {"PCG64": np.random.PCG64, "PCG64DXSM": np.random.PCG64DXSM}
"""The bit generators whose state is kept."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class State:
    """A learner of this `kind`: values that JSON can hold, and copies of its arrays by name."""

    kind: str
    plain: Mapping[str, Any]
    arrays: Arrays


class Saved(Protocol):
    """A learner that can be saved."""

    def state(self) -> State:
        """All that it is, now."""
        ...

    @classmethod
    def from_state(cls, state: State) -> Self:
        """The learner that had this state: it goes on bit for bit as that one would."""
        ...


def arrays_of(name: str, values: NamedTuple) -> dict[str, npt.NDArray[Any]]:
    """Copies of the arrays of a tuple, by `name` and field."""
    return {f"{name}.{key}": each.copy() for key, each in values._asdict().items()}


def filled(name: str, template: Tuple, arrays: Arrays) -> Tuple:
    """The tuple of arrays that was saved by `name`; the template has as much room or less.

    Raises:
        LearnerError: an array is missing, or of another type or shape.
    """
    found: dict[str, npt.NDArray[Any]] = {}
    shapes: dict[tuple[int, ...], tuple[int, ...]] = {}
    for key, each in template._asdict().items():
        given = array_named(f"{name}.{key}", arrays)
        if given.dtype != each.dtype or given.ndim != each.ndim:
            raise LearnerError(
                f"'{name}.{key}' is {given.dtype} of {given.ndim} axes, and not "
                f"{each.dtype} of {each.ndim}"
            )
        shape = shapes.setdefault(each.shape, given.shape)
        if given.shape != shape or any(np.less(given.shape, each.shape)):
            raise LearnerError(f"'{name}.{key}' is of shape {given.shape}, and does not fit")
        found[key] = np.array(given, order="C")
    return template._replace(**found)


def array_named(name: str, arrays: Arrays) -> npt.NDArray[Any]:
    """An array.

    Raises:
        LearnerError: there is none of this name.
    """
    if name not in arrays:
        raise LearnerError(f"'{name}' is missing")
    return arrays[name]


def plain_of(data: Any) -> Any:
    """A frozen dataclass as plain values; members of enumerations by their names."""
    if dataclasses.is_dataclass(data):
        return {each.name: plain_of(getattr(data, each.name)) for each in dataclasses.fields(data)}
    if isinstance(data, Enum):
        return data.name
    if isinstance(data, np.generic):
        return data.item()
    if isinstance(data, tuple):
        return [plain_of(each) for each in data]
    return data


def from_plain(kind: type[Data], plain: Any, place: str = "config") -> Data:
    """The dataclass of which `plain_of` made this.

    Raises:
        LearnerError: a field is missing, unknown or of another type.
    """
    if not dataclasses.is_dataclass(kind) or not isinstance(plain, Mapping):
        raise LearnerError(f"'{place}' is {plain!r}, and not a group of values")
    hints = get_type_hints(kind)
    names = [each.name for each in dataclasses.fields(kind)]
    for name in sorted({*names} ^ {*plain}):
        what = "is missing" if name in names else "is unknown"
        raise LearnerError(f"'{place}.{name}' {what}: another version of specc wrote it")
    read = {name: _value(hints[name], plain[name], f"{place}.{name}") for name in names}
    made: Data = kind(**read)
    return made


def _value(hint: Any, plain: Any, place: str) -> Any:
    origin, parts = get_origin(hint), get_args(hint)
    if hint is Any:
        return plain
    if origin is UnionType:  # of one kind and None
        return None if plain is None else _value(parts[0], plain, place)
    if origin is tuple and isinstance(plain, list | tuple):
        return tuple(_value(parts[0], each, f"{place}[{i}]") for i, each in enumerate(plain))
    if dataclasses.is_dataclass(hint):
        return from_plain(hint, plain, place)  # type: ignore[arg-type]  # it is a class
    kind = origin or hint
    if issubclass(kind, Enum):
        if plain not in kind.__members__:
            raise LearnerError(f"'{place}' is {plain!r}: known are {', '.join(kind.__members__)}")
        return kind[plain]
    if type(plain) is not kind and not (kind is float and type(plain) is int):
        raise LearnerError(f"'{place}' is {plain!r}, and not of type {kind.__name__}")
    return plain


def plain_of_chance(chance: np.random.Generator) -> dict[str, Any]:
    """The state of a source of chance.

    Raises:
        LearnerError: it is of a kind that is not kept.
    """
    state: dict[str, Any] = dict(chance.bit_generator.state)
    if state["bit_generator"] not in CHANCES:
        raise LearnerError(f"the state of {state['bit_generator']} is not kept: use PCG64")
    return state


def chance_from(plain: Any) -> np.random.Generator:
    """The source of chance that had this state.

    Raises:
        LearnerError: it is none.
    """
    try:
        bits = CHANCES[plain["bit_generator"]](0)
        bits.state = plain
    except (KeyError, TypeError, ValueError, OverflowError) as error:
        raise LearnerError("the state of chance can't be read") from error
    return np.random.Generator(bits)
