"""What a learner is given, as arrays: refused with a reason where it can't be used."""

import reprlib
from numbers import Integral, Real
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from lcs.arrays import Array
from lcs.faults import LearnerError

NO_ACTION: Final = "no action waits for its reward: call act(x) first, and learn once for each"


def numbers_of(given: npt.ArrayLike, what: str) -> Array:
    """What is given as an array of numbers; `what` says what it has to be.

    Raises:
        LearnerError: it is a text, holds something that is no number, or has rows of other lengths.
    """
    problem = LearnerError(f"{what}; got {reprlib.repr(given)}")
    try:
        raw = np.asarray(given)
    except ValueError as error:  # rows of other lengths
        raise problem from error
    is_text = raw.dtype.kind == "O" and any(isinstance(each, str) for each in raw.flat)
    if is_text or raw.dtype.kind not in "biufO":
        raise problem
    try:
        found: Array = np.asarray(raw, np.float64, order="C")
    except (TypeError, ValueError) as error:
        raise problem from error
    return found


def inputs_of(given: npt.ArrayLike, n: int) -> Array:
    """Inputs (T, n).

    Raises:
        LearnerError: they are not n finite numbers each.
    """
    what = f"inputs are rows of {n} number{'s' * (n != 1)}"
    x = numbers_of(given, what)
    if x.ndim != 2 or x.shape[1] != n:
        raise LearnerError(f"{what}, and not of shape {x.shape}")
    if not np.isfinite(x).all():
        row = int(np.flatnonzero(~np.isfinite(x).all(axis=1))[0])
        raise LearnerError(f"input {row} is not finite: {x[row].tolist()}")
    return x


def input_of(given: npt.ArrayLike, n: int) -> Array:
    """An input (n,).

    Raises:
        LearnerError: it is not n finite numbers.
    """
    what = f"an input is {n} number{'s' * (n != 1)}"
    x = numbers_of(given, what)
    if x.shape != (n,):
        raise LearnerError(f"{what}, and not of shape {x.shape}")
    found: Array = inputs_of(x[None], n)[0]
    return found


def rewards_of(given: npt.ArrayLike, count: int, actions: int) -> Array:
    """The rewards (T, A) of all actions for so many inputs.

    Raises:
        LearnerError: they are of another shape, or not finite.
    """
    rewards = numbers_of(given, "rewards are a row of numbers for each input")
    if rewards.shape != (count, actions):
        raise LearnerError(
            f"rewards are {rewards.shape}: {count} inputs and {actions} actions need as many rows "
            "and columns"
        )
    if not np.isfinite(rewards).all():
        raise LearnerError("a reward is not finite")
    return rewards


def reward_of(given: Any) -> float:
    """A reward.

    Raises:
        LearnerError: it is not finite.
    """
    if not isinstance(given, Real) or not np.isfinite(float(given)):
        raise LearnerError(f"a reward is a finite number, and {reprlib.repr(given)} is none")
    return float(given)


def range_of(low: npt.ArrayLike, high: npt.ArrayLike, n: int) -> tuple[Array, Array]:
    """The range of n inputs, low and high (n,): of all, or of each.

    Raises:
        LearnerError: they are not n finite numbers each, or low does not lie below high.
    """
    try:
        ends = [np.array(np.broadcast_to(np.asarray(end, np.float64), n)) for end in (low, high)]
    except ValueError as fault:
        raise LearnerError(f"low and high are numbers, or {n} numbers each") from fault
    if not (np.isfinite(ends).all() and (ends[0] < ends[1]).all()):
        raise LearnerError(f"low must lie below high, both finite (got {low!r} and {high!r})")
    return ends[0], ends[1]


def count_of(given: Any, name: str) -> int:
    """A whole number of 1 or more.

    Raises:
        LearnerError: it is none.
    """
    if isinstance(given, bool) or not isinstance(given, Integral) or given < 1:
        raise LearnerError(f"{name} is a whole number of 1 or more, and {given!r} is none")
    return int(given)


def chance_of(seed: Any) -> np.random.Generator:
    """A source of chance of its own.

    Raises:
        LearnerError: the seed is none.
    """
    try:
        return np.random.default_rng(seed)
    except (TypeError, ValueError) as error:
        raise LearnerError(f"seed is a whole number of 0 or more, and {seed!r} is none") from error
