"""The codes of an arbiter, packed: worked out together from what it reads."""

from collections.abc import Sequence
from typing import final

import numpy as np

from runtime.arbiter import Arbiter
from runtime.arrays import Array
from runtime.code import Code
from runtime.direct_calls import machine_code
from runtime.kernels.machine import evaluate_points
from runtime.tape import pack


@final
class Conditions:
    """Some codes over the register of an arbiter: reads, controls, constants."""

    def __init__(self, arbiter: Arbiter, codes: Sequence[Code]) -> None:
        self._tape = pack(codes, arbiter.register, ())
        self._register: Array = np.zeros((1, len(arbiter.register)))
        constants = [constant.value for constant in arbiter.constants]
        self._register[0, len(arbiter.register) - len(constants) :] = constants
        # Kernels are compiled for arrays that nobody writes to.
        self._read_only = self._register.view()
        self._read_only.setflags(write=False)
        self._out: Array = np.zeros((1, len(codes)))
        given = (self._tape, self._read_only, self._out)
        self._evaluate = machine_code(evaluate_points, given)

    def at(self, reads: Array) -> Array:
        """The values (q,) where it reads `reads` (m,); overwritten by the next call."""
        values: Array = self._out[0]
        if values.size:
            self._register[0, : reads.size] = reads
            self._evaluate(self._tape, self._read_only, self._out)
        return values


def entries_of(arbiter: Arbiter) -> tuple[str, ...]:
    """The names of what `decide` is given: reads, then controls."""
    return arbiter.register[: len(arbiter.reads) + len(arbiter.controls)]
