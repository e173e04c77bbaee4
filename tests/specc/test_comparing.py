"""One behavior held against another: what differs is known, because it was put there."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from compiler.check import check
from runtime.program import Program
from spec_schema.diagnostics import SpecError
from specc.comparing import compare_behaviors
from specc.comparison_text import comparison_record, comparison_text, verdict_text
from specc.figures.difference import draw_difference
from specc.loading import load_program
from verifier.topology.comparing.comparison import Comparison, Tolerances
from verifier.topology.comparing.matching import Fate

HEAD = """\
specc: 1
kind: behavior
name: {name}
about: A field for comparisons.
state:
  x: {{unit: "1", domain: [-2, 2], role: both, relates: {{agent: body, environment: home}}}}
  y: {{unit: "1", domain: [-2, 2], role: both, relates: {{agent: body, environment: home}}}}
control:
  pull: {{unit: "1", domain: [0.1, 4], default: 1}}
field:
  formula:
"""
ROUND = "(1 - x**2 - y**2)"


def program(folder: Path, name: str, x: str, y: str) -> Program:
    path = folder / f"{name}.yaml"
    path.write_text(HEAD.format(name=name) + f"    x: {x}\n    y: {y}\n", encoding="utf-8")
    assert not [d for d in check(path) if d.severity == "error"]
    return load_program(path)


def fates(comparison: Comparison) -> list[tuple[str, str, str]]:
    return [(str(f.fate), f.found, f.wanted) for f in comparison.features]


def test_a_behavior_adheres_to_itself(tmp_path: Path) -> None:
    code = program(tmp_path, "code", f"pull*x*{ROUND} - y", f"pull*y*{ROUND} + x")

    comparison = compare_behaviors(code, code)

    assert comparison.adheres
    assert comparison.within == 1.0
    assert {f.fate for f in comparison.features} == {Fate.SAME}
    assert [f.found for f in comparison.features] == ["unstable focus", "stable cycle"]
    assert verdict_text(comparison) == "adheres"


def test_a_moved_attractor_is_named_with_how_far_it_moved(tmp_path: Path) -> None:
    wanted = program(tmp_path, "wanted", "-pull*(x - 0.5)", "-pull*y")
    code = program(tmp_path, "code", "-pull*(x - 0.9)", "-pull*y")

    comparison = compare_behaviors(code, wanted)

    ((feature,), (x_rate, y_rate)) = comparison.features, comparison.rates
    assert feature.fate is Fate.MOVED
    assert feature.at == pytest.approx([0.9, 0.0], abs=1e-9)
    assert feature.moved == pytest.approx([0.4, 0.0], abs=1e-9)
    # The rates differ by 0.4 everywhere; allowed are 5 % of 2.5.
    assert x_rate.largest == pytest.approx(0.4, rel=1e-6)
    assert x_rate.allowed == pytest.approx(0.125, rel=1e-6)
    assert (x_rate.within, y_rate.within) == (0.0, 1.0)
    assert "moved by x 0.4, y 0" in comparison_text(comparison)
    assert not comparison.adheres


def test_tolerances_decide(tmp_path: Path) -> None:
    wanted = program(tmp_path, "wanted", "-pull*(x - 0.5)", "-pull*y")
    code = program(tmp_path, "code", "-pull*(x - 0.9)", "-pull*y")

    assert compare_behaviors(code, wanted, tolerances=Tolerances(0.2, 0.11)).adheres
    assert not compare_behaviors(code, wanted, tolerances=Tolerances(0.2, 0.09)).adheres
    assert not compare_behaviors(code, wanted, tolerances=Tolerances(0.15, 0.11)).adheres


def test_missing_extra_and_changed_features_are_told_apart(tmp_path: Path) -> None:
    cycle = program(tmp_path, "cycle", f"pull*x*{ROUND} - y", f"pull*y*{ROUND} + x")
    spiral = program(tmp_path, "spiral", "-pull*x - y", "-pull*y + x")

    assert fates(compare_behaviors(spiral, cycle)) == [
        ("changed", "stable focus", "unstable focus"),
        ("missing", "", "stable cycle"),
    ]
    assert fates(compare_behaviors(cycle, spiral)) == [
        ("changed", "unstable focus", "stable focus"),
        ("extra", "stable cycle", ""),
    ]


def test_two_homes_that_both_moved_are_not_mixed_up(tmp_path: Path) -> None:
    wanted = program(tmp_path, "wanted", "-pull*x*(x - 1)*(x + 1)", "-pull*y")
    code = program(tmp_path, "code", "-pull*(x - 0.1)*(x - 1.1)*(x + 0.9)", "-pull*y")

    comparison = compare_behaviors(code, wanted)

    assert [f.fate for f in comparison.features] == [Fate.SAME] * 3
    for feature in comparison.features:
        assert feature.moved == pytest.approx([0.1, 0.0], abs=1e-6)


def test_a_control_goes_to_those_that_have_it(tmp_path: Path) -> None:
    code = program(tmp_path, "code", "-pull*x", "-pull*y")

    assert compare_behaviors(code, code, held={"pull": "2"}).rates[0].allowed == (
        pytest.approx(0.05 * 4.0)
    )
    with pytest.raises(SpecError) as caught:
        compare_behaviors(code, code, held={"pul": 2.0})
    assert caught.value.diagnostics[0].code == "V341"


def test_the_record_is_plain_json_in_the_users_units(tmp_path: Path) -> None:
    wanted = program(tmp_path, "wanted", "-pull*(x - 0.5)", "-pull*y")
    code = program(tmp_path, "code", "-pull*(x - 0.9)", "-pull*y")

    record = json.loads(json.dumps(comparison_record(compare_behaviors(code, wanted))))

    assert record["adheres"] is False
    assert record["features"][0]["moved"] == pytest.approx({"x": 0.4, "y": 0.0}, abs=1e-9)


def test_the_picture_shows_where_it_is_out_of_tolerance(tmp_path: Path) -> None:
    wanted = program(tmp_path, "wanted", "-pull*x", "-pull*y")
    code = program(tmp_path, "code", "-0.75*pull*x", "-pull*y")

    comparison = compare_behaviors(code, wanted)
    figure = draw_difference(comparison)

    x = comparison.nodes[0]
    # Off by x/4; allowed are 0.1.
    assert np.all((comparison.worst > 1.0) == (np.abs(x) > 0.4)[:, None])
    assert len(figure.axes[0].images) == 1


SPECS = Path(__file__).parents[2] / "specs"


@pytest.mark.parametrize(
    ("change", "code"),
    [
        (("  x: {unit", "  z: {unit"), "V361"),
        (('x: {unit: "1"', "x: {unit: m"), "V361"),
        (("domain: [-2, 2]", "domain: [3, 4]"), "V362"),
    ],
)
def test_behaviors_that_cannot_be_compared_are_refused(
    tmp_path: Path, change: tuple[str, str], code: str
) -> None:
    one = program(tmp_path, "one", "-pull*x", "-pull*y")
    path = tmp_path / "other.yaml"
    text = (tmp_path / "one.yaml").read_text(encoding="utf-8").replace(*change)
    if "z: {unit" in text:
        text = text.replace("    x: -pull*x", "    z: -pull*z")
    if "x: {unit: m" in text:
        text = text.replace('pull: {unit: "1"', "pull: {unit: 1/s")
    path.write_text(text.replace("name: one", "name: other"), encoding="utf-8")

    with pytest.raises(SpecError) as caught:
        compare_behaviors(one, load_program(path))
    assert caught.value.diagnostics[0].code == code
    assert caught.value.diagnostics[0].help


def test_a_map_is_not_held_against_a_flow() -> None:
    steps = load_program(SPECS / "line_steps.yaml")

    with pytest.raises(SpecError) as caught:
        compare_behaviors(steps, as_flow(steps))
    assert caught.value.diagnostics[0].code == "V363"


def as_flow(program: Program) -> Program:
    """The same expressions, taken for rates."""
    return replace(program, name="flow", field=replace(program.field, every=0.0, form="formula"))
