"""Fixed points against closed forms: where they are, their eigenvalues, their type."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from runtime.program import Kind, Program
from tests.verifier.topology_scenes import (
    HOPF,
    OSCILLATOR,
    behavior,
    henon,
    line,
    linear,
    pendulum,
    plane,
    state,
    tabulated,
    van_der_pol,
)
from verifier.topology.features import FixedPoint, PointKind, Portrait
from verifier.topology.portrait import Detail, portrait
from verifier.topology.zeros.classification import classified

POINTS_ONLY = Detail(plane=129, line=1025, trajectories=0, cycles=False, separatrices=False)
COARSE = Detail(plane=65, trajectories=0, cycles=False, separatrices=False)
EIGENVALUES = 1e-7  # the runtime's differences are good to about 1e-9 of the field's rates


def seen(program: Program, detail: Detail = POINTS_ONLY) -> Portrait:
    return portrait(program, detail=detail)


def kinds(program: Program, detail: Detail = POINTS_ONLY) -> list[PointKind]:
    return [point.kind for point in seen(program, detail).fixed_points]


def only(program: Program) -> FixedPoint:
    (point,) = seen(program).fixed_points
    return point


@pytest.mark.parametrize(
    ("mu", "kind"),
    [
        (0.5, PointKind.UNSTABLE_FOCUS),
        (1.0, PointKind.UNSTABLE_FOCUS),
        (3.0, PointKind.UNSTABLE_NODE),
        (0.0, PointKind.CENTER),
    ],
)
def test_van_der_pol_has_the_origin_with_its_eigenvalues(mu: float, kind: PointKind) -> None:
    point = only(van_der_pol(mu))

    root = np.emath.sqrt(mu * mu / 4.0 - 1.0)
    expected = sorted([mu / 2.0 + root, mu / 2.0 - root], key=lambda z: (-z.real, -z.imag))
    assert point.at == pytest.approx([0.0, 0.0], abs=1e-12)
    assert point.kind is kind
    assert point.eigenvalues == pytest.approx(expected, abs=EIGENVALUES)


def test_eigenvalues_that_only_rounding_makes_complex_are_real() -> None:
    pair = (complex(1.0, 1e-9), complex(1.0, -1e-9))

    assert classified(pair, is_map=False, rate=1.0, doubt=0.0) is PointKind.UNSTABLE_NODE


def test_a_critically_damped_point_is_a_node_although_rounding_splits_its_eigenvalue() -> None:
    assert kinds(van_der_pol(2.0)) == [PointKind.UNSTABLE_NODE]


def test_a_wrapped_pendulum_rests_below_and_balances_above_once() -> None:
    above, below = seen(pendulum(0.3)).fixed_points

    assert above.at == pytest.approx([-math.pi, 0.0])
    assert above.kind is PointKind.SADDLE
    assert below.at == pytest.approx([0.0, 0.0])
    assert below.kind is PointKind.STABLE_FOCUS
    root = math.sqrt(1.0 + 0.15**2)
    assert above.eigenvalues == pytest.approx([-0.15 + root, -0.15 - root], abs=EIGENVALUES)
    swing = complex(-0.15, math.sqrt(1.0 - 0.15**2))
    assert below.eigenvalues == pytest.approx([swing, swing.conjugate()], abs=EIGENVALUES)


def test_saddles_on_the_border_of_a_domain_are_found_on_both_sides() -> None:
    found = seen(pendulum(0.3, Kind.CONTINUOUS)).fixed_points

    assert [float(p.at[0]) for p in found] == pytest.approx([-math.pi, 0.0, math.pi])
    assert [p.kind for p in found] == [PointKind.SADDLE, PointKind.STABLE_FOCUS, PointKind.SADDLE]


def test_a_frictionless_oscillator_is_a_center() -> None:
    assert only(OSCILLATOR).kind is PointKind.CENTER
    assert only(OSCILLATOR).eigenvalues == pytest.approx([1j, -1j], abs=EIGENVALUES)


@given(st.tuples(*[st.floats(-3.0, 3.0)] * 4))
@settings(max_examples=40, deadline=None)
def test_linear_fields_are_classified_by_trace_and_determinant(
    entries: tuple[float, float, float, float],
) -> None:
    a, b, c, d = entries
    trace, determinant = a + d, a * d - b * c
    discriminant = trace**2 - 4.0 * determinant
    assume(min(abs(trace), abs(determinant), abs(discriminant)) > 1e-2)

    (point,) = seen(linear(a, b, c, d), COARSE).fixed_points

    if determinant < 0.0:
        assert point.kind is PointKind.SADDLE
    else:
        shape = "node" if discriminant > 0.0 else "focus"
        assert point.kind == f"{'stable' if trace < 0.0 else 'unstable'} {shape}"


def test_every_one_of_fifteen_fixed_points_is_found() -> None:
    field = plane("y 0.9 6 x mul sin mul sub", "x 0.9 6 y mul sin mul sub")

    found = seen(field).fixed_points

    assert len(found) == 15
    for point in found:
        x, y = point.at
        assert y == pytest.approx(0.9 * math.sin(6.0 * x), abs=1e-9)
        assert x == pytest.approx(0.9 * math.sin(6.0 * y), abs=1e-9)


@pytest.mark.parametrize("field", [plane("x x mul", "y neg"), plane("y x x mul sub", "y")])
def test_a_double_zero_is_found_and_degenerate(field: Program) -> None:
    point = only(field)

    assert point.at == pytest.approx([0.0, 0.0], abs=1e-6)
    assert point.kind is PointKind.DEGENERATE


def test_a_triple_zero_is_degenerate_although_it_attracts() -> None:
    assert kinds(line("x x mul x mul neg")) == [PointKind.DEGENERATE]


def test_two_points_that_are_a_thousandth_apart_are_two() -> None:
    # x' = x² - 0.0005², which saddle and node share
    found = seen(plane("x x mul 2.5e-7 sub", "y neg")).fixed_points

    assert [float(p.at[0]) for p in found] == pytest.approx([-5e-4, 5e-4])
    assert [p.kind for p in found] == [PointKind.STABLE_NODE, PointKind.SADDLE]


def test_a_field_that_only_comes_near_zero_has_no_fixed_point() -> None:
    assert kinds(plane("x x mul 1e-6 add", "y neg")) == []


def test_a_jump_across_zero_is_no_fixed_point() -> None:
    assert kinds(plane("x 0.1 add sign neg", "y neg")) == []


def test_a_zero_at_the_edge_of_where_the_field_exists_has_no_eigenvalues() -> None:
    (edge,) = seen(plane("x sqrt", "y neg")).fixed_points

    assert edge.at == pytest.approx([0.0, 0.0], abs=1e-6)
    assert edge.kind is PointKind.DEGENERATE
    assert edge.eigenvalues == ()


@pytest.mark.parametrize(
    ("rate", "at"),
    [("1 x div 1 sub", 1.0), ("20 x mul sinh neg", 0.0), ("x 700 mul exp 1 sub neg", 0.0)],
)
def test_a_field_that_is_huge_elsewhere_keeps_the_types_that_are_proved(
    rate: str, at: float
) -> None:
    [found] = portrait(plane(rate, "y neg"), detail=POINTS_ONLY).fixed_points

    assert found.at == pytest.approx([at, 0.0], abs=1e-12)
    assert found.kind is PointKind.STABLE_NODE
    assert found.kind_proved


def test_a_line_of_fixed_points_is_sampled_and_said() -> None:
    found = seen(plane("x neg", "x y mul"))

    assert {p.kind for p in found.fixed_points} == {PointKind.DEGENERATE}
    assert all(abs(p.at[0]) < 1e-9 for p in found.fixed_points)
    assert len(found.fixed_points) < 40
    assert any("curve" in note for note in found.notes)


def test_a_field_that_never_moves_says_so() -> None:
    found = seen(plane("0", "0"))

    assert found.fixed_points == ()
    assert found.notes == ("x' and y' are zero throughout: every point is a fixed point",)


def test_on_a_line_the_sign_of_the_slope_decides() -> None:
    found = seen(line("x x x mul x mul sub")).fixed_points

    assert [float(p.at[0]) for p in found] == pytest.approx([-1.0, 0.0, 1.0], abs=1e-12)
    assert [p.kind for p in found] == [
        PointKind.STABLE_NODE,
        PointKind.UNSTABLE_NODE,
        PointKind.STABLE_NODE,
    ]
    assert [p.eigenvalues[0].real for p in found] == pytest.approx([-2.0, 1.0, -2.0])


@given(a=st.floats(0.3, 1.6), b=st.floats(0.1, 0.5))
@settings(max_examples=20, deadline=None)
def test_henon_has_its_two_fixed_points(a: float, b: float) -> None:
    left, right = seen(henon(a, b), COARSE).fixed_points

    for point, side in ((left, -1.0), (right, 1.0)):
        x = (b - 1.0 + side * math.sqrt((1.0 - b) ** 2 + 4.0 * a)) / (2.0 * a)
        assert point.at == pytest.approx([x, b * x], abs=1e-9)
        root = math.sqrt(a * a * x * x + b)
        assert point.eigenvalues == pytest.approx([-a * x + root, -a * x - root], abs=1e-6)
    # Closed form: the right one is stable while a < 3/4 (1 - b)²; the left one never is.
    assume(abs(a - 0.75 * (1.0 - b) ** 2) > 1e-3)
    assert left.kind is PointKind.SADDLE
    is_stable = a < 0.75 * (1.0 - b) ** 2
    assert right.kind is (PointKind.STABLE_NODE if is_stable else PointKind.SADDLE)


def test_a_map_that_rotates_and_shrinks_has_a_stable_focus() -> None:
    turn = (
        "x 0.6 mul y 0.6 mul sub",
        "x 0.6 mul y 0.6 mul add",
    )
    spiral = behavior("spiral", (state("x", -1.0, 1.0), state("y", -1.0, 1.0)), turn, every=1.0)

    assert kinds(spiral) == [PointKind.STABLE_FOCUS]


def test_a_map_that_only_rotates_has_a_center() -> None:
    turn = ("x 0.6 mul y 0.8 mul sub", "x 0.8 mul y 0.6 mul add")
    rotation = behavior("turn", (state("x", -1.0, 1.0), state("y", -1.0, 1.0)), turn, every=1.0)

    assert kinds(rotation) == [PointKind.CENTER]


def test_a_step_across_the_seam_is_no_fixed_point_of_a_periodic_map() -> None:
    # A step of two radians is one everywhere, also where it ends beyond the seam.
    state_ = state("angle", -math.pi, math.pi, kind=Kind.PERIODIC)

    assert kinds(behavior("turning", (state_,), ("angle 2 add",), every=1.0)) == []


def test_the_formulas_own_eigenvalues_stand_beside_the_tables() -> None:
    exact = seen(pendulum(0.3)).fixed_points
    table = seen(tabulated(pendulum(0.3), 33, 1e-5)).fixed_points

    assert [p.kind for p in table] == [p.kind for p in exact]
    for ours, theirs in zip(table, exact, strict=True):
        assert theirs.formula_eigenvalues is None
        assert ours.formula_eigenvalues == pytest.approx(theirs.eigenvalues, abs=1e-4)
        assert ours.eigenvalues == pytest.approx(theirs.eigenvalues, abs=1e-3)
        assert ours.at == pytest.approx(theirs.at, abs=1e-4)


def test_what_the_tables_error_leaves_open_the_formula_decides() -> None:
    weak = tabulated(linear(0.01, 1.0, -1.0, 0.01), 17, 2e-3)
    without = replace(weak, field=replace(weak.field, formula=None))

    assert kinds(weak) == [PointKind.UNSTABLE_FOCUS]
    assert kinds(without) == [PointKind.CENTER]


def test_a_near_miss_within_the_tables_error_is_a_degenerate_point() -> None:
    # The rate's least value is 1e-6; the table may be off by 1e-5.
    near_miss = tabulated(plane("x x mul 1e-6 add", "y neg"), 17, 1e-5)

    (point,) = seen(near_miss).fixed_points

    assert point.kind is PointKind.DEGENERATE
    assert point.at == pytest.approx([0.0, 0.0], abs=4e-3)  # within the root of the error


def test_the_cycle_around_a_focus_is_no_fixed_point() -> None:
    assert kinds(HOPF) == [PointKind.UNSTABLE_FOCUS]
