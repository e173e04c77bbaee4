"""Cycles against closed forms, published numbers and an independent integration."""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from runtime.arrays import Array, frozen
from runtime.code import Code
from runtime.program import Kind, Program
from tests.verifier.topology_scenes import (
    OSCILLATOR,
    behavior,
    henon,
    pendulum,
    plane,
    state,
    tabulated,
)
from verifier.topology.cycles.limit_cycles import find_cycles
from verifier.topology.features import Cycle, FixedPoint, PointKind, Stability, Standing
from verifier.topology.slices import cut

R = "x x mul y y mul add"
"""The square of the radius."""


def point(*at: float, kind: PointKind = PointKind.UNSTABLE_FOCUS) -> FixedPoint:
    return FixedPoint(
        frozen(at),
        kind,
        (),
        (),
        None,
        (),
        proved=False,
        kind_proved=False,
        radius=frozen(np.zeros(len(at))),
        standing=Standing.UNCOMPARED,
    )


ORIGIN = point(0.0, 0.0)


def looked_for(program: Program, *points: FixedPoint) -> tuple[tuple[Cycle, ...], tuple[str, ...]]:
    return find_cycles(cut(program, tuple(s.name for s in program.states), {}), points)


def cycles_of(program: Program, *points: FixedPoint) -> tuple[Cycle, ...]:
    return looked_for(program, *points)[0]


def swinging(mu: float, rest: str) -> Program:
    """x'' = mu (1 - x²) x' - rest(x), over its cycle with some room."""
    speed = 3.0 + 1.5 * mu
    return behavior(
        "swinging",
        (state("x", -3.0, 3.0), state("v", -speed, speed)),
        ("v", f"{mu!r} 1 x x mul sub mul v mul {rest} sub"),
    )


def turning(growth: str) -> Program:
    """Polar: r' = r growth(r²), one turn in 2 pi seconds; `R` in `growth` stands for r²."""
    g = growth.replace("R", R)
    return plane(f"x {g} mul y sub", f"y {g} mul x add")


def integrate(
    rates: Callable[[float, Array], list[float]],
    start: Sequence[float] | Array,
    longest: float,
    watched: int = 0,
    level: Callable[[float], float] = float,
) -> tuple[Array, tuple[Array, Array]]:
    """By scipy's DOP853: the end, and times and states where `level` of one state rises through 0.

    With another level than the state itself, where it falls through 0, too.
    """

    def crossing(_t: float, y: Array) -> float:
        return level(y[watched])

    seen = solve_ivp(
        rates, (0.0, longest), start, "DOP853", events=crossing, rtol=1e-11, atol=1e-12
    )
    assert seen.t_events is not None
    assert seen.y_events is not None
    times, states = np.array(seen.t_events[0]), np.array(seen.y_events[0])
    rising = np.array([level is not float or rates(0.0, y)[watched] > 0.0 for y in states])
    return np.array(seen.y[:, -1]), (times[rising.astype(bool)], states[rising.astype(bool)])


def integrated(
    mu: float, rest: Callable[[float], float], settle: float, longest: float
) -> tuple[float, float]:
    """Period, and logarithm of the multiplier, by DOP853 with the divergence beside it."""

    def rates(_t: float, y: Array) -> list[float]:
        x, v, _ = y
        return [v, mu * (1.0 - x * x) * v - rest(x), mu * (1.0 - x * x)]

    start = integrate(rates, [2.0, 0.0, 0.0], settle)[0]
    times, states = integrate(rates, start, longest, 0)[1]
    return float(times[1] - times[0]), float(states[1, 2] - states[0, 2])


@pytest.mark.parametrize(("mu", "settle"), [(0.1, 250.0), (1.0, 40.0), (10.0, 20.0)])
@pytest.mark.parametrize(
    ("rest", "force"), [("x", lambda x: x), ("x sin", math.sin)], ids=["van der Pol", "sine"]
)
def test_an_oscillators_cycle_has_the_period_and_the_multiplier_of_an_independent_integration(
    mu: float, settle: float, rest: str, force: Callable[[float], float]
) -> None:
    period, logarithm = integrated(mu, force, settle, 70.0 if mu == 10.0 else 25.0)

    (cycle,) = cycles_of(swinging(mu, rest), ORIGIN)

    assert cycle.period == pytest.approx(period, rel=1e-8)
    assert math.log(cycle.multipliers[0].real) == pytest.approx(logarithm, rel=1e-6)
    assert cycle.stability is Stability.STABLE
    assert not cycle.doubtful


@pytest.mark.parametrize("mu", [0.3, 3.0, 8.0])
def test_time_turned_round_keeps_the_cycle_and_inverts_its_multiplier(mu: float) -> None:
    program = swinging(mu, "x")
    field = program.field
    turned = tuple(Code(f"{code.text} neg") for code in field.formula or ())

    (ahead,) = cycles_of(program, ORIGIN)
    (behind,) = cycles_of(replace(program, field=replace(field, formula=turned)), ORIGIN)

    assert behind.stability is Stability.UNSTABLE
    assert behind.period == pytest.approx(ahead.period, rel=1e-9)
    logarithms = [math.log(cycle.multipliers[0].real) for cycle in (ahead, behind)]
    assert logarithms[1] == pytest.approx(-logarithms[0], rel=1e-6)
    # Its points are in the order of its own time: x' = -v.
    steps = np.diff(behind.points[:, 0])
    middle = 0.5 * (behind.points[1:, 1] + behind.points[:-1, 1])
    clear = np.abs(middle) > 0.1
    assert np.all((steps * middle < 0.0)[clear])
    assert np.all(np.diff(behind.times) > 0.0)
    assert (behind.times[0], behind.times[-1]) == pytest.approx((0.0, behind.period))


def test_van_der_pols_amplitude_is_the_published_one() -> None:
    (cycle,) = cycles_of(swinging(1.0, "x"), ORIGIN)

    # J. A. Zonneveld 1966, quoted by K. Urabe: amplitude and period for mu = 1.
    assert cycle.points[:, 0].max() == pytest.approx(2.00861986087, abs=1e-4)
    assert cycle.period == pytest.approx(6.66328685932, abs=1e-9)


def test_a_cycle_through_a_table_is_that_of_its_formula() -> None:
    (exact,) = cycles_of(swinging(1.0, "x"), ORIGIN)
    (through_table,) = cycles_of(tabulated(swinging(1.0, "x"), 65, 1e-6), ORIGIN)

    assert through_table.period == pytest.approx(exact.period, rel=1e-6)


@settings(max_examples=6, deadline=None)
@given(st.floats(0.01, 2.0))
def test_a_hopf_cycle_has_the_radius_and_multiplier_of_its_normal_form(mu: float) -> None:
    (cycle,) = cycles_of(turning(f"{mu!r} R sub"), ORIGIN)

    assert np.hypot(*cycle.points.T) == pytest.approx(math.sqrt(mu), abs=1e-8)
    assert cycle.period == pytest.approx(2.0 * math.pi, rel=1e-9)
    assert cycle.multipliers[0].real == pytest.approx(math.exp(-4.0 * math.pi * mu), rel=1e-6)


@settings(max_examples=4, deadline=None)
@given(st.floats(-1.0, -0.01))
def test_before_the_hopf_bifurcation_there_is_no_cycle(mu: float) -> None:
    assert cycles_of(turning(f"{mu!r} R sub"), point(0.0, 0.0, kind=PointKind.STABLE_FOCUS)) == ()


def test_three_nested_cycles_are_all_found() -> None:
    found = cycles_of(turning("R 0.25 sub 1 R sub mul R 2.25 sub mul"), ORIGIN)

    assert [c.stability for c in found] == [Stability.STABLE, Stability.UNSTABLE, Stability.STABLE]
    # g(s) = (s - 1/4) (1 - s) (s - 9/4); the multiplier at radius r is exp(2 pi * 2 r² g'(r²)).
    for cycle, radius, slope in zip(found, (0.5, 1.0, 1.5), (-1.5, 0.9375, -2.5), strict=True):
        assert np.hypot(*cycle.points.T) == pytest.approx(radius, abs=1e-8)
        logarithm = 4.0 * math.pi * radius**2 * slope
        assert math.log(cycle.multipliers[0].real) == pytest.approx(logarithm, rel=1e-6)


@pytest.mark.parametrize("width", [40.0, 4e3, 4e4])
def test_a_cycle_that_is_tiny_beside_the_domain_is_found(width: float) -> None:
    """Radius 1 in a domain that is 40 to 40,000 wide."""
    square = f"1 {R} sub tanh"
    states = tuple(state(name, -0.5 * width, 0.52 * width) for name in "xy")
    tiny = behavior("tiny", states, (f"x {square} mul y sub", f"y {square} mul x add"))

    [cycle] = cycles_of(tiny, ORIGIN)

    assert np.hypot(*cycle.points.T) == pytest.approx(1.0, rel=1e-4)
    assert cycle.multipliers[0].real == pytest.approx(math.exp(-4.0 * math.pi), rel=1e-3)


def test_cycles_are_found_where_the_field_is_a_million_times_slower_than_at_its_corners() -> None:
    """The median speed is that of the outskirts, where a polynomial of ninth order is huge."""
    squares = (0.01, 0.04, 0.12, 0.2)
    product = " ".join(f"{s} R sub" for s in squares) + " mul mul mul 90 mul"

    found = cycles_of(turning(product), ORIGIN)

    wanted = []
    for s in squares:
        slope = -90.0 * math.prod(other - s for other in squares if other != s)
        wanted.append((math.sqrt(s), math.exp(4.0 * math.pi * s * slope)))
    radii = [float(np.hypot(*cycle.points[0])) for cycle in found]
    values = [cycle.multipliers[0].real for cycle in found]
    assert sorted(zip(radii, values, strict=True)) == [pytest.approx(pair) for pair in wanted]


@pytest.mark.parametrize("side", ["R 1 sub 2 pow neg", "R 1 sub 2 pow"])
def test_a_cycle_that_attracts_from_one_side_only_is_semi_stable(side: str) -> None:
    (cycle,) = cycles_of(turning(side), ORIGIN)

    assert cycle.stability is Stability.SEMI_STABLE
    assert np.hypot(*cycle.points.T) == pytest.approx(1.0, abs=1e-4)
    assert cycle.multipliers[0].real == pytest.approx(1.0, abs=1e-3)


def test_a_semi_stable_cycle_splits_into_two_or_vanishes() -> None:
    two = cycles_of(turning("R 1 sub 2 pow 1e-6 sub"), ORIGIN)
    none = cycles_of(turning("R 1 sub 2 pow 1e-6 add"), ORIGIN)

    assert {c.stability for c in two} == {Stability.STABLE, Stability.UNSTABLE}
    radii = sorted(float(np.hypot(*c.points[0])) for c in two)
    assert radii == pytest.approx([math.sqrt(1.0 - 1e-3), math.sqrt(1.0 + 1e-3)], abs=1e-8)
    assert none == ()


def test_a_cycle_that_rays_cross_many_times_is_found() -> None:
    # The Hopf normal form in x and w = y - 1.5 sin(4 x): the circle becomes a curve with folds.
    w = "y 1.5 4 x mul sin mul sub"
    g = f"1 x x mul {w} 2 pow add sub"
    fx = f"x {g} mul {w} sub"
    fy = f"{w} {g} mul x add 6 4 x mul cos mul {fx} mul add"
    program = behavior("folded", (state("x", -2.0, 2.0), state("y", -4.0, 4.0)), (fx, fy))

    (cycle,) = cycles_of(program, ORIGIN)

    assert cycle.period == pytest.approx(2.0 * math.pi, rel=1e-8)
    assert math.log(cycle.multipliers[0].real) == pytest.approx(-4.0 * math.pi, rel=1e-5)


def test_orbits_around_a_center_are_no_cycles_and_a_note_says_so() -> None:
    center = point(0.0, 0.0, kind=PointKind.CENTER)
    for program in (OSCILLATOR, pendulum(0.0), tabulated(OSCILLATOR, 9, 1e-9)):
        found, notes = looked_for(program, center)
        assert found == ()
        assert any("every trajectory closes" in note for note in notes)


def driven_pendulum(torque: float, friction: float) -> Program:
    return behavior(
        "driven_pendulum",
        (state("angle", -math.pi, math.pi, kind=Kind.PERIODIC), state("rate", -6.0, 6.0)),
        ("rate", f"{torque!r} angle sin sub {friction!r} rate mul sub"),
    )


@pytest.mark.parametrize("torque", [1.5, 0.7, -0.7])
def test_a_pendulum_under_torque_runs_round_and_round(torque: float) -> None:
    def rates(_t: float, y: Array) -> list[float]:
        return [y[1], torque - math.sin(y[0]) - 0.3 * y[1]]

    times, _ = integrate(rates, [0.0, 4.0 * torque], 100.0, 0, lambda a: math.sin(0.5 * a))[1]
    period = float(np.diff(times)[-1])

    (cycle,) = cycles_of(driven_pendulum(torque, 0.3))

    assert cycle.turns == (int(math.copysign(1.0, torque)), 0)
    assert cycle.period == pytest.approx(period, rel=1e-7)
    # The divergence is -0.3 everywhere.
    assert cycle.multipliers[0].real == pytest.approx(math.exp(-0.3 * period), rel=1e-6)
    assert cycle.points[-1] - cycle.points[0] == pytest.approx(
        [2.0 * math.pi * cycle.turns[0], 0.0], abs=1e-9
    )


def test_a_cycle_through_a_jump_is_doubtful_and_judged_by_its_return_map() -> None:
    # A clock: x'' = -x - 0.2 x' + 0.5 sign(x'). From one rest to the next it loses the share that
    # it gains; the multiplier is exp(-0.1 T), while the divergence alone says exp(-0.2 T).
    clock = plane("y", "x neg 0.2 y mul sub 0.5 y sign mul add")

    (cycle,) = cycles_of(tightened(clock), ORIGIN)

    period = 2.0 * math.pi / math.sqrt(1.0 - 0.01)
    assert cycle.period == pytest.approx(period, rel=1e-6)
    assert cycle.doubtful
    assert cycle.cross_checked[0].real == pytest.approx(math.exp(-0.1 * period), rel=1e-2)
    assert cycle.stability is Stability.STABLE


def tightened(program: Program) -> Program:
    """The same over a domain that holds the clock's swing of about 3.2."""
    return behavior(
        "clock",
        (state("x", -6.0, 6.0), state("y", -6.0, 6.0)),
        tuple(code.text for code in program.field.formula or ()),
    )


def test_a_circle_without_fixed_points_is_one_cycle() -> None:
    program = behavior(
        "round", (state("x", 0.0, 2.0 * math.pi, kind=Kind.PERIODIC),), ("2 x sin add",)
    )

    (cycle,) = cycles_of(program)

    assert cycle.period == pytest.approx(2.0 * math.pi / math.sqrt(3.0), rel=1e-9)
    assert cycle.turns == (1,)
    assert cycle.multipliers == ()


SPACE = (state("x", -2.0, 2.0), state("y", -2.0, 2.0), state("z", -2.0, 2.0))


def test_a_cycle_in_three_dimensions_has_two_multipliers() -> None:
    program = behavior(
        "space", SPACE, (f"x 1 {R} sub mul y sub", f"y 1 {R} sub mul x add", "z neg x add")
    )

    (cycle,) = cycles_of(program, point(0.0, 0.0, 0.0))

    expected = [math.exp(-2.0 * math.pi), math.exp(-4.0 * math.pi)]
    assert [value.real for value in cycle.multipliers] == pytest.approx(expected, rel=1e-4)
    assert cycle.period == pytest.approx(2.0 * math.pi, rel=1e-9)
    assert not cycle.doubtful


def test_roesslers_cycle_turns_over_and_keeps_its_volume_law() -> None:
    program = behavior(
        "roessler",
        (state("x", -10.0, 10.0), state("y", -10.0, 10.0), state("z", -1.0, 20.0)),
        ("y z add neg", "x 0.2 y mul add", "0.2 z x 2.5 sub mul add"),
    )

    def rates(_t: float, y: Array) -> list[float]:
        return [-y[1] - y[2], y[0] + 0.2 * y[1], 0.2 + y[2] * (y[0] - 2.5), 0.2 + y[0] - 2.5]

    start = integrate(rates, [1.0, 1.0, 1.0, 0.0], 450.0)[0]
    times, states = integrate(rates, start, 20.0, 1)[1]
    volume = float(states[1, 3] - states[0, 3])

    (cycle,) = cycles_of(program)

    assert cycle.period == pytest.approx(times[1] - times[0], rel=1e-8)
    product = cycle.multipliers[0] * cycle.multipliers[1]
    assert math.log(product.real) == pytest.approx(volume, rel=1e-3)
    assert cycle.multipliers[0].real < -0.5  # on its way to period doubling
    assert cycle.stability is Stability.STABLE


def logistic(r: float) -> Program:
    return behavior("logistic", (state("x", -0.1, 1.1),), (f"{r!r} x mul 1 x sub mul",), every=0.5)


def lengths(found: tuple[Cycle, ...]) -> list[int]:
    """How many orbits there are of 2, 3, ... 8 steps."""
    steps = [len(cycle.points) - 1 for cycle in found]
    return [steps.count(k) for k in range(2, 9)]


def test_the_logistic_maps_cycle_of_two_has_its_closed_multiplier() -> None:
    (cycle,) = cycles_of(logistic(3.2))

    assert cycle.period == pytest.approx(1.0)
    assert cycle.multipliers[0].real == pytest.approx(4.0 + 2.0 * 3.2 - 3.2**2, rel=1e-8)
    assert cycle.stability is Stability.STABLE


def test_the_logistic_map_doubles_its_period() -> None:
    two, four = cycles_of(logistic(3.5))

    assert (two.stability, four.stability) == (Stability.UNSTABLE, Stability.STABLE)
    # Published values of the superstable neighbourhood (Strogatz 2015, section 10.2).
    assert sorted(four.points[:4, 0]) == pytest.approx([0.3828, 0.5009, 0.8269, 0.8750], abs=1e-4)


def test_the_logistic_map_at_four_has_every_orbit_that_it_must_have() -> None:
    found = cycles_of(logistic(4.0))

    # Moebius inversion of 2^k points; every multiplier is 2^k in size.
    assert lengths(found) == [1, 2, 3, 6, 9, 18, 30]
    for cycle in found:
        assert abs(cycle.multipliers[0]) == pytest.approx(2.0 ** (len(cycle.points) - 1), rel=1e-6)


def test_henons_map_has_the_published_number_of_orbits() -> None:
    found = cycles_of(henon(1.4, 0.3))

    # O. Biham, W. Wenzel, Phys. Rev. Lett. 63 (1989) 819, table I.
    assert lengths(found) == [1, 0, 1, 0, 2, 4, 7]
    for cycle in found:
        product = cycle.multipliers[0] * cycle.multipliers[1]
        assert product == pytest.approx((-0.3) ** (len(cycle.points) - 1), rel=1e-3)


def test_henons_map_settles_on_an_orbit_of_four() -> None:
    stable = [c for c in cycles_of(henon(1.0, 0.3)) if c.is_attracting]

    assert [len(cycle.points) - 1 for cycle in stable] == [4]


@pytest.mark.parametrize("damping", [1e-3, 1e-4, 1e-5, -1e-5])
def test_a_focus_that_hardly_attracts_or_repels_has_no_cycle(damping: float) -> None:
    assert cycles_of(plane("y", f"x neg {damping!r} y mul sub"), ORIGIN) == ()


def test_steps_of_half_a_turn_have_one_derivative_on_both_sides() -> None:
    """The angle goes on by pi + 0.3 sin(2 angle): 0, pi and pi/2, -pi/2 are orbits of two."""
    angle = state("angle", -math.pi, math.pi, kind=Kind.PERIODIC)
    step = f"angle {math.pi!r} add 0.3 angle 2 mul sin mul add"

    found = cycles_of(behavior("half_turn", (angle,), (step,), every=1.0))

    assert [c.multipliers[0].real for c in found] == pytest.approx([1.6**2, 0.4**2])
    assert not any(c.doubtful for c in found)


def test_a_rotation_by_a_quarter_is_a_continuum_of_orbits() -> None:
    program = behavior(
        "rotation", (state("x", 0.0, 1.0, kind=Kind.PERIODIC),), ("x 0.25 add",), every=1.0
    )

    found, notes = looked_for(program)

    assert found == ()
    assert any("whole stretch" in note for note in notes)
