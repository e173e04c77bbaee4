"""A mistake that a model finds in its own data, on its way through pydantic to a diagnostic."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any, final

from pydantic_core import ErrorDetails, InitErrorDetails, PydanticCustomError, ValidationError

from spec_schema.wording import quoted

TYPE = "mistakes"
"""The pydantic error type that carries mistakes."""


@final
@dataclass(frozen=True, slots=True)
class Mistake:
    """One mistake. `at` leads from the value at fault to the part that is meant.

    With `on_key` the diagnostic points at the key there, not at its value.
    """

    code: str
    message: str
    help: str = ""
    at: tuple[str | int, ...] = ()
    on_key: bool = False


def refuse(mistakes: Iterable[Mistake]) -> None:
    """Raise the mistakes, if there are any, so that pydantic adds their place."""
    found = tuple(mistakes)
    if found:
        raise _error(found)


def repeated(names: tuple[str, ...], key: str) -> Iterator[Mistake]:
    """The names that stand twice in the list under `key`."""
    seen: set[str] = set()
    for index, name in enumerate(names):
        if name in seen:
            message = f"{quoted(name)} stands twice in '{key}'"
            yield Mistake("S112", message, "remove one", (key, index))
        seen.add(name)


def together(error: ValidationError, mistakes: Iterable[Mistake]) -> ValidationError:
    """What pydantic found inside a value, and the mistakes of the value as a whole.

    Pydantic's own checks of the parts hide those of the whole: a validator in mode `wrap` catches
    the error, looks at the raw value, and raises this.
    """
    lines = [_line(found) for found in error.errors(include_url=False)]
    told = tuple(mistakes)
    if told:
        lines.append(InitErrorDetails(type=_error(told), loc=(), input=None))
    return ValidationError.from_exception_data(error.title, lines)


def _line(found: ErrorDetails) -> InitErrorDetails:
    kind: str | PydanticCustomError = found["type"]
    if kind == TYPE:
        kind = _error(carried(found["ctx"]))
    return InitErrorDetails(
        type=kind, loc=found["loc"], input=found["input"], ctx=found.get("ctx", {})
    )


def _error(mistakes: tuple[Mistake, ...]) -> PydanticCustomError:
    return PydanticCustomError(TYPE, "this does not fit together", {"found": mistakes})


def refused(code: str, message: str, remedy: str = "") -> PydanticCustomError:
    """One mistake as the error to raise."""
    return _error((Mistake(code, message, remedy),))


def carried(context: dict[str, Any]) -> tuple[Mistake, ...]:
    """The mistakes that an error of type `TYPE` carries."""
    found: tuple[Mistake, ...] = context["found"]
    return found
