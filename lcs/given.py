"""What a learner is given, as arrays: refused with a reason where it can't be used."""

import numpy as np
import numpy.typing as npt

from lcs.arrays import Array
from lcs.faults import LearnerError


def inputs_of(given: npt.ArrayLike, n: int) -> Array:
    """Inputs (T, n).

    Raises:
        LearnerError: they are not n finite numbers each.
    """
    x = np.ascontiguousarray(given, np.float64)
    if x.ndim != 2 or x.shape[1] != n:
        raise LearnerError(f"an input is {n} numbers, and not of shape {x.shape[1:]}")
    if not np.isfinite(x).all():
        row = int(np.flatnonzero(~np.isfinite(x).all(axis=1))[0])
        raise LearnerError(f"input {row} is not finite: {x[row].tolist()}")
    return x


def input_of(given: npt.ArrayLike, n: int) -> Array:
    """An input (n,).

    Raises:
        LearnerError: it is not n finite numbers.
    """
    x: Array = inputs_of(np.asarray(given, np.float64)[None], n)[0]
    return x


def rewards_of(given: npt.ArrayLike, count: int, actions: int) -> Array:
    """The rewards (T, A) of all actions for so many inputs.

    Raises:
        LearnerError: they are of another shape, or not finite.
    """
    rewards = np.ascontiguousarray(given, np.float64)
    if rewards.shape != (count, actions):
        raise LearnerError(
            f"rewards are {rewards.shape}: {count} inputs and {actions} actions need as many rows "
            "and columns"
        )
    if not np.isfinite(rewards).all():
        raise LearnerError("a reward is not finite")
    return rewards


def reward_of(given: float) -> float:
    """A reward.

    Raises:
        LearnerError: it is not finite.
    """
    if not np.isfinite(given):
        raise LearnerError(f"a reward is a finite number, and {given} is none")
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
