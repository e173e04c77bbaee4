"""What is held over a period is worked out once; bits are those of working it out at each stage."""

from dataclasses import replace
from typing import Final

import numpy as np
import pytest

from runtime.architecture import Input, Outside
from runtime.chance import generator
from runtime.program import Program, Role
from runtime.scheduler.inputs import Inputs
from runtime.scheduler.ticker import Ticker, domains_of
from specc.loading import load_program
from tests.runtime.behaviors import van_der_pol

TICKS: Final = 300
# Rates and guards of what is held; an own rate that is held beside one that is not; a timer; rates
# of own states that read one another.
STEADY: Final = {
    "avoid": (1, 1),
    "back_off": (1, 1),
    "back_up_and_turn": (1, 0),
    "van_der_pol": (0, 1),
}


def program_of(name: str) -> Program:
    """One of the library, or of the tests; the last two move states of their own only."""
    if name in {"avoid", "back_off"}:
        return load_program(f"specs/{name}.yaml")
    program = van_der_pol() if name == "van_der_pol" else load_program(f"specs/{name}.yaml")
    is_read = [state.role is Role.SENSED for state in program.states]
    own = zip(program.states, is_read, strict=True)
    return replace(
        program, states=tuple(s if read else replace(s, role=Role.DRIVEN) for s, read in own)
    )


def ticker(program: Program) -> Ticker:
    """It senses all that it can, from a board with a place for each."""
    sensed = [s.name for s in program.states if s.role is not Role.DRIVEN]
    sensed = [name for name in sensed if name != program.field.mode]
    wires = [Input(name, i, 0.0, 1.0, Outside.CLIP, "") for i, name in enumerate(sensed)]
    inputs = Inputs(wires, domains_of(program))
    return Ticker(program, inputs, (), None, 0.05, generator(1, "node", "n"))


def taken_for(program: Program, steady: int) -> Ticker:
    """One whose rates and guards are taken for steady, or not."""
    made = ticker(program)
    made._frame = made._frame._replace(steady_rates=steady, steady_guards=steady)
    return made


def ticks(program: Program, made: Ticker) -> list[tuple[int, bytes, bytes, bytes]]:
    """All that a ticker leaves, tick by tick."""
    random = np.random.default_rng(1)
    found, board = [], np.zeros(len(program.states))
    if not program.field.mode:
        made.own[:] += 0.5
    for _ in range(TICKS):
        if random.random() < 0.2:  # else a mode would switch at each tick
            board = random.choice([0.0, 0.3, 1.0, 1.7], len(board))
        flags = made.tick(board, allowed=True)
        found.append((flags, made.told.tobytes(), made.own.tobytes(), made.register.tobytes()))
    return found


@pytest.mark.parametrize("name", STEADY)
def test_what_is_held_is_worked_out_once_and_bits_are_the_same(name: str) -> None:
    program = program_of(name)
    quick = ticker(program)

    assert (quick._frame.steady_rates, quick._frame.steady_guards) == STEADY[name]
    left = ticks(program, quick)
    assert left == ticks(program, taken_for(program, 0))
    if STEADY[name] != (1, 1):  # and what is taken for steady and is not would show
        assert left != ticks(program, taken_for(program, 1))
