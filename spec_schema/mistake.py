"""A mistake that a model finds in its own data, on its way through pydantic to a diagnostic."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, final

from pydantic_core import PydanticCustomError

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
        raise PydanticCustomError(TYPE, "this does not fit together", {"found": found})


def refused(code: str, message: str, remedy: str = "") -> PydanticCustomError:
    """One mistake as the error to raise."""
    found = (Mistake(code, message, remedy),)
    return PydanticCustomError(TYPE, "this does not fit together", {"found": found})


def carried(context: dict[str, Any]) -> tuple[Mistake, ...]:
    """The mistakes that an error of type `TYPE` carries."""
    found: tuple[Mistake, ...] = context["found"]
    return found
