"""What is held over a period is worked out once; bits are those of working it out at each stage."""

from pathlib import Path
from typing import Final

import numpy as np
import pytest

from runtime.architecture import Input, Outside
from runtime.chance import generator
from runtime.program import Program, Role
from runtime.scheduler.inputs import Inputs
from runtime.scheduler.ticker import Ticker, domains_of
from specc.loading import load_program

SPECS: Final = Path("specs")
TICKS: Final = 300
# Rates and guards of what is held; a rate that reads a state that moves; a timer that guards read.
STEADY: Final = {"avoid": (1, 1), "back_off": (0, 1), "patrol": (0, 0)}


def ticker(program: Program) -> Ticker:
    """It senses all that it can, from a board with a place for each."""
    sensed = [s.name for s in program.states if s.role is not Role.DRIVEN]
    sensed = [name for name in sensed if name != program.field.mode]
    wires = [Input(name, i, 0.0, 1.0, Outside.CLIP, "") for i, name in enumerate(sensed)]
    inputs = Inputs(wires, domains_of(program))
    return Ticker(program, inputs, (), None, 0.05, generator(1, "node", "n"))


@pytest.mark.parametrize("name", STEADY)
def test_what_is_held_is_worked_out_once_and_bits_are_the_same(name: str) -> None:
    program = load_program(SPECS / f"{name}.yaml")
    quick, slow = ticker(program), ticker(program)
    assert (quick._frame.steady_rates, quick._frame.steady_guards) == STEADY[name]
    slow._frame = slow._frame._replace(steady_rates=0, steady_guards=0)
    random = np.random.default_rng(1)
    board = np.zeros(len(program.states))
    for _ in range(TICKS):
        if random.random() < 0.2:  # else a mode would switch at each tick
            board = random.uniform(0.0, 2.0, len(board))
        assert quick.tick(board, allowed=True) == slow.tick(board, allowed=True)
        assert quick.told.tobytes() == slow.told.tobytes()
        assert quick.own.tobytes() == slow.own.tobytes()
        assert quick.register.tobytes() == slow.register.tobytes()
