"""The machine's front: evaluates postfix code over whole arrays."""

from collections.abc import Sequence

import numpy as np

from runtime.arrays import Array
from runtime.code import Code
from runtime.kernels.machine import evaluate_points
from runtime.kernels.tape import Tape
from runtime.tape import pack, read_only_view


def evaluate(codes: Sequence[Code], names: tuple[str, ...], register: Array) -> Array:
    """The values (..., k) of `codes` where the entries `names` have the values `register` (..., r).

    >>> evaluate([Code("x 2 pow"), Code("x y lt")], ("x", "y"), np.array([3.0, 4.0]))
    array([9., 1.])

    Raises:
        ValueError: a token is unknown, or code does not leave exactly one value.
    """
    return run_tape(pack(codes, names, ()), register)


def run_tape(tape: Tape, register: Array) -> Array:
    """The results (..., q) of `tape` at the points `register` (..., r)."""
    leading = register.shape[:-1]
    points = read_only_view(np.reshape(register, (-1, tape.entries)))
    out = np.empty((points.shape[0], tape.results.size))
    evaluate_points(tape, points, out)
    return out.reshape(*leading, tape.results.size)
