"""From what a log holds to SI: texts to indices, the binding's scale, offset and unit."""

from collections import Counter
from dataclasses import dataclass
from typing import final

import numpy as np

from runtime.arrays import Array
from runtime.program import Binding
from verifier.traces.columns import Column
from verifier.traces.faults import nearest_help
from verifier.traces.trace import Loss

_LOGIC = {"true": 1.0, "false": 0.0, "True": 1.0, "False": 0.0, "TRUE": 1.0, "FALSE": 0.0}


@final
class NotNumbersError(Exception):
    """A column of texts where numbers are needed."""

    def __init__(self, message: str, help: str) -> None:  # noqa: A002  # as in Diagnostic
        self.message = message
        self.help = help
        super().__init__(message)


@final
@dataclass(frozen=True, eq=False, slots=True)
class Measured:
    """values: (T,) SI, NaN where the log had none."""

    values: Array
    losses: tuple[Loss, ...]


def measured(
    binding: Binding, values: tuple[str, ...], column: Column, *, derived: bool
) -> Measured:
    """The column as the binding means it; `values` names the states of a discrete variable.

    A derived angle is in radians whatever the binding's unit is. Raises NotNumbersError.
    """
    if column.texts is not None:
        texts = {text for text in column.texts if text}
        if values and texts & set(values):
            return _indices(binding, values, column.texts)
        if texts and texts <= _LOGIC.keys():
            return Measured(np.array([_LOGIC.get(text or "", np.nan) for text in column.texts]), ())
        if texts and not np.isfinite(column.numbers).any():
            raise _not_numbers(binding, values, sorted(texts))
    unit = 1.0 if derived else binding.unit.scale
    numbers = binding.scale * column.numbers * unit + binding.offset
    missing = int((~np.isfinite(numbers)).sum())
    losses = (
        (Loss("no finite value", missing, f"{binding.name} at {binding.path}"),) if missing else ()
    )
    return Measured(numbers, losses)


def _indices(binding: Binding, values: tuple[str, ...], texts: tuple[str | None, ...]) -> Measured:
    index = {text: float(i) for i, text in enumerate(values)}
    numbers = np.array([index.get(text or "", np.nan) for text in texts], dtype=np.float64)
    unknown = Counter(text or "" for text in texts if text not in index)
    losses = []
    for text, count in sorted(unknown.items()):
        known = nearest_help(text, values, "declared").splitlines()[0]
        losses.append(Loss("undeclared value", count, f"{binding.name}: '{text}' ({known})"))
    return Measured(numbers, tuple(losses))


def _not_numbers(binding: Binding, values: tuple[str, ...], texts: list[str]) -> NotNumbersError:
    shown = ", ".join(repr(text) for text in texts[:6])
    if values:
        message = f"none of the values of {binding.name} stands at this path (it holds {shown})"
        return NotNumbersError(message, f"declared: {', '.join(values)}")
    message = f"{binding.path} holds texts, not numbers ({shown})"
    return NotNumbersError(message, f"write {{path: ..., values: [{', '.join(texts[:6])}]}}")
