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
from specc.figures.difference import draw_difference
from specc.loading import load_program
from specc.texts.comparison import comparison_record, comparison_text, verdict_text
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


HEATED = """\
specc: 1
kind: behavior
name: thermostat
state:
  T: {unit: K, domain: [283, 303], role: both, relates: {agent: heater, environment: room}}
  heat:
    kind: discrete
    values: ["off", "on"]
    role: both
    relates: {agent: heater, environment: room}
control:
  aim: {unit: K, domain: [288, 298], default: 293}
  band: {unit: K, domain: [0.1, 4], default: BAND}
constants:
  cold: {value: 285, unit: K}
  hot: {value: 308, unit: K}
  slow: {value: 300, unit: s}
field:
  modes:
    of: heat
    each:
      "off": {formula: {T: (cold - T)/slow}, leave: [{when: T <= aim - band, to: "on"}]}
      "on": {formula: {T: (hot - T)/slow}, leave: [{when: T >= aim + band, to: "off"}]}
"""


@pytest.fixture(scope="module")
def thermostats(tmp_path_factory: pytest.TempPathFactory) -> tuple[Program, Program]:
    """Two behaviors of one name in files of two names, with other defaults of one control."""
    folder = tmp_path_factory.mktemp("heated")
    for name, band in (("wide", "1.5"), ("narrow", "1")):
        text = HEATED.replace("BAND", band)
        (folder / f"{name}.yaml").write_text(text, encoding="utf-8")
    return load_program(folder / "wide.yaml"), load_program(folder / "narrow.yaml")


def test_the_values_that_both_were_taken_at_are_told_and_where_they_differ(
    thermostats: tuple[Program, Program],
) -> None:
    comparison = compare_behaviors(*thermostats)
    lines = comparison_text(comparison).splitlines()

    assert lines[0].startswith("wide.yaml held against narrow.yaml, over T")
    assert "  both at heat = off, aim = 293 K" in lines
    assert any("at values that differ: band = 1.5 K against 1 K" in line for line in lines)
    taken = comparison_record(comparison)["taken_at"]
    assert isinstance(taken, dict)
    assert taken["band"] == {"found": 1.5, "wanted": 1.0, "units": ["K", "K"], "differs": True}
    assert taken["heat"]["found"] == "off"


def test_values_given_to_both_do_not_differ(thermostats: tuple[Program, Program]) -> None:
    comparison = compare_behaviors(*thermostats, held={"band": 2.0})

    assert "differ" not in comparison_text(comparison)
    assert comparison.adheres


def test_over_one_axis_the_features_of_both_are_drawn(
    thermostats: tuple[Program, Program],
) -> None:
    (axes,) = draw_difference(compare_behaviors(*thermostats)).axes
    legend = [text.get_text() for text in axes.get_legend().get_texts()]
    assert "stable cycle: moved" in legend
    reaches = [
        (line.get_xdata()[0], line.get_xdata()[-1])
        for line in axes.lines
        if line.get_marker() == "|"
    ]
    assert reaches[0] == pytest.approx((291.5, 294.5), abs=1e-6)
    assert reaches[1] == pytest.approx((292.0, 294.0), abs=1e-6)


def test_the_borders_of_a_map_are_straight_where_the_difference_is_linear(tmp_path: Path) -> None:
    wanted = program(tmp_path, "wanted", "-x", "-y")
    code = program(tmp_path, "code", "-x + 0.1*(x + 0.37*y)", "-y")

    (axes,) = draw_difference(compare_behaviors(code, wanted)).axes
    levels = np.asarray(axes.images[0].get_array())
    count = len(levels)
    middles = -2.0 + 4.0 * (np.arange(count) + 0.5) / count
    # The rate's difference equals what is allowed, 0.05 * 2, on the line x + 0.37 y = 1.
    edges = [int(np.argmax(row[count // 2 :] >= 3)) + count // 2 for row in levels]
    assert np.abs(middles[edges] - (1.0 - 0.37 * middles)).max() < 1.5 * 4.0 / count
