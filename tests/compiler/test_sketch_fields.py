"""Sketches: the compiled field has what was drawn, and what cannot be drawn is refused."""

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from compiler.check import check, check_behavior
from compiler.compile import compile_loaded
from compiler.compile_file import compile_file
from compiler.sketch.graphs import graph_through
from compiler.sketch.index import Ground, Item, completed, index_of
from compiler.sketch.pacing import timed_paces
from compiler.sketch.polygons import encloses
from compiler.sketch.ridges import ridge_through
from runtime.flow import flow_of, rates
from runtime.integrators import adaptive
from runtime.program import Program
from spec_schema.behavior import BehaviorSpec
from spec_schema.diagnostics import SpecError
from spec_schema.expressions.tree import Number
from spec_schema.load import load_source
from spec_schema.source import Source
from verifier.topology.features import PointKind, Stability
from verifier.topology.portrait import Detail, portrait

QUICK = Detail(plane=65, trajectories=0, separatrices=False, basins=0)
HEAD = """specc: 1
kind: behavior
name: drawn
state:
  x: {unit: m, domain: [-2, 2], role: both, relates: {agent: base, environment: room}}
  y: {unit: m, domain: [-2, 2], role: both, relates: {agent: base, environment: room}}
field:
  sketch:
    over: [x, y]
"""
HALF = Number(1.0)


def drawn(features: str) -> Program:
    loaded = load_source(Source("spec.yaml", HEAD + features))
    return compile_loaded(loaded, lambda _what, _done, _of: None).program


@pytest.fixture(scope="module")
def patrol() -> Program:
    return compile_file(Path("specs/patrol_sketch.yaml"), lambda *_: None).program


def test_two_attractors_and_the_saddle_between_stand_where_they_were_drawn() -> None:
    program = drawn(
        "    points:\n"
        "      - {is: attractor, at: [-1, 0.2]}\n"
        "      - {is: attractor, at: [1, -0.2], rates: 2}\n"
        "      - {is: saddle, at: [0.1, 0], rates: [1, 0.5]}\n"
    )

    seen = portrait(program, detail=QUICK)

    assert seen.completeness.complete
    found = sorted((tuple(p.at), p.kind) for p in seen.fixed_points)
    assert [kind for _, kind in found].count(PointKind.SADDLE) == 1
    assert np.allclose([at for at, _ in found], [(-1, 0.2), (0.1, 0), (1, -0.2)], atol=2e-3)
    saddle = next(p for p in seen.fixed_points if p.kind is PointKind.SADDLE)
    assert np.allclose(sorted(value.real for value in saddle.eigenvalues), [-1, 0.5], atol=5e-3)


def test_nested_orbits_have_their_periods_and_shrink_by_their_strength() -> None:
    program = drawn(
        "    orbits:\n"
        "      - {through: [[0.5, 0], [0, 0.5], [-0.5, 0], [0, -0.5]], period: 3}\n"
        "      - {through: [[1, 0], [0, 1], [-1, 0], [0, -1]], period: 4, attracts: false}\n"
        "      - {through: [[1.5, 0], [0, 1.6], [-1.5, 0], [0, -1.5]], period: 5}\n"
    )

    seen = portrait(program, detail=QUICK)

    assert [point.kind for point in seen.fixed_points] == [PointKind.UNSTABLE_FOCUS]
    cycles = sorted(seen.cycles, key=lambda cycle: cycle.period)
    assert [c.stability for c in cycles] == [
        Stability.STABLE,
        Stability.UNSTABLE,
        Stability.STABLE,
    ]
    for cycle, period, sign in zip(cycles, (3, 4, 5), (-1, 1, -1), strict=True):
        assert cycle.period == pytest.approx(period, rel=2e-3)
        assert cycle.multipliers[0].real == pytest.approx(math.exp(sign * period), rel=2e-2)


def test_two_attracting_orbits_have_a_repelling_one_between() -> None:
    program = drawn(
        "    orbits:\n"
        "      - {through: [[0.6, 0], [0, 0.5], [-0.5, 0], [0, -0.5]], period: 3}\n"
        "      - {through: [[1.5, 0], [0, 1.6], [-1.5, 0], [0, -1.5]], period: 5}\n"
    )

    required = [claim.text for claim in program.claims if "required" in claim.text]
    kinds = [c.stability for c in portrait(program, detail=QUICK).cycles]

    assert len(required) == 2
    assert sorted(kinds) == [Stability.STABLE, Stability.STABLE, Stability.UNSTABLE]


@given(
    x1=st.floats(0.5, 1.5),
    x2=st.floats(-1.5, -0.5),
    v1=st.floats(0.2, 0.8),
    v2=st.floats(0.2, 0.8),
)
@settings(max_examples=12, deadline=None)
def test_the_sketched_patrol_keeps_its_period_law(
    patrol: Program, x1: float, x2: float, v1: float, v2: float
) -> None:
    law = (x1 - x2) / v1 + (x1 - x2) / v2 + 2.0
    start = np.array([[(x1 + x2) / 2, v1]])
    times = np.linspace(0.0, 1.2 * law, 4_001)

    x = adaptive(flow_of(patrol), start, np.array([[x1, x2, v1, v2]]), times, 1e-9, 1e-9).states[0]

    up = (x[:-1, 0] < start[0, 0]) & (x[1:, 0] >= start[0, 0]) & (x[1:, 1] > 0.0)
    assert times[1:][up][-1] == pytest.approx(law, rel=0.05)
    assert x[:, 1].max() == pytest.approx(v1, abs=0.02 * (v1 + v2))
    assert x[:, 1].min() == pytest.approx(-v2, abs=0.02 * (v1 + v2))


def test_along_an_edge_the_patrol_moves_as_fast_as_it_says(patrol: Program) -> None:
    found = rates(flow_of(patrol), np.array([[0.0, 0.5]]), np.array([[1.2, -1.2, 0.5, 0.5]]))

    assert found[0] == pytest.approx([0.5, 0.0], rel=0.06, abs=5e-3)


def test_what_index_theory_adds_is_named_with_its_reason() -> None:
    loaded = load_source(
        Source(
            "spec.yaml",
            HEAD
            + "    points: [{is: attractor, at: [-1, 0], name: a}, {is: attractor, at: [1, 0], "
            "name: b}]\n"
            "    orbits:\n"
            "      - {name: lap, through: [[-1, 1.5], [0, 1], [1, 1.5], [0, 1.9]], period: 4}\n",
        )
    )

    notes = compile_loaded(loaded, lambda *_: None).notes

    assert all(note.startswith("added: one ") for note in notes)
    assert sum("saddle" in note for note in notes) == 2
    [core] = [note for note in notes if "unstable focus" in note]
    assert "'repeller inside lap' at x = 0 m" in core
    assert core.endswith("because an orbit encloses a point, and 'lap' encloses none")


def test_the_saddle_of_a_bent_separatrix_lies_on_it() -> None:
    points = np.array([[0.0, -1.0], [0.6, -0.2], [0.5, 0.4], [-0.2, 1.0]])
    near = np.array([0.1, 0.0])

    saddle = graph_through(points).nearest(near)

    model = ridge_through(points, near, (HALF, HALF))
    assert model.distance(saddle[np.newaxis], {}) == pytest.approx(0.0, abs=1e-12)
    assert model.parts(saddle[np.newaxis], {}) == pytest.approx(0.0, abs=1e-12)
    assert np.dot(saddle - near, points[-1] - points[0]) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize(
    "at_setting", [(1.2, -1.2, 0.5, 0.5), (1.5, -0.5, 0.2, 0.8), (0.5, -1, 0.8, 0.3)]
)
def test_each_edge_of_the_patrol_takes_its_own_time(
    patrol: Program, at_setting: tuple[float, float, float, float]
) -> None:
    x1, x2, v1, v2 = at_setting
    wanted = [(x1 - x2) / v1, 1.0, (x1 - x2) / v2, 1.0]
    times = np.linspace(0.0, 1.2 * sum(wanted), 40_001)
    start, controls = np.array([[x2, v1]]), np.array([at_setting])

    x, v = adaptive(flow_of(patrol), start, controls, times, 1e-9, 1e-9).states[0].T

    # The rounded corners pass beside the vertices, at the same angle about the centre.
    middle, half = np.array([(x1 + x2) / 2, (v1 - v2) / 2]), np.array([1.1 * (x1 - x2), v1 + v2])
    theta = np.unwrap(np.arctan2((v - middle[1]) / half[1], (x - middle[0]) / half[0]))
    corners = np.array([[x2, v1], [x1, v1], [x1, -v2], [x2, -v2], [x2, v1]])
    at = np.unwrap(np.arctan2(*((corners - middle) / half).T[::-1]))
    passed = np.interp(at[0] - at, theta[0] - theta, times)
    assert np.diff(passed) == pytest.approx(wanted, rel=0.025)


@given(
    st.lists(st.floats(0.3, 3.0), min_size=4, max_size=4),
    st.lists(st.floats(0.3, 2.0), min_size=4, max_size=4),
)
@settings(max_examples=30, deadline=None)
def test_edges_with_one_set_of_times_take_exactly_these(
    spans: list[float], seconds: list[float]
) -> None:
    t = np.linspace(0.0, 2 * np.pi, 4_096, endpoint=False)
    starts = np.cumsum([0.0, *spans])[:4] * 2 * np.pi / sum(spans)

    paces = timed_paces(1.0 + 0.3 * np.cos(t), starts, t, np.array([seconds]))

    step = (t[1] - t[0]) / (paces @ (1.0 / np.array(seconds)))
    edge = np.searchsorted(starts, t, side="right") - 1
    found = [step[edge == k].sum() for k in range(4)]
    assert found == pytest.approx(seconds, rel=1e-3)


def test_a_fill_that_the_judge_never_accepts_is_refused() -> None:
    loaded = load_source(Source("spec.yaml", HEAD + "    points: [{is: attractor, at: [0, 0]}]\n"))

    with pytest.raises(SpecError, match="S268") as raised:
        compile_loaded(loaded, lambda *_: None, lambda _program: ("one saddle too many",))

    assert "one saddle too many" in str(raised.value)


@given(st.lists(st.tuples(st.floats(-1, 1), st.floats(-1, 1)), min_size=1, max_size=5, unique=True))
@settings(max_examples=60, deadline=None)
def test_attractors_are_completed_to_index_one_by_one_saddle_fewer(
    places: list[tuple[float, float]],
) -> None:
    items = [
        Item("attractor", f"a{i}", np.array(at), (Number(at[0]), Number(at[1])))
        for i, at in enumerate(places)
    ]

    found = completed(items, "inward", Ground((HALF, HALF), lambda _at, _way: np.inf))

    assert index_of(found) == 1
    assert sum(item.sort == "saddle" for item in found) == len(places) - 1
    assert all(item.why for item in found if item.sort == "saddle")


def test_what_is_added_for_a_saddle_inside_an_orbit_stands_inside_too() -> None:
    features = (
        "    orbits: [{name: a, through: [[1, 0], [0, 1], [-1, 0], [0, -1]], period: 2}]\n"
        "    points: [{name: s, is: saddle, at: [0, 0]}]\n"
    )
    loaded = load_source(Source("spec.yaml", HEAD + features))
    assert isinstance(loaded.spec, BehaviorSpec)

    design = check_behavior(loaded, loaded.spec).design

    assert design is not None
    added = [node for node in design.nodes if node.point.why]
    ring = design.families[0].rings[0].vertices
    assert [node.point.kind for node in added] == ["repeller", "repeller"]
    assert len({node.point.name for node in added}) == 2
    assert all(encloses(0.9 * ring, node.spot.at) for node in added)


def test_the_remedy_for_a_vertex_that_stays_behind_is_a_sketch_without_mistakes(
    tmp_path: Path,
) -> None:
    """The spec of the golden pair, with the place that its own help says."""
    bad = Path("tests/golden/bad/sketch_orbit_changes_its_shape.yaml")
    (told,) = check(bad)
    better = tmp_path / "better.yaml"
    place = told.help.split("`")[1]
    text = bad.read_text(encoding="utf-8").replace("size, 0]", f'size, "{place}"]')

    better.write_text(text.replace('"-size", 0]', f'"-size", "{place}"]'), encoding="utf-8")

    assert check(better) == ()


def test_a_place_that_leaves_the_domain_at_one_end_of_a_control_only_is_found() -> None:
    text = HEAD.replace("state:", "control: {r: {unit: m, domain: [0, 2.001], default: 1}}\nstate:")
    features = "    points: [{is: attractor, at: [r, 0]}, {is: attractor, at: [-1, 0]}]\n"
    loaded = load_source(Source("spec.yaml", text + features))

    with pytest.raises(SpecError, match=r"S264.*domain of 'x' at r = 2.001 m"):
        compile_loaded(loaded, lambda *_: None)
