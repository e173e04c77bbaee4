"""Values out of JSON messages."""

import json
from collections.abc import Sequence
from typing import TypeAlias

import numpy as np

from verifier.traces.messages.columns import Cell, Decoded, column
from verifier.traces.messages.paths import Steps

Json: TypeAlias = bool | int | float | str | list["Json"] | dict[str, "Json"] | None


def decode(payloads: Sequence[bytes], asked: Sequence[Steps]) -> Decoded:
    """The asked-for leaves in all messages; one that is not JSON is marked not readable."""
    cells: list[list[Cell]] = [[] for _ in asked]
    readable = np.ones(len(payloads), dtype=np.bool_)
    reason = ""
    for row, payload in enumerate(payloads):
        try:
            message = parse(payload)
        except ValueError as error:
            readable[row] = False
            reason = reason or str(error)
            message = None
        for leaf, steps in enumerate(asked):
            cells[leaf].append(cell(at(message, steps)))
    return Decoded(tuple(column(one) for one in cells), readable, reason)


def parse(payload: bytes) -> Json:
    """The message; raises ValueError with a sentence."""
    try:
        message: Json = json.loads(payload.decode().removeprefix("\ufeff"))
    except UnicodeDecodeError as error:
        raise ValueError("it is not UTF-8 text") from error
    except (ValueError, RecursionError) as error:
        raise ValueError(f"it is not JSON: {error}") from error
    return message


def at(message: Json, steps: Steps) -> Json:
    """What stands at these steps; None where the message lacks it."""
    for step in steps:
        if isinstance(step, int):
            if not isinstance(message, list) or not -len(message) <= step < len(message):
                return None
            message = message[step]
        elif isinstance(message, dict):
            message = message.get(step)
        else:
            return None
    return message


def cell(value: Json) -> Cell:
    """A number or a text; None for everything else."""
    if isinstance(value, str):
        return value
    if isinstance(value, bool | int | float):
        try:
            return float(value)
        except OverflowError:
            return None
    return None
