"""From what a log holds to SI: texts to indices, the binding's scale, offset and unit."""

from collections import Counter
from dataclasses import dataclass
from typing import final

import numpy as np

from runtime.arrays import Array
from runtime.program import Binding
from verifier.traces.faults import nearest_help
from verifier.traces.messages.columns import Column
from verifier.traces.trace import Loss

MOST_NOTES = 20
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
    notes: tuple[str, ...] = ()


@final
@dataclass(frozen=True, slots=True)
class Meaning:
    """What the values of a column are.

    texts: of a discrete variable's values, or of a signal's, and the index each stands for.
    is_signal: a text that is not among them is then some other value (-1), not a lost one.
    derived: the values are angles in radians, whatever the binding's unit is.
    """

    texts: dict[str, int]
    is_signal: bool
    derived: bool


def measured(binding: Binding, meaning: Meaning, column: Column) -> Measured:
    """The column as the binding means it; raises NotNumbersError."""
    if column.texts is not None:
        texts = {text for text in column.texts if text}
        if texts & meaning.texts.keys():
            return _indices(binding, meaning, column.texts)
        if texts and texts <= _LOGIC.keys():
            return Measured(np.array([_LOGIC.get(text or "", np.nan) for text in column.texts]), ())
        words = sorted(text for text in texts if not _is_number(text))
        if words and not np.isfinite(column.numbers).any():
            raise _not_numbers(binding, tuple(meaning.texts), words)
    unit = 1.0 if meaning.derived else binding.unit.scale
    numbers = _scaled(column.numbers, binding, unit)
    missing = int((~np.isfinite(numbers)).sum())
    where = f"{binding.name} at {binding.path}"
    losses = (Loss("no finite value", missing, where),) if missing else ()
    ignored = meaning.derived and binding.unit.scale != 1.0
    note = f"{where}: in radians, the unit {binding.unit.text} is not applied"
    return Measured(numbers, losses, (note,) if ignored else ())


def _scaled(numbers: Array, binding: Binding, unit: float) -> Array:
    """In SI; of long logs not copied more often than needed."""
    if binding.scale == unit == 1.0 and binding.offset == 0.0:
        return numbers
    with np.errstate(over="ignore"):  # what overflows is counted as not finite
        scaled = binding.scale * numbers
        scaled *= unit
        scaled += binding.offset
    return scaled


def _is_number(text: str) -> bool:
    """Whether the text is a number; `nan` and `inf` are."""
    try:
        float(text)
    except ValueError:
        return False
    return True


def _indices(binding: Binding, meaning: Meaning, texts: tuple[str | None, ...]) -> Measured:
    index = {text: float(i) for text, i in meaning.texts.items()}
    other = -1.0 if meaning.is_signal else np.nan
    numbers = [index.get(text, other) if text else np.nan for text in texts]
    unknown = Counter(text or "" for text in texts if text not in index)
    empty = unknown.pop("", 0)
    losses = [Loss("no value", empty, f"{binding.name} at {binding.path}")] if empty else []
    notes = []
    for text, count in sorted(unknown.items()):
        if meaning.is_signal:
            notes.append(
                f"{binding.name}: '{text}' in {count} samples, taken as none of its values"
            )
        else:
            known = nearest_help(text, tuple(meaning.texts), "declared").splitlines()[0]
            losses.append(Loss("undeclared value", count, f"{binding.name}: '{text}' ({known})"))
    return Measured(np.array(numbers, dtype=np.float64), tuple(losses), tuple(notes[:MOST_NOTES]))


def _not_numbers(binding: Binding, values: tuple[str, ...], texts: list[str]) -> NotNumbersError:
    texts = [text[:40] for text in texts[:6]]
    shown = ", ".join(map(repr, texts))
    if values:
        message = f"none of the values of {binding.name} stands at this path (it holds {shown})"
        return NotNumbersError(message, f"declared: {', '.join(values)}")
    message = f"{binding.path} holds texts, not numbers ({shown})"
    return NotNumbersError(message, f"write {{path: ..., values: [{', '.join(texts)}]}}")
