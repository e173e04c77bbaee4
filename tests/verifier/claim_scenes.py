"""Behaviors whose bifurcations are known in closed form, and claims on them."""

from dataclasses import replace

from runtime.claim import Claim, Place, Span
from runtime.code import Code
from runtime.program import Program
from tests.verifier.topology_scenes import behavior, control, state

X, Y = state("x", -2.0, 2.0), state("y", -2.0, 2.0)
MU = control("mu", -1.0, 1.0, 0.5)

FOLD = behavior("fold", (X,), ("mu 0.2 sub x x mul sub",), (MU,))
"""x' = mu - 0.2 - x²: a saddle-node at mu = 0.2 (Strogatz 2015, section 3.1)."""

FORK = behavior("fork", (X,), ("mu 0.1 add x mul x x mul x mul sub",), (MU,))
"""x' = (mu + 0.1) x - x³: a supercritical pitchfork at mu = -0.1 (section 3.4)."""

CROSS = behavior("cross", (X,), ("mu 0.3 sub x mul x x mul sub",), (MU,))
"""x' = (mu - 0.3) x - x²: a transcritical bifurcation at mu = 0.3 (section 3.2)."""

ONSET = behavior(
    "onset",
    (X, Y),
    (
        "mu 0.15 add x x mul y y mul add sub x mul y sub",
        "mu 0.15 add x x mul y y mul add sub y mul x add",
    ),
    (MU,),
)
"""The Hopf normal form: a cycle of radius sqrt(mu + 0.15), period 2 pi, from mu = -0.15 on."""


MIRROR = behavior("mirror", (X,), ("mu mu mul x x mul sub",), (MU,))
"""x' = mu² - x²: branches x = mu and x = -mu cross at 0, and look as if they came and went."""

SIZE = "x x mul y y mul add"
PUSH = f"mu {SIZE} add {SIZE} {SIZE} mul sub"
TWO_CYCLES = behavior("two cycles", (X, Y), (f"{PUSH} x mul y sub", f"{PUSH} y mul x add"), (MU,))
"""r' = mu r + r³ - r⁵: a fold of cycles at mu = -1/4, a subcritical Hopf at 0 (section 8.2)."""


def claim(feature: str, least: int = 1, most: int | None = 1, **changes: object) -> Claim:
    plain = Claim(
        text=feature,
        feature=feature,
        least=least,
        most=most,
        other=False,
        places=(),
        reaches=(),
        period=None,
        period_within=0.01,
        share=None,
        goes_to="",
        called="",
        over=(),
        settings=(),
        sketched=False,
        origin="spec.yaml:1:1",
    )
    return replace(plain, **changes)


def all_of(program: Program, name: str = "mu") -> tuple[Span, ...]:
    found = next(c for c in program.controls if c.name == name)
    return (Span(name, found.low, found.high),)


def at(name: str, code: str, within: float) -> Place:
    return Place(name, Code(code), within)
