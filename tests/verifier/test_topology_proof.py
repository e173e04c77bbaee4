"""The proof against closed forms, a dense independent search, and what topology demands."""

import math
from itertools import product

import numpy as np
import pytest
import scipy.optimize
from hypothesis import given, settings
from hypothesis import strategies as st

from runtime.arrays import Array
from runtime.code import Code
from runtime.flow import Source
from runtime.interpolation import lookup, lookup_jacobian, tabulate
from runtime.intervals import Interval
from runtime.program import Field, Kind, Program, Term
from runtime.table import Axis, Method
from tests.verifier.topology_scenes import (
    behavior,
    control,
    henon,
    line,
    pendulum,
    plane,
    state,
    tabulated,
)
from verifier.topology.features import Completeness, FixedPoint, PointKind, Standing
from verifier.topology.portrait import Detail, portrait
from verifier.topology.slices import SliceError, cut
from verifier.topology.zeros.certificates import unstable_directions
from verifier.topology.zeros.proof import Proof, prove

POINTS_ONLY = Detail(plane=65, line=257, trajectories=0, cycles=False, separatrices=False)
FIFTEEN = plane("y 0.9 6 x mul sin mul sub", "x 0.9 6 y mul sin mul sub")
NAMES = ("x", "y", "z", "w")


def proof_of(program: Program, source: Source = Source.TABLES) -> Proof:
    axes = tuple(s.name for s in program.states if s.is_driven)
    return prove(cut(program, axes, {}), source=source)


def examined(program: Program) -> tuple[tuple[FixedPoint, ...], Completeness]:
    found = portrait(program, detail=POINTS_ONLY)
    return found.fixed_points, found.completeness


def lattice(m: int, span: float, kind: Kind = Kind.CONTINUOUS) -> Program:
    """A sin(pi x) over [-span, span]^m: zeros wherever all coordinates are whole numbers."""
    A = np.eye(m) + 0.4 * np.random.default_rng(m).uniform(-1.0, 1.0, (m, m))
    waves = [f"{math.pi!r} {name} mul sin" for name in NAMES[:m]]
    codes = [
        " ".join([f"{float(A[i, j])!r} {waves[j]} mul" for j in range(m)] + ["add"] * (m - 1))
        for i in range(m)
    ]
    states = tuple(state(name, -span, span, kind=kind) for name in NAMES[:m])
    return behavior("lattice", states, tuple(codes))


def random_field(seed: int, nodes: int, method: Method, *, periodic: bool) -> Program:
    """Two random rates over the unit square, or torus, through one table."""
    rng = np.random.default_rng(seed)
    kind = Kind.PERIODIC if periodic else Kind.CONTINUOUS
    axes = tuple(Axis(name, 0.0, 1.0, nodes, periodic) for name in "xy")
    table = tabulate(rng.standard_normal((nodes, nodes, 2)), axes, method)
    field = Field(
        driven=("x", "y"),
        form="grid",
        every=0.0,
        tables=(table,),
        terms=tuple(Term(k, Code("1"), 0, k) for k in range(2)),
        bounds=(),
        formula=None,
        origin="",
    )
    plain = behavior("random", tuple(state(n, 0.0, 1.0, kind=kind) for n in "xy"), ("0", "0"))
    return type(plain)(
        **{name: getattr(plain, name) for name in plain.__slots__} | {"field": field}
    )


def searched(program: Program, starts: int) -> Array:
    """Zeros of the program's table by Newton's method from a dense grid: an independent search."""
    (table,) = program.field.tables
    periodic = table.axes[0].periodic
    grid = (np.arange(starts) + 0.5) / starts
    x = np.stack(np.meshgrid(grid, grid, indexing="ij"), axis=-1).reshape(-1, 2)
    with np.errstate(all="ignore"):
        for _ in range(40):
            f, J = lookup(table, x), lookup_jacobian(table, x)
            fine = np.isfinite(f).all(axis=-1) & (np.abs(np.linalg.det(np.nan_to_num(J))) > 1e-9)
            x, f, J = x[fine], f[fine], J[fine]
            step = np.linalg.solve(J, f[..., None])[..., 0]
            x = x - np.clip(step, -0.05, 0.05)
            x = np.mod(x, 1.0) if periodic else x
    done = np.all(np.abs(lookup(table, x)) < 1e-11, axis=-1)
    return np.unique(np.round(x[done], 7), axis=0)


def apart(a: Array, b: Array, *, periodic: bool) -> Array:
    gap = np.abs(a[:, None] - b)
    return np.asarray((np.minimum(gap, 1.0 - gap) if periodic else gap).max(axis=-1))


def test_fifteen_zeros_through_a_table_are_proved_and_nothing_is_left_open() -> None:
    points, completeness = examined(tabulated(FIFTEEN, 65, 1e-4))

    assert len(points) == 15
    assert all(p.proved and p.kind_proved and p.standing is Standing.SHARED for p in points)
    assert completeness.complete
    assert completeness.about == "the tables"
    assert len(completeness.lost) == 0
    for point in points:
        formula = scipy.optimize.root(
            lambda z: [z[1] - 0.9 * math.sin(6 * z[0]), z[0] - 0.9 * math.sin(6 * z[1])], point.at
        )
        assert point.at == pytest.approx(formula.x, abs=1e-4)
        assert np.all(point.radius < 1e-11)


@pytest.mark.parametrize("periodic", [False, True])
@pytest.mark.parametrize("seed", range(4))
def test_a_dense_search_finds_no_zero_of_a_random_field_that_was_missed(
    seed: int,
    periodic: bool,  # noqa: FBT001 - a case
) -> None:
    program = random_field(seed, 9, Method.CUBIC, periodic=periodic)
    proof = proof_of(program)

    found = searched(program, 40)

    assert proof.complete
    assert len(found) > 5
    assert np.all(apart(found, proof.zeros, periodic=periodic).min(axis=1) < 1e-6)
    (table,) = program.field.tables
    assert np.all(np.abs(lookup(table, proof.zeros)) < 1e-9)


@given(seed=st.integers(0, 10**6))
@settings(max_examples=8, deadline=None)
def test_the_indices_on_a_torus_sum_to_nothing(seed: int) -> None:
    # Poincaré and Hopf: the sum is the Euler number of the torus, 0; a missed zero would show.
    proof = proof_of(random_field(seed, 6, Method.CUBIC, periodic=True))

    if proof.complete:
        J = 0.5 * (proof.slopes.low + proof.slopes.high)
        assert np.sum(np.sign(np.linalg.det(J))) == 0


@pytest.mark.parametrize("seed", range(3))
def test_zeros_of_linear_tables_are_found_in_each_cell(seed: int) -> None:
    program = random_field(seed, 7, Method.LINEAR, periodic=False)
    proof = proof_of(program)

    found = searched(program, 80)

    assert np.all(apart(found, proof.zeros, periodic=False).min(axis=1) < 1e-6)


@pytest.mark.parametrize(
    ("m", "span", "count", "zeros"),
    [(1, 2.0, 17, 5), (2, 2.0, 17, 25), (3, 1.5, 13, 27), (3, 2.0, 13, 125), (4, 1.0, 9, 81)],
)
def test_zeros_on_nodes_edges_corners_and_the_border_are_each_found_once(
    m: int, span: float, count: int, zeros: int
) -> None:
    # Every second or fourth node is a zero, those on the border included.
    proof = proof_of(tabulated(lattice(m, span), count, 1e-2))

    assert proof.complete
    assert len(proof.zeros) == zeros
    whole = np.arange(-math.floor(span), math.floor(span) + 1.0)
    expected = np.array(list(product(*[whole] * m)))
    gap = np.abs(proof.zeros[:, None] - expected).max(axis=-1)
    assert np.all(gap.min(axis=0) < 0.1)


@pytest.mark.parametrize("m", [1, 2, 3, 4])
def test_zeros_of_formulas_are_proved_without_tables(m: int) -> None:
    proof = proof_of(lattice(m, 1.5))

    assert proof.complete
    assert proof.about == "the formula"
    expected = np.array(list(product((-1.0, 0.0, 1.0), repeat=m)))
    assert len(proof.zeros) == len(expected)
    gap = np.abs(proof.zeros[:, None] - expected).max(axis=-1)
    assert np.all(gap.min(axis=0) < 1e-12)


def test_on_a_torus_a_zero_on_the_seam_counts_once() -> None:
    proof = proof_of(lattice(2, 1.0, Kind.PERIODIC))

    assert proof.complete
    assert proof.zeros == pytest.approx(np.array(list(product((-1.0, 0.0), repeat=2))), abs=1e-12)


@pytest.mark.parametrize(("shift", "zeros"), [(0.0, 1), (1e-9, 0), (-1e-9, 1)])
def test_a_zero_beyond_the_border_by_more_than_rounding_is_none(shift: float, zeros: int) -> None:
    # The zero lies at 2 + shift, the domain ends at 2.
    proof = proof_of(line(f"x {2.0 + shift!r} sub"))

    assert proof.complete
    assert len(proof.zeros) == zeros


def test_a_double_zero_is_one_small_undecided_box_with_a_point_in_it() -> None:
    (point,), completeness = examined(plane("x x mul", "y neg"))

    assert not point.proved
    assert point.kind is PointKind.DEGENERATE
    (box,) = completeness.undecided
    assert not completeness.complete
    assert np.all((box.low <= point.at) & (point.at <= box.high))
    assert np.all(box.high - box.low < 1e-4)


def test_boxes_cover_a_circle_of_zeros_beside_a_point_that_is_proved() -> None:
    # Zeros: the unit circle, and (0, 1.5).
    circle = "x x mul y y mul add 1 sub"
    proof = proof_of(plane(f"{circle} x mul", f"{circle} y 1.5 sub mul"))

    assert [tuple(z) for z in proof.zeros] == [pytest.approx((0.0, 1.5), abs=1e-12)]
    assert not proof.complete
    for angle in np.linspace(0.0, math.tau, 100):
        at = np.array([math.cos(angle), math.sin(angle)])
        assert any(np.all((b.low - 1e-9 <= at) & (at <= b.high + 1e-9)) for b in proof.undecided)


@pytest.mark.parametrize("gap", [1e-2, 1e-4])
def test_a_saddle_and_a_node_about_to_meet_are_two(gap: float) -> None:
    points, completeness = examined(plane(f"x x mul {gap * gap!r} sub", "y neg"))

    assert [p.at[0] for p in points] == pytest.approx([-gap, gap])
    assert [p.kind for p in points] == [PointKind.STABLE_NODE, PointKind.SADDLE]
    assert all(p.kind_proved for p in points)
    assert completeness.complete


def test_zeros_that_a_coarse_table_invents_are_named_and_those_it_lacks_too() -> None:
    # Between nodes 0.4 apart, a spline through a steep step swings about zero.
    step = plane("x 12 mul tanh 1.02 sub", "y neg")
    points, completeness = examined(tabulated(step, 11, 0.3))

    assert proof_of(step).complete
    assert len(proof_of(step).zeros) == 0
    invented = [p for p in points if p.standing is Standing.INVENTED]
    assert invented
    assert all(p.proved for p in invented)
    assert len(completeness.lost) == 0

    waves = tabulated(plane("8 x mul sin", "y neg"), 6, 1.0)
    points, completeness = examined(waves)
    shared = sum(p.standing is Standing.SHARED for p in points)
    assert shared + len(completeness.lost) == 2 * math.floor(16.0 / math.pi) + 1
    assert len(completeness.lost) > 0


def test_the_type_is_proved_only_where_bounds_decide_it() -> None:
    (center,), _ = examined(plane("y", "x neg"))
    (focus,), _ = examined(plane("y x 1e-9 mul sub", "x neg"))

    assert center.proved
    assert not center.kind_proved
    assert proof_of(plane("y x 1e-9 mul sub", "x neg")).unstable == (0,)
    assert focus.proved


@given(a=st.floats(0.3, 1.6), b=st.floats(0.1, 0.5))
@settings(max_examples=20, deadline=None)
def test_fixed_points_of_maps_are_proved_with_their_multipliers(a: float, b: float) -> None:
    proof = proof_of(henon(a, b))

    assert proof.complete
    expected = []
    for side in (-1.0, 1.0):
        x = (b - 1.0 + side * math.sqrt((1.0 - b) ** 2 + 4.0 * a)) / (2.0 * a)
        grown = np.abs(np.linalg.eigvals([[-2.0 * a * x, 1.0], [b, 0.0]]))
        expected.append((pytest.approx([x, b * x], abs=1e-12), int(np.sum(grown > 1.0))))
        if np.any(np.abs(grown - 1.0) < 1e-9):
            return
    assert list(zip(map(list, proof.zeros), proof.unstable, strict=True)) == expected


def test_steps_around_a_circle_are_taken_the_short_way() -> None:
    # angle + 2 pi + 0.3 sin(angle) stays at 0 and at pi, on the seam; 2 moves everything on.
    circle = (state("angle", -math.pi, math.pi, kind=Kind.PERIODIC),)
    still = behavior("c", circle, (f"angle {math.tau!r} add 0.3 angle sin mul add",), every=1.0)
    turning = behavior("c", circle, ("angle 2 add",), every=1.0)

    found = proof_of(still)
    assert found.complete
    assert np.ravel(found.zeros) == pytest.approx([-math.pi, 0.0], abs=1e-12)
    assert found.unstable == (0, 1)
    assert proof_of(turning).complete
    assert len(proof_of(turning).zeros) == 0


@pytest.mark.parametrize("distance", [1e-2, 1e-3, 2.5e-4, 1e-5, 1e-7])
def test_zeros_close_to_a_fold_are_as_sharp_as_others(distance: float) -> None:
    # x' = a - x²: rounding of a moves the zeros by eps / (2 sqrt(a)).
    program = behavior("fold", (state("x", -2.0, 2.0),), (f"{distance!r} x x mul sub",))

    proof = proof_of(program)

    assert np.ravel(proof.zeros) == pytest.approx([-math.sqrt(distance), math.sqrt(distance)])
    assert np.all(proof.radii <= 1e-15 / math.sqrt(distance))


def test_for_an_interval_of_controls_each_value_has_its_zero_within_the_radius() -> None:
    # x' = a - x², y' = -y: zeros at ±sqrt(a).
    program = behavior(
        "fold",
        (state("x", -2.0, 2.0), state("y", -1.0, 1.0)),
        ("a x x mul sub", "y neg"),
        (control("a", -1.0, 2.0, 1.0),),
    )
    view = cut(program, None, {})

    proof = prove(view, np.array([[0.9], [1.1]]))

    assert proof.complete
    assert proof.unstable == (1, 0)
    for at, radius, side in zip(proof.zeros, proof.radii, (-1.0, 1.0), strict=True):
        for a in (0.9, 1.0, 1.1):
            assert abs(side * math.sqrt(a) - at[0]) <= radius[0]
        assert radius[0] < 0.2
    across = prove(view, np.array([[-0.1], [0.1]]))
    assert not across.complete
    assert prove(view, np.array([[-1.0], [-0.1]])).complete


def test_a_zero_that_leaves_the_domain_as_controls_change_is_undecided() -> None:
    line = behavior("line", (state("x", -2.0, 2.0),), ("x a sub",), (control("a", 0.0, 4.0, 1.0),))
    view = cut(line, None, {})

    for low, high, count, complete in (
        (1.0, 2.0, 1, True),
        (1.9, 2.1, 0, False),
        (2.1, 2.2, 0, True),
    ):
        found = prove(view, np.array([[low], [high]]))

        assert (len(found.zeros), found.complete) == (count, complete)
        assert len(found.undecided) == (not complete)


@pytest.mark.parametrize("second", [(), ("y neg",)])
def test_a_zero_that_a_jump_on_the_seam_skips_is_none(second: tuple[str, ...]) -> None:
    """At the upper end of the circle the rate would be 0; but that is the lower end, where it is
    2 pi."""
    states = (state("angle", -math.pi, math.pi, kind=Kind.PERIODIC), state("y", -1.0, 1.0))
    skipped = behavior("skipped", states[: 1 + len(second)], (f"{math.pi!r} angle sub", *second))
    kept = behavior("kept", states[: 1 + len(second)], (f"{math.pi!r} angle add", *second))

    for program, count in ((skipped, 0), (kept, 1)):
        found = prove(cut(program, None, {}))
        assert (len(found.zeros), found.complete) == (count, True)


def test_controls_may_weigh_and_span_tables() -> None:
    # x' = (a - x) through a table over x and a; b weighs it.
    table_axes = (Axis("x", -2.0, 2.0, 9, periodic=False), Axis("a", -1.0, 1.0, 5, periodic=False))
    x, a = np.meshgrid(np.linspace(-2, 2, 9), np.linspace(-1, 1, 5), indexing="ij")
    plain = behavior(
        "goal",
        (state("x", -2.0, 2.0),),
        ("b a x sub mul",),
        (control("a", -1.0, 1.0, 0.5), control("b", 0.5, 2.0, 1.0)),
    )
    table = tabulate((a - x)[..., None], table_axes, Method.CUBIC)
    field = Field(("x",), "grid", 0.0, (table,), (Term(0, Code("b"), 0, 0),), (), None, "")
    view = cut(
        type(plain)(**{n: getattr(plain, n) for n in plain.__slots__} | {"field": field}), None, {}
    )

    point = prove(view)
    interval = prove(view, np.array([[0.4, 0.5], [0.6, 2.0]]))

    assert point.zeros[0] == pytest.approx([0.5], abs=1e-12)
    assert point.radii[0, 0] < 1e-12
    assert interval.complete
    assert interval.unstable == (0,)
    assert abs(interval.zeros[0, 0] - 0.5) + 0.1 <= interval.radii[0, 0] + 1e-12


@given(st.lists(st.floats(-3.0, 3.0), min_size=9, max_size=9), st.booleans())
@settings(max_examples=80, deadline=None)
def test_the_number_of_growing_directions_is_that_of_numpys_eigenvalues(
    entries: list[float],
    is_map: bool,  # noqa: FBT001 - a case
) -> None:
    J = np.reshape(entries, (1, 3, 3))
    for m in (1, 2, 3):
        part = J[:, :m, :m]
        (found,) = unstable_directions(Interval(part - 1e-13, part + 1e-13), is_map=is_map)
        values = np.linalg.eigvals(part[0])
        margin = np.abs(values) - 1.0 if is_map else values.real
        if found is not None and np.min(np.abs(margin)) > 1e-4:
            assert found == np.sum(margin > 0.0)
        if np.min(np.abs(margin)) > 0.05:
            assert found is not None


def test_a_pendulum_through_a_table_has_its_zeros_on_the_seam_and_below() -> None:
    points, completeness = examined(tabulated(pendulum(0.3), 33, 1e-5))

    assert [p.at[0] for p in points] == pytest.approx([-math.pi, 0.0], abs=1e-9)
    assert completeness.complete
    assert all(p.standing is Standing.SHARED and p.kind_proved for p in points)


def test_four_axes_have_a_proof_but_no_portrait() -> None:
    program = lattice(4, 0.9)

    assert len(prove(cut(program, NAMES, {})).zeros) == 1
    with pytest.raises(SliceError, match="one to three"):
        portrait(program, NAMES)
