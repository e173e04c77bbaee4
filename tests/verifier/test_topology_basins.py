"""Basins against closed forms, symmetry and an independent integration."""

import numpy as np
import pytest

from runtime.arrays import Array
from runtime.program import Program
from tests.verifier.test_topology_manifolds import duffing
from tests.verifier.topology_scenes import (
    HOPF,
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
from verifier.topology.features import Basins, PointKind, Portrait
from verifier.topology.portrait import Detail, portrait


def shown(program: Program, cells: int) -> Portrait:
    return portrait(program, detail=Detail(plane=129, trajectories=0, basins=cells))


def basins(program: Program, cells: int = 30) -> Basins:
    found = shown(program, cells).basins
    assert found is not None
    return found


def test_the_two_basins_of_duffing_mirror_each_other() -> None:
    found = basins(duffing(0.2))

    left, right = found.attractors
    assert left.share == right.share
    turned = found.labels[::-1, ::-1]
    assert np.array_equal(found.labels == 0, turned == 1)
    assert np.array_equal(found.labels == -1, turned == -1)
    assert left.share + right.share + found.leaves + found.open == pytest.approx(1.0)


def test_the_basins_of_duffing_agree_with_an_independent_integration() -> None:
    def field(z: Array) -> Array:
        return np.stack([z[1], z[0] - z[0] ** 3 - 0.2 * z[1]])

    found = shown(duffing(0.2), 40)
    assert found.basins is not None
    z = np.stack(np.meshgrid(*found.basins.centres, indexing="ij"))
    inside = np.ones(z.shape[1:], dtype=bool)
    h = 0.02
    for _ in range(4000):
        k1 = field(z)
        k2 = field(z + 0.5 * h * k1)
        k3 = field(z + 0.5 * h * k2)
        z = z + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + field(z + h * k3))
        inside &= np.all(np.abs(z) <= 2.0, axis=0)
        z = np.where(inside, z, 0.0)
    goes_to = np.array([found.fixed_points[a.index].at[0] for a in found.basins.attractors])
    labels = found.basins.labels
    assert np.array_equal(labels == -1, ~inside)
    assert goes_to[labels[inside]] == pytest.approx(z[0][inside], abs=1e-2)


def test_a_weakly_damped_pendulum_takes_everything_that_stays_slow_enough() -> None:
    found = shown(pendulum(0.01), 40)

    assert found.basins is not None
    (down,) = found.basins.attractors
    assert found.fixed_points[down.index].kind is PointKind.STABLE_FOCUS
    # The rest is carried over the border of 4 rad/s by gravity, on its way down.
    assert found.basins.open == 0.0
    assert down.share > 0.9


def test_all_of_a_stable_linear_field_goes_to_its_node() -> None:
    (node,) = basins(linear(-1.0, 0.0, 0.0, -2.0)).attractors

    assert node.share == 1.0


def test_on_a_line_each_half_goes_to_its_own_point() -> None:
    found = basins(line("x x x mul x mul sub"), 100)

    assert [a.share for a in found.attractors] == [0.5, 0.5]
    assert np.all(found.labels[:50] == 0)
    assert np.all(found.labels[50:] == 1)


def test_what_comes_to_a_half_stable_point_is_its_basin() -> None:
    # x' = x²: from below to 0, from above away.
    found = basins(line("x x mul"), 100)

    (half,) = found.attractors
    assert half.share == 0.5
    assert found.leaves == 0.5


def test_a_cycle_has_a_basin() -> None:
    found = basins(HOPF)

    (cycle,) = found.attractors
    assert cycle.is_cycle
    assert cycle.share == 1.0


def test_the_basin_of_van_der_pols_cycle_is_all_that_does_not_leave() -> None:
    found = basins(van_der_pol(1.0))

    (cycle,) = found.attractors
    assert cycle.is_cycle
    assert cycle.share + found.leaves == pytest.approx(1.0)


def test_a_semi_stable_cycle_takes_one_side_and_the_point_within_the_other() -> None:
    # r' = -r (1 - r²)², one turn in 2 pi seconds.
    factor = "1 x x mul sub y y mul sub 2 pow neg"
    found = basins(plane(f"{factor} x mul y sub", f"{factor} y mul x add"), 64)

    assert [a.is_cycle for a in found.attractors] == [False, True]
    radius = np.hypot(*np.meshgrid(*found.centres, indexing="ij"))
    # At half the width of the tube round the cycle, on the side where it repels, some are left.
    assert np.abs(radius - 1.0).min() < 0.008
    assert np.array_equal(found.labels == 1, radius > 1.0)
    assert found.open < 0.001


def test_a_center_that_attracts_beyond_its_linearisation_is_an_attractor() -> None:
    square = "x x mul y y mul add"
    found = basins(plane(f"y {square} x mul sub", f"x neg {square} y mul sub"))

    (focus,) = found.attractors
    assert focus.share == 1.0


def test_a_center_has_no_basin() -> None:
    field = behavior(
        "center", (state("x", -2.0, 4.0), state("y", -2.0, 2.0)), ("y", "x 1 x sub mul neg")
    )

    assert shown(field, 40).basins is None


def test_a_saddle_alone_has_no_basin() -> None:
    assert shown(linear(1.0, 0.0, 0.0, -1.0), 20).basins is None


def test_nobody_who_does_not_ask_pays_for_basins() -> None:
    assert shown(HOPF, 0).basins is None


def test_a_table_has_the_basins_of_its_formula() -> None:
    exact, table = basins(duffing(0.2)), basins(tabulated(duffing(0.2), 129, 1e-5))

    assert np.mean(exact.labels == table.labels) > 0.995


def test_basins_of_a_map_are_those_of_its_points() -> None:
    # x -> 1.5 x - 0.5 x³ has the attractors -1 and 1; from |x| > sqrt(5) it would leave.
    cubic = behavior(
        "cubic", (state("x", -2.0, 2.0),), ("1.5 x mul 0.5 x x mul x mul mul sub",), every=1.0
    )
    found = basins(cubic, 200)

    assert len(found.attractors) == 2
    assert [a.share for a in found.attractors] == [0.5, 0.5]
    for centre, label in zip(found.centres[0], found.labels, strict=True):
        x = float(centre)
        for _ in range(500):
            x = 1.5 * x - 0.5 * x**3
        assert x == pytest.approx((-1.0, 1.0)[int(label)], abs=1e-3)


def test_the_basin_of_henons_stable_point_agrees_with_its_iterates() -> None:
    found = basins(henon(a=0.3), 40)

    (point,) = found.attractors
    assert 0.05 < point.share < 0.95
    for i, j in np.random.default_rng(1).integers(0, 40, (60, 2)):
        x, y = float(found.centres[0][i]), float(found.centres[1][j])
        for _ in range(300):
            if not (abs(x) <= 4.0 and abs(y) <= 2.0):
                break
            x, y = 1.0 - 0.3 * x * x + y, 0.3 * x
        stays = abs(x) <= 4.0 and abs(y) <= 2.0
        assert found.labels[i, j] == (0 if stays else -1)


def test_in_three_axes_basins_are_cubes() -> None:
    bistable = behavior(
        "bistable",
        (state("x", -2.0, 2.0), state("y", -2.0, 2.0), state("z", -2.0, 2.0)),
        ("x x x mul x mul sub", "y neg", "x z sub"),
    )
    found = portrait(bistable, ("x", "y", "z"), detail=Detail(basins=10, trajectories=0)).basins

    assert found is not None
    assert found.labels.shape == (10, 10, 10)
    assert [a.share for a in found.attractors] == [0.5, 0.5]
    assert np.all(found.labels[:5] == 0)
