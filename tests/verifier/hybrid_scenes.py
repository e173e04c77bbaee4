"""Behaviors with modes whose cycles are known in closed form."""

import math
from dataclasses import replace

from runtime.code import Code
from runtime.program import Control, Guard, Kind, Program, Role, State
from tests.verifier.topology_scenes import behavior, state


def switching(
    states: tuple[State, ...],
    rates: dict[str, tuple[str, ...]],
    guards: tuple[tuple[str, str, str, dict[str, str]], ...],
    controls: tuple[Control, ...] = (),
) -> Program:
    """A field per mode, and (mode, target, condition, resets) for each guard; all in postfix."""
    modes = tuple(rates)
    mode = replace(
        state("mode", 0.0, float(len(modes) - 1)), kind=Kind.DISCRETE, values=modes, role=Role.BOTH
    )
    formula = []
    for component in range(len(states)):
        text = rates[modes[-1]][component]
        for i in reversed(range(len(modes) - 1)):
            text = f"mode {i} eq {rates[modes[i]][component]} {text} where"
        formula.append(text)
    plain = behavior("switching", states, tuple(formula), controls)
    field = replace(
        plain.field,
        form="modes",
        mode="mode",
        guards=tuple(
            Guard(
                modes.index(left),
                modes.index(entered),
                Code(condition),
                tuple((name, Code(code)) for name, code in resets.items()),
                "",
            )
            for left, entered, condition, resets in guards
        ),
    )
    return replace(plain, states=(*states, mode), field=field)


def carousel(jump: str, settle: float = 0.0) -> Program:
    """x runs from -1 to 1 in 2 s and jumps back; y' = -settle y, and y jumps to `jump`."""
    return switching(
        (state("x", -1.5, 1.5), state("y", -4.0, 4.0)),
        {"run": ("1", f"{settle!r} y mul neg")},
        (("run", "run", "x 1 sub", {"x": "-1", "y": jump}),),
    )


def slanted(keep: float, lift: float) -> Program:
    """x' = 1, y' = -y/2, left where x + y/4 reaches 1, entered at x = -1 with keep*y + lift."""
    return switching(
        (state("x", -1.5, 3.0), state("y", -4.0, 4.0)),
        {"there": ("1", "y -2 div"), "back": ("-2", "0")},
        (
            ("there", "back", "x y 4 div add 1 sub", {"y": f"{keep!r} y mul {lift!r} add"}),
            ("back", "there", "-1 x sub", {}),
        ),
    )


def thermostat(low: float, high: float) -> Program:
    """T' = -T while off, 3 - T while on: on at `low`, off at `high`."""
    return switching(
        (state("T", 0.0, 3.0),),
        {"off": ("T neg",), "on": ("3 T sub",)},
        (
            ("off", "on", f"{low!r} T sub", {}),
            ("on", "off", f"T {high!r} sub", {}),
        ),
    )


def bouncing_ball(keep: float) -> Program:
    """It loses speed at each bounce: infinitely many of them in finite time."""
    return switching(
        (state("h", -0.5, 4.0), state("v", -9.0, 9.0)),
        {"flight": ("v", "-9.81")},
        (("flight", "flight", "h neg v neg min", {"h": "0", "v": f"{-keep!r} v mul"}),),
    )


def relay() -> Program:
    """x goes towards 2 and, from 1 on, towards -2, until -1: no mode reaches its zero."""
    return switching(
        (state("x", -3.0, 3.0), state("y", -3.0, 3.0)),
        {"up": ("2 x sub", "y neg"), "down": ("-2 x sub", "y neg")},
        (("up", "down", "x 1 sub", {}), ("down", "up", "-1 x sub", {})),
    )


def docking() -> Program:
    """Out until x = 1, then to rest at (1.5, 0); the other way of the first mode leads nowhere."""
    return switching(
        (state("x", -2.0, 2.0), state("y", -2.0, 2.0)),
        {"out": ("1", "y neg"), "dock": ("1.5 x sub", "y neg")},
        (("out", "dock", "x 1 sub", {}),),
    )


def spinning() -> Program:
    """In from the rim, then round the unit circle, which the second mode never leaves."""
    inside = "1 x x mul sub y y mul sub"
    return switching(
        (state("x", -2.0, 2.0), state("y", -2.0, 2.0)),
        {
            "approach": ("x neg", "y neg"),
            "spin": (f"x {inside} mul y sub", f"y {inside} mul x add"),
        },
        (("approach", "spin", "0.25 x x mul sub y y mul sub", {}),),
    )


def crank() -> Program:
    """A wheel that turns faster and slower by turns, switching twice a turn."""
    return switching(
        (
            state("angle", -math.pi, math.pi, kind=Kind.PERIODIC),
            state("rate", 0.0, 4.0),
        ),
        {"slow": ("rate", "1 rate sub"), "fast": ("rate", "3 rate sub")},
        (("slow", "fast", "angle sin 0.5 sub", {}), ("fast", "slow", "-0.5 angle sin sub", {})),
    )


def toggled(turned: float) -> Program:
    """The same with no gap between the guards: each mode begins where the other one would, too."""
    height = f"angle {turned!r} sub sin"
    return switching(
        (
            state("angle", -math.pi, math.pi, kind=Kind.PERIODIC),
            state("rate", 0.0, 4.0),
        ),
        {"slow": ("rate", "1 rate sub"), "fast": ("rate", "3 rate sub")},
        (("slow", "fast", height, {}), ("fast", "slow", f"{height} neg", {})),
    )
