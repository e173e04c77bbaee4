"""Behaviors whose portraits are known in closed form, written by hand as programs."""

import math
from dataclasses import replace

import numpy as np

from runtime.code import Code
from runtime.flow import flow_of, next_states, rates
from runtime.interpolation import tabulate
from runtime.program import (
    Control,
    ErrorBound,
    Field,
    Kind,
    Origin,
    Program,
    Role,
    State,
    Term,
    Unit,
)
from runtime.table import Axis, Method

ONE = Unit("1", 1.0)
METRE = Unit("m", 1.0)
CENTIMETRE = Unit("cm", 0.01)
DEGREE = Unit("deg", math.pi / 180.0)
RADIAN = Unit("rad", 1.0)


def state(name: str, low: float, high: float, **changes: object) -> State:
    plain = State(
        name, ONE, low, high, Role.BOTH, Kind.CONTINUOUS, 0.0, None, (), ("robot", "world"), "", ""
    )
    return replace(plain, **changes)


def control(name: str, low: float, high: float, default: float) -> Control:
    return Control(name, ONE, low, high, default, "", "")


def behavior(
    name: str,
    states: tuple[State, ...],
    formula: tuple[str, ...],
    controls: tuple[Control, ...] = (),
    every: float = 0.0,
) -> Program:
    """A formula in postfix, one text per driven state; a step map where `every` is positive."""
    field = Field(
        driven=tuple(s.name for s in states if s.is_driven),
        form="step" if every else "formula",
        every=every,
        tables=(),
        terms=(),
        bounds=(),
        formula=tuple(map(Code, formula)),
        origin="",
    )
    return Program(
        name=name,
        about="",
        states=states,
        controls=controls,
        constants=(),
        outputs=(),
        field=field,
        fidelity=None,
        bindings=(),
        judge_when=None,
        realizes=(),
        feasibility=None,
        source=Origin("", "", ""),
    )


def tabulated(program: Program, count: int, error: float) -> Program:
    """The same behavior through one cubic table over its states; controls at their defaults."""
    axes = tuple(
        Axis(s.name, s.low, s.high, count, s.kind is Kind.PERIODIC) for s in program.states
    )
    nodes = [a.low + a.step * np.arange(a.count) for a in axes]
    x = np.stack(np.meshgrid(*nodes, indexing="ij"), axis=-1)
    u = np.array([c.default for c in program.controls])
    flow = flow_of(program)
    values = next_states(flow, x, u) if program.field.is_map else rates(flow, x, u)
    driven = program.driven
    field = replace(
        program.field,
        tables=(tabulate(values[..., driven], axes, Method.CUBIC),),
        terms=tuple(Term(k, Code("1"), 0, k) for k in range(len(driven))),
        bounds=tuple(ErrorBound(error, 1e-3, 1000) for _ in driven),
    )
    return replace(program, field=field)


def van_der_pol(mu: float = 1.0) -> Program:
    return behavior(
        "van_der_pol",
        (state("x", -4.0, 4.0), state("v", -5.0, 5.0)),
        ("v", "mu 1 x x mul sub mul v mul x sub"),
        (control("mu", 0.0, 5.0, mu),),
    )


def pendulum(friction: float = 0.3, kind: Kind = Kind.PERIODIC) -> Program:
    return behavior(
        "pendulum",
        (
            state("angle", -math.pi, math.pi, kind=kind, unit=RADIAN),
            state("rate", -4.0, 4.0, unit=Unit("rad/s", 1.0)),
        ),
        ("rate", "angle sin neg friction rate mul sub"),
        (control("friction", 0.0, 2.0, friction),),
    )


def linear(a: float, b: float, c: float, d: float) -> Program:
    """x' = a x + b y, y' = c x + d y."""
    return behavior(
        "linear",
        (state("x", -2.0, 2.0, unit=METRE), state("y", -2.0, 2.0, unit=METRE)),
        (f"{a!r} x mul {b!r} y mul add", f"{c!r} x mul {d!r} y mul add"),
    )


def plane(fx: str, fy: str) -> Program:
    """Two dimensionless states over [-2, 2]²."""
    return behavior("plane", (state("x", -2.0, 2.0), state("y", -2.0, 2.0)), (fx, fy))


def line(f: str) -> Program:
    """One state over [-2, 2]."""
    return behavior("line", (state("x", -2.0, 2.0),), (f,))


def henon(a: float = 1.4, b: float = 0.3) -> Program:
    return behavior(
        "henon",
        (state("x", -4.0, 4.0), state("y", -2.0, 2.0)),
        ("1 a x mul x mul sub y add", "b x mul"),
        (control("a", 0.0, 2.0, a), control("b", 0.0, 1.0, b)),
        every=0.1,
    )


HOPF = plane(
    "x 1 x x mul sub y y mul sub mul y sub",
    "y 1 x x mul sub y y mul sub mul x add",
)
"""Polar: r' = r (1 - r²), one turn in 2 pi seconds; the unit circle attracts."""

OSCILLATOR = linear(0.0, 1.0, -1.0, 0.0)
