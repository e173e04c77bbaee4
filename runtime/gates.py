"""Packing guards and sections: from a program's guards to what the adaptive kernel reads."""

from collections.abc import Sequence
from functools import cache

import numpy as np

from runtime.code import Code
from runtime.kernels.events import Gates
from runtime.program import Guard, Program
from runtime.tape import pack, read_only_integers

SECTION = -1
"""The mode that a section leaves, and enters: none."""


@cache
def no_gates() -> Gates:
    """No guards at all: what a program without modes has."""
    return _packed((), (), (), -1, -1)


def gates_of(program: Program) -> Gates:
    """The guards of a program.

    Raises:
        ValueError: their code cannot be run.
    """
    guards = program.field.guards
    return packed_gates(program, guards, (), -1) if guards else no_gates()


def packed_gates(
    program: Program, guards: Sequence[Guard], sections: tuple[Code, ...], last: int
) -> Gates:
    """Guards, and sections that end trajectories, as the kernel reads them.

    Sections stand before the guards: of what opens at one place, the first one counts. The one
    with the index `last` ends trajectories, a guard after its jump; -1: none does.

    Raises:
        ValueError: their code cannot be run.
    """
    names = [state.name for state in program.states]
    ways = [(SECTION, SECTION, 0, 0) for _ in sections]
    jumps: list[tuple[int, Code]] = []
    for guard in guards:
        ways.append((guard.mode, guard.target, len(jumps), len(guard.resets)))
        jumps += [(names.index(name), code) for name, code in guard.resets]
    conditions = (*sections, *(guard.condition for guard in guards))
    codes = (*conditions, *(code for _, code in jumps))
    mode = names.index(program.field.mode) if guards else -1
    return _packed(program.register, codes, (ways, [state for state, _ in jumps]), mode, last)


def _packed(
    names: tuple[str, ...],
    codes: Sequence[Code],
    ways: tuple[list[tuple[int, int, int, int]], list[int]] | tuple[()],
    mode: int,
    last: int,
) -> Gates:
    rows, jumps = ways or ([], [])
    return Gates(
        pack(codes, names, ()),
        read_only_integers(np.reshape(rows, (-1, 4))),
        read_only_integers(jumps),
        mode,
        last,
    )
