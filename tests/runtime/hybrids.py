"""Behaviors with modes, written by hand."""

from dataclasses import replace

from runtime.code import Code
from runtime.program import Guard, Kind, Program
from tests.runtime.behaviors import NOWHERE, control, formula_program, state

GRAVITY = 9.81


def guard(mode: int, target: int, condition: str, **resets: str) -> Guard:
    codes = tuple((name, Code(text)) for name, text in resets.items())
    return Guard(mode, target, Code(condition), codes, NOWHERE)


def with_modes(program: Program, names: tuple[str, ...], *guards: Guard) -> Program:
    """The program with a last state `mode`, which begins in the first mode."""
    mode = replace(state("mode", 0.0, len(names) - 1.0), kind=Kind.DISCRETE, values=names, hold=0.0)
    field = replace(program.field, mode="mode", form="modes", guards=guards)
    return replace(program, states=(*program.states, mode), field=field)


def bouncing_ball(low: float = -1.0) -> Program:
    """A ball that falls to x = 0 and bounces back with the share e of its speed."""
    return with_modes(
        formula_program(
            (state("x", low, 20.0), state("v", -50.0, 50.0)),
            {"x": "v", "v": f"-{GRAVITY}"},
            (control("e", 0.0, 1.0, 0.5),),
        ),
        ("flight",),
        guard(0, 0, "x neg", v="e v mul neg"),
    )


def thermostat() -> Program:
    """Heating to 40 from below, cooling to 10 from above; it switches at 20 and 22. Rate k."""
    return with_modes(
        formula_program(
            (state("T", 0.0, 50.0),),
            {"T": "k mode 0 eq 40 10 where T sub mul"},
            (control("k", 0.01, 10.0, 1.0),),
        ),
        ("heat", "cool"),
        guard(0, 1, "T 22 sub"),
        guard(1, 0, "20 T sub"),
    )


def patrol() -> Program:
    """Forward at v1 to x1, backward at v2 to x2, turning at once."""
    return with_modes(
        formula_program(
            (state("x", -6.0, 6.0), state("v", -2.0, 2.0)),
            {"x": "v", "v": "0"},
            (
                control("x1", 0.5, 5.0, 1.0),
                control("x2", -5.0, -0.5, -1.0),
                control("v1", 0.1, 1.0, 0.5),
                control("v2", 0.1, 1.0, 0.5),
            ),
        ),
        ("forward", "back"),
        guard(0, 1, "x x1 sub", v="v2 neg"),
        guard(1, 0, "x2 x sub", v="v1"),
    )


def relay() -> Program:
    """It runs to 0 from both sides, where nothing is left but to switch."""
    return with_modes(
        formula_program((state("x", -5.0, 5.0),), {"x": "mode 0 eq 1 -1 where"}),
        ("up", "down"),
        guard(0, 1, "x"),
        guard(1, 0, "x neg"),
    )
