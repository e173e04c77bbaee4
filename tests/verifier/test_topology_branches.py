"""Bifurcation diagrams against closed forms (Strogatz 2015, chapters 3 and 8)."""

import numpy as np
import pytest

from runtime.program import Program
from tests.verifier.claim_scenes import CROSS, FOLD, FORK, MIRROR, MU, ONSET, TWO_CYCLES, X
from tests.verifier.topology_scenes import behavior, control, state
from verifier.topology.branches.branching import find_branches
from verifier.topology.branches.continuation import Branches, Change
from verifier.topology.features import PointKind
from verifier.topology.slices import SliceError


def diagram(program: Program, samples: int = 11) -> Branches:
    return find_branches(program, "mu", {}, samples=samples)


@pytest.mark.parametrize(
    ("program", "value", "change"),
    [
        (FOLD, 0.2, Change.SADDLE_NODE),
        (FORK, -0.1, Change.PITCHFORK),
        (ONSET, -0.15, Change.HOPF),
        (CROSS, 0.3, Change.TRANSCRITICAL),
        (MIRROR, 0.0, Change.TRANSCRITICAL),
    ],
    ids=["saddle-node", "pitchfork", "Hopf", "transcritical", "transcritical, symmetric"],
)
def test_a_bifurcation_is_located_and_named(program: Program, value: float, change: Change) -> None:
    [found] = diagram(program).bifurcations

    assert found.change is change
    assert abs(found.value - value) <= max(found.within, 1e-6) <= 1e-4
    assert np.abs(found.at).max() < 0.02


@pytest.mark.parametrize("program", [CROSS, MIRROR], ids=["plain", "symmetric"])
def test_branches_that_cross_exchange_their_stability(program: Program) -> None:
    for branch in diagram(program).points:
        assert len(branch.values) > 11
        assert {branch.kinds[0], branch.kinds[-1]} == {
            PointKind.STABLE_NODE,
            PointKind.UNSTABLE_NODE,
        }
        slope = np.diff(branch.points[:, 0]) / np.diff(branch.values)
        assert slope == pytest.approx(np.full(len(slope), slope[0]), abs=1e-5)


def test_points_that_run_after_one_another_do_not_meet() -> None:
    # x' = (x - mu)(x - mu - 0.1): in a fifth of mu each comes past the other's old place.
    program = behavior("train", (X,), ("x mu sub x mu sub 0.1 sub mul",), (MU,))

    found = diagram(program)

    assert not found.bifurcations
    assert sorted(set(branch.kinds) == {branch.kinds[0]} for branch in found.points) == [True, True]


def test_a_fold_of_cycles_is_no_end_of_one() -> None:
    # r' = mu r + r³ - r⁵: two cycles from mu = -1/4 on, of which the inner one ends at 0.
    found = find_branches(TWO_CYCLES, "mu", {}, samples=5)

    assert [one.change for one in found.bifurcations] == [Change.CYCLES_MEET, Change.HOPF]
    assert [one.value for one in found.bifurcations] == pytest.approx([-0.25, 0.0], abs=1e-3)


def test_branches_follow_the_roots() -> None:
    stable, unstable = sorted(
        diagram(FOLD).points, key=lambda branch: branch.kinds[-1] is PointKind.UNSTABLE_NODE
    )

    for branch, sign in ((stable, 1.0), (unstable, -1.0)):
        assert branch.points[:, 0] == pytest.approx(sign * np.sqrt(branch.values - 0.2), abs=1e-7)
        assert branch.values[0] == pytest.approx(0.2, abs=1e-5)
        assert branch.values[-1] == 1.0
        assert np.all(np.diff(branch.values) > 0.0)


def test_a_cycle_grows_with_the_root_of_the_distance_to_its_onset() -> None:
    found = diagram(ONSET)

    [cycle] = found.cycles
    assert cycle.highs[:, 0] == pytest.approx(np.sqrt(cycle.values + 0.15), rel=2e-3)
    assert cycle.periods == pytest.approx(2.0 * np.pi, rel=1e-6)
    [point] = found.points
    before = point.values < -0.15
    assert {kind for kind, b in zip(point.kinds, before, strict=True) if b} == {
        PointKind.STABLE_FOCUS
    }


def test_a_map_doubles_its_period() -> None:
    # The logistic map r x (1 - x): at r = 3 the fixed point 1 - 1/r loses its stability,
    # at 1 + sqrt(6) the cycle of two (Strogatz 2015, section 10.3).
    program = behavior(
        "logistic",
        (state("x", 0.05, 0.95),),
        ("mu x mul 1 x sub mul",),
        (control("mu", 2.5, 3.52, 3.0),),
        every=1.0,
    )

    found = find_branches(program, "mu", {}, samples=7)

    assert {one.change for one in found.bifurcations} == {Change.PERIOD_DOUBLING}
    first, second = (one.value for one in found.bifurcations)
    assert first == pytest.approx(3.0, abs=1e-6)
    assert second == pytest.approx(1.0 + np.sqrt(6.0), abs=1e-3)


def test_what_can_not_be_followed_is_said() -> None:
    with pytest.raises(SliceError, match="no control is named 'nu'"):
        find_branches(FOLD, "nu", {})
    with pytest.raises(SliceError, match="can't be held"):
        find_branches(FOLD, "mu", {"mu": 0.1})
    with pytest.raises(SliceError, match=r"within -1\.\.1"):
        find_branches(FOLD, "mu", {}, (-3.0, 0.5))
