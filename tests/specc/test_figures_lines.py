"""Phase lines with modes, panels of sweeps, and names of features, held against a thermostat."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import specc
from runtime.arrays import frozen
from specc.drawn import picture_of
from specc.figures.style_names import Style
from specc.texts.portrait import portrait_summary, summary
from tests.specc.portrait_scenes import basins, circle, everything, point
from verifier.topology.branches.continuation import Change
from verifier.topology.features import Attractor, PointKind, Stability
from verifier.topology.names import attractor_tags, cycle_names
from verifier.topology.portrait_json import as_json

THERMOSTAT = """
specc: 1
kind: behavior
name: thermostat
state:
  T: {unit: K, domain: [280, 300], role: both, relates: {agent: a, environment: b}}
  heater:
    {kind: discrete, values: [warm, cool], role: both, relates: {agent: a, environment: b}}
field:
  modes:
    of: heater
    each:
      warm: {formula: {T: rate*(hot - T)}, leave: [{when: T >= high, to: cool}]}
      cool: {formula: {T: rate*(out - T)}, leave: [{when: T <= low, to: warm}]}
constants:
  rate: {value: 0.01, unit: 1/s}
  hot: {value: 310, unit: K}
  out: {value: 281, unit: K}
  high: {value: 293, unit: K}
  low: {value: 291, unit: K}
"""


@pytest.fixture(scope="module")
def sweep(tmp_path_factory: pytest.TempPathFactory) -> specc.Sweep:
    path = tmp_path_factory.mktemp("line") / "thermostat.yaml"
    path.write_text(THERMOSTAT, encoding="utf-8")
    return specc.sweep(path, "heater", "warm,cool")


def test_a_phase_line_knows_where_its_mode_is_left(sweep: specc.Sweep) -> None:
    left = [(s.mode, s.lines[0][0, 0]) for p in sweep.portraits for s in p.switching]

    assert [mode for mode, _ in left] == ["warm", "cool"]
    assert [place for _, place in left] == pytest.approx([293.0, 291.0], abs=1e-6)
    warming, cooling = 100.0 * math.log(19.0 / 17.0), 100.0 * math.log(12.0 / 10.0)
    assert sweep.portraits[0].cycles[0].period == pytest.approx(warming + cooling, rel=1e-6)


def test_panels_of_a_phase_line_share_one_scale_that_holds_all_rates(sweep: specc.Sweep) -> None:
    panels = picture_of(sweep, Style.SCREEN).axes

    low, high = panels[0].get_ylim()
    assert panels[1].get_ylim() == (low, high)
    assert low < -0.19 < 0.3 < high


def test_the_legend_of_a_phase_line_names_cycle_switching_and_basin(sweep: specc.Sweep) -> None:
    figure = picture_of(sweep.portraits[0], Style.SCREEN)
    legend = figure.axes[0].get_legend()
    assert legend is not None

    told = {text.get_text() for text in legend.get_texts()}
    assert {"stable cycle", "warm switches to cool"} < told
    assert "goes to the cycle of period 29.35 s: 100.0 %" in told


def test_what_is_so_of_every_panel_is_said_once(sweep: specc.Sweep) -> None:
    told = summary(sweep)

    assert told.count("the field of each panel is that of its mode") == 1
    assert "the field is that of" not in told
    assert "no fixed points found" not in told
    assert told.count("there is no fixed point") == 2


def test_panels_carry_the_shares_of_their_basins(sweep: specc.Sweep) -> None:
    for axes in picture_of(sweep, Style.SCREEN).axes:
        assert [text.get_text() for text in axes.texts] == ["100.0 %"]


def test_cycles_of_one_period_are_told_apart_by_their_middle_then_by_their_reach() -> None:
    here = circle(0.5, Stability.STABLE)
    there = replace(here, points=frozen(here.points + np.array([0.01, 1.0])))
    wide = circle(1.0, Stability.STABLE)
    repelling = circle(0.7, Stability.UNSTABLE)

    apart = replace(everything(), cycles=(here, there, repelling))
    assert cycle_names(apart) == (
        "cycle of period 3 s about (0, 0)",
        "cycle of period 3 s about (1, 1)",
        "cycle of period 3 s",
    )
    around = replace(everything(), cycles=(here, wide))
    assert cycle_names(around) == (
        "cycle of period 3 s about (0, 0) (x from -0.5 to 0.5)",
        "cycle of period 3 s about (0, 0) (x from -1 to 1)",
    )


def test_text_legend_and_json_give_one_number() -> None:
    one = point((-0.0101, -0.0704188), PointKind.STABLE_NODE)
    seen = replace(
        everything(),
        fixed_points=(one,),
        separatrices=(),
        basins=replace(basins(), attractors=(Attractor(is_cycle=False, index=0, share=0.4),)),
    )
    record = as_json(seen)["basins"]

    assert attractor_tags(seen) == ("(-1.01, -0.07042)",)
    assert "goes to the stable node at x = -1.01, v = -0.07042" in portrait_summary(seen)
    assert isinstance(record, dict)
    assert record["attractors"][0]["name"] == "stable node at x = -1.01, v = -0.07042"


DAMPED = """
specc: 1
kind: behavior
name: damped
state:
  x: {unit: "1", domain: [-1, 1], role: both, relates: {agent: a, environment: b}}
  v: {unit: "1/s", domain: [-1, 1], role: both, relates: {agent: a, environment: b}}
control:
  drag: {unit: 1/s, domain: [1, 3.1], default: 1}
constants:
  stiff: {value: 1, unit: 1/s^2}
field: {formula: {x: v, v: -stiff*x - drag*v}}
"""


def test_a_focus_that_becomes_a_node_is_told_at_critical_damping(tmp_path: Path) -> None:
    path = tmp_path / "damped.yaml"
    path.write_text(DAMPED, encoding="utf-8")
    heard: list[int] = []

    found = specc.branches(path, "drag", progress=lambda _what, done, _of: heard.append(done))

    assert found.bifurcations == ()
    (change,) = found.retypings
    assert change.change is Change.TYPE
    assert change.value == pytest.approx(2.0, abs=1e-5)
    assert change.about == "a stable focus becomes a stable node"
    assert heard == sorted(heard)
    assert "change of type at 2" in summary(found)
