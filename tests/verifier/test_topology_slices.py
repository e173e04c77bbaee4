"""Slices: what may be an axis, what is held, and the portrait as JSON in the user's units."""

import json
import math
import subprocess
import sys

import pytest

from runtime.code import Code
from runtime.program import Kind, Role
from tests.verifier.topology_scenes import (
    CENTIMETRE,
    DEGREE,
    behavior,
    control,
    henon,
    line,
    pendulum,
    state,
    van_der_pol,
)
from verifier.topology.portrait import Detail, portrait
from verifier.topology.portrait_json import as_json
from verifier.topology.slices import SliceError, cut

SMALL = Detail(plane=65, line=257, trajectories=1)

LORENZ = behavior(
    "lorenz",
    (state("x", -20.0, 20.0), state("y", -20.0, 20.0), state("z", 0.0, 40.0, hold=10.0)),
    (
        "10 y x sub mul",
        "x rho z sub mul y sub",
        "x y mul 2.6666666666666665 z mul sub",
    ),
    (control("rho", 0.0, 40.0, 28.0),),
)


def test_the_first_two_driven_states_are_the_axes() -> None:
    assert [axis.name for axis in portrait(LORENZ, detail=SMALL).axes] == ["x", "y"]


def test_held_values_shape_the_slice() -> None:
    # With z held: x' = 10 (y - x), y' = (rho - z) x - y; a saddle while rho - z > 1.
    saddle = portrait(LORENZ, ("x", "y"), {"z": 10.0}, SMALL).fixed_points
    node = portrait(LORENZ, ("x", "y"), {"z": 10.0, "rho": 10.5}, SMALL).fixed_points

    assert [p.kind for p in saddle] == ["saddle"]
    assert [p.kind for p in node] == ["stable node"]


def test_a_point_that_is_fixed_in_the_slice_only_says_what_drifts() -> None:
    (origin,) = portrait(LORENZ, ("x", "y"), {"z": 10.0}, SMALL).fixed_points
    (true_origin,) = portrait(LORENZ, ("x", "y"), {"z": 0.0}, SMALL).fixed_points

    assert origin.drifts == ("z",)
    assert true_origin.drifts == ()


def test_a_behavior_with_one_state_gives_a_line() -> None:
    found = portrait(line("x neg"), detail=SMALL)

    assert [axis.name for axis in found.axes] == ["x"]
    assert found.field.rates.shape == (len(found.field.nodes[0]), 1)
    assert found.nullclines == ()


def test_a_sensed_state_moves_by_its_closure_if_it_has_one() -> None:
    states = (
        state("speed", -2.0, 2.0, role=Role.DRIVEN),
        state("gap", 0.0, 4.0, role=Role.SENSED, closure=Code("speed neg"), hold=2.0),
    )
    program = behavior("keep", states, ("gap 1 sub speed sub",))

    (point,) = portrait(program, detail=SMALL).fixed_points

    assert point.at == pytest.approx([0.0, 1.0])
    assert point.kind == "stable focus"  # λ² + λ + 1 = 0


def test_a_sensed_state_without_closure_is_held_and_the_driven_one_is_the_line() -> None:
    states = (
        state("speed", -2.0, 2.0, role=Role.DRIVEN),
        state("gap", 0.0, 4.0, role=Role.SENSED, hold=2.0),
    )
    program = behavior("keep", states, ("gap 1 sub speed sub",))

    (point,) = portrait(program, detail=SMALL).fixed_points
    (closer,) = portrait(program, None, {"gap": 0.5}, SMALL).fixed_points

    assert point.at == pytest.approx([1.0])
    assert closer.at == pytest.approx([-0.5])


@pytest.mark.parametrize(
    ("axes", "held", "message"),
    [
        (("x", "w"), {}, "no state variable is named 'w'; "),
        (("x", "x"), {}, "stands twice among the axes"),
        (("x", "y", "z", "w", "v"), {}, "one to four"),
        (("x", "y"), {"x": 1.0}, "'x' is an axis"),
        (("x", "y"), {"rhoo": 1.0}, "did you mean 'rho'"),
        (("x", "y"), {"rho": 41.0}, "'rho' must be in 0..40 1 (got 41)"),
    ],
)
def test_what_is_no_slice_is_refused_with_a_sentence(
    axes: tuple[str, ...], held: dict[str, float], message: str
) -> None:
    with pytest.raises(SliceError) as caught:
        cut(LORENZ, axes, held)

    assert message in str(caught.value)


def test_a_discrete_state_is_held_by_index_and_shown_by_name() -> None:
    gear = state("gear", 0.0, 1.0, kind=Kind.DISCRETE, role=Role.SENSED, values=("low", "high"))
    program = behavior("car", (state("v", 0.0, 4.0), gear), ("1 gear add v sub",))

    slow = as_json(portrait(program, None, {"gear": 0.0}, SMALL))
    fast = as_json(portrait(program, None, {"gear": 1.0}, SMALL))

    assert slow["held"] == {"gear": "low"}
    assert fast["held"] == {"gear": "high"}
    assert portrait(program, None, {"gear": 1.0}, SMALL).fixed_points[0].at == pytest.approx([2.0])
    with pytest.raises(SliceError, match="discrete"):
        cut(program, ("v", "gear"), {})


def test_json_is_in_the_users_units_and_eigenvalues_are_not_scaled() -> None:
    states = (
        state("bearing", -math.pi, math.pi, unit=DEGREE),
        state("range", 0.0, 4.0, unit=CENTIMETRE),
    )
    program = behavior("seek", states, ("0.5235987755982988 bearing sub", "1 range sub 2 mul"))

    record = as_json(portrait(program, detail=SMALL))

    (point,) = record["fixed_points"]
    assert record["axes"] == ["bearing", "range"]
    assert record["units"] == {"bearing": "deg", "range": "cm"}
    assert point["at"] == pytest.approx({"bearing": 30.0, "range": 100.0})
    assert point["kind"] == "stable node"
    assert point["eigenvalues"] == [
        pytest.approx([-1.0, 0.0], abs=1e-7),
        pytest.approx([-2.0, 0.0], abs=1e-7),
    ]


@pytest.mark.parametrize("program", [van_der_pol(), pendulum(), henon(), line("x neg"), LORENZ])
def test_json_can_be_written_and_read_by_any_reader(program: object) -> None:
    record = as_json(portrait(program, detail=SMALL))

    assert json.loads(json.dumps(record, allow_nan=False)) == record
    assert {"axes", "fixed_points", "held", "nullclines", "trajectories", "field"} <= set(record)


def test_numbers_need_no_drawing_library() -> None:
    code = (
        "import sys, verifier.topology.portrait, verifier.topology.portrait_json;"
        "print('matplotlib' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)

    assert done.stdout.strip() == "False"
