"""What pictures show of portraits that were made by hand, and what the text and JSON say."""

import json
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.collections import PolyCollection
from matplotlib.colors import same_color
from matplotlib.patches import Rectangle

from runtime.arrays import frozen
from specc.drawn import picture_of
from specc.figures.curves import at_jumps, guard_stroke
from specc.figures.palettes import PALETTES
from specc.figures.portrait import draw_portrait
from specc.figures.style import rendered
from specc.figures.style_names import Style
from specc.portraying import Sweep
from specc.texts.branches import branches_record, branches_summary
from specc.texts.portrait import portrait_summary, proof_sentences, summary
from tests.specc.portrait_scenes import (
    X,
    basins,
    branches,
    circle,
    everything,
    field,
    jumping,
)
from verifier.topology.features import (
    AxisRange,
    Completeness,
    Grid,
    Portrait,
    Stability,
    Switching,
)
from verifier.topology.portrait_json import as_json

OUTSIDE_ONE_BOX = (
    "Undecided in one box; proved of the tables: outside, there are exactly 2 fixed points"
)


def labels(portrait: Portrait, style: Style = Style.SCREEN) -> list[str]:
    (axes,) = draw_portrait(portrait, style).axes
    return [text.get_text() for text in axes.get_legend().get_texts()]


def proof(*, complete: bool, undecided: int = 0, lost: int = 0) -> Completeness:
    boxes = everything().completeness.undecided * undecided
    return Completeness(complete, boxes, np.zeros((lost, 2)), "the tables")


def test_the_legend_names_everything_once_and_the_most_important_first() -> None:
    assert labels(everything()) == [
        "stable node",
        "saddle",
        "degenerate",
        "invented by the tables",
        "of the formula, lost by the tables",
        "stable cycle",
        "unstable cycle",
        "stable manifold",
        "unstable manifold",
        "forward switches to back",
        "trajectory",
        "flow, darker is faster",
        "undecided: may hold fixed points",
        "goes to (−1, 0): 42.5 %",
        "goes to the cycle of period 3 s: 42.5 %",
        "leaves the domain: 10.0 %",
    ]


@pytest.mark.parametrize("style", Style)
def test_every_style_draws_everything_on_its_own_ground(style: Style) -> None:
    figure = draw_portrait(everything(), style)

    palette = PALETTES[style]
    assert same_color(figure.get_facecolor(), palette.paper)
    assert same_color(figure.axes[0].get_facecolor(), palette.paper)
    assert len(labels(everything(), style)) == 16
    assert len(rendered(figure, "svg", palette)) < 200_000


def test_stable_cycles_are_solid_and_unstable_ones_dashed() -> None:
    portrait = replace(everything(), trajectories=(), separatrices=(), switching=())
    (axes,) = draw_portrait(portrait).axes

    orange = PALETTES[Style.SCREEN].cycle
    drawn = [line.get_linestyle() for line in axes.lines if line.get_color() == orange]
    assert drawn == ["-", "--"]


def test_an_undecided_box_is_hatched_where_it_is() -> None:
    (axes,) = draw_portrait(everything()).axes

    (box,) = (p for p in axes.patches if isinstance(p, Rectangle) and p.get_hatch())
    assert box.get_x() + 0.5 * box.get_width() == pytest.approx(1.0)
    assert box.get_y() + 0.5 * box.get_height() == pytest.approx(0.5)


def test_one_attractor_that_has_everything_is_tinted_and_named() -> None:
    one = replace(basins().attractors[0], share=1.0)
    alone = replace(basins(), attractors=(one,), labels=np.zeros_like(basins().labels), leaves=0.0)
    portrait = replace(everything(), basins=alone)

    assert [label for label in labels(portrait) if "goes to" in label] == [
        "goes to (−1, 0): 100.0 %"
    ]
    assert len(draw_portrait(portrait).axes[0].images) == 1


def test_the_edge_of_a_basin_shows_no_stairs() -> None:
    cells = 48
    centres = (np.arange(cells) + 0.5) / cells
    x, v = np.meshgrid(centres, centres, indexing="ij")
    tilted = np.where(x + 0.31 * v < 0.6, 0, 1)
    halves = replace(basins(), labels=tilted, centres=(centres, centres))
    (image,) = draw_portrait(replace(everything(), basins=halves)).axes[0].images
    picture = np.asarray(image.get_array())[..., 2]
    count = len(picture)
    edge = np.array([np.flatnonzero(np.diff(row))[0] for row in picture]) + 1.0
    wanted = (0.6 - 0.31 * (np.arange(count) + 0.5) / count) * count
    inner = slice(count // 10, -count // 10)
    # A twelfth of a cell is one pixel; the stairs of whole cells would be twelve pixels high.
    assert np.abs(edge - wanted)[inner].max() < 0.35 * count / cells


def test_the_way_back_has_a_guard_of_another_look_and_jumps_are_named() -> None:
    there = Switching("forward", "back", (frozen([[0.01, -2.0], [0.01, 2.0]]),))
    back = Switching("back", "forward", there.lines)
    looks = [guard_stroke(PALETTES[Style.SCREEN], s, 0).dashes for s in (there, back)]
    assert looks[0] != looks[1]

    portrait = replace(everything(), cycles=(jumping(),), rests=(frozen([0.0, 0.0]),))
    assert {"jump", "rest: switches without end"} < set(labels(portrait))
    itself = replace(portrait, switching=(replace(there, target="forward"),))
    assert "forward jumps here" in labels(itself)


def test_what_runs_along_a_guard_is_drawn_over_it() -> None:
    (axes,) = draw_portrait(everything()).axes
    color = PALETTES[Style.SCREEN].switch
    guards = [line.get_zorder() for line in axes.lines if line.get_color() == color]
    paths = [
        line.get_zorder()
        for line in axes.lines
        if line.get_color() in {PALETTES[Style.SCREEN].path, PALETTES[Style.SCREEN].cycle}
    ]
    assert guards
    assert max(guards) < min(paths)


def test_a_cycle_through_modes_jumps_where_time_stands_still() -> None:
    cycle = jumping()

    pieces, leaps = at_jumps(cycle.times, cycle.points)

    assert [len(piece) for piece in pieces] == [3, 3]
    assert [(leap[0, 1], leap[-1, 1]) for leap in leaps] == [(1.0, -1.0), (-1.0, 1.0)]
    assert (
        at_jumps(circle(1.0, Stability.STABLE).times, circle(1.0, Stability.STABLE).points)[1] == []
    )


def test_a_sweep_has_one_named_panel_for_each_value() -> None:
    panels = tuple(
        replace(everything(), held=(replace(everything().held[0], value=mu),))
        for mu in (0.1, 0.2, 0.3, 0.4, 0.5)
    )

    figure = picture_of(Sweep("mu", panels), Style.JOURNAL)

    titles = [axes.get_title(loc="left") for axes in figure.axes]
    assert titles == ["mu = 0.1", "mu = 0.2", "mu = 0.3", "mu = 0.4", "mu = 0.5"]
    assert [bool(axes.get_xlabel()) for axes in figure.axes] == [False, False, True, True, True]
    assert len(figure.legends) == 1


def test_a_bifurcation_diagram_has_a_panel_for_each_variable() -> None:
    figure = picture_of(branches(), Style.SCREEN)

    assert [axes.get_ylabel() for axes in figure.axes] == ["x [cm]", "v"]
    assert figure.axes[-1].get_xlabel() == "mu"
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == [
        "Hopf",
        "saddle-node",
        "stable cycle, lowest and highest",
        "stable fixed point",
        "unstable fixed point",
        "saddle",
    ]


def test_branches_change_their_dashes_exactly_where_their_type_changes() -> None:
    axes = picture_of(branches(), Style.SCREEN).axes[0]

    ink = PALETTES[Style.SCREEN].ink
    ends = [(line.get_xdata()[0], line.get_xdata()[-1]) for line in axes.lines
            if line.get_color() == ink]  # fmt: skip
    assert ends == [
        pytest.approx((0.0, 0.5)),
        pytest.approx((0.5, 1.0)),
        pytest.approx((0.0, 0.8)),
    ]


def test_branches_are_told_in_sentences_and_numbers() -> None:
    told = branches_summary(branches())

    assert "Hopf at 0.5 ± 1×10⁻⁴: a focus loses its hold" in told
    assert "fixed point from 0 to 1: stable focus, then unstable focus" in told
    record = branches_record(branches())
    json.dumps(record, allow_nan=False)
    assert record["fixed_points"][1]["at"]["x"][0] == pytest.approx(1.0)  # type: ignore[index]


@pytest.mark.parametrize(
    ("completeness", "told"),
    [
        (proof(complete=True), ["Proved of the tables: there are exactly 2 fixed points"]),
        (
            proof(complete=False, undecided=1, lost=1),
            [
                OUTSIDE_ONE_BOX,
                "The tables lack one fixed point of the formula",
            ],
        ),
        (replace(proof(complete=False), about=""), []),
    ],
)
def test_the_sentence_about_the_proof_says_no_more_than_is_proved(
    completeness: Completeness, told: list[str]
) -> None:
    assert proof_sentences(replace(everything(), completeness=completeness)) == told


def test_the_summary_tells_each_feature_and_where_it_goes() -> None:
    told = portrait_summary(everything()).splitlines()

    assert told[0] == "all_at_once over x, v, at mu = 0.5, going = forward"
    assert told[2].endswith("(invented by the interpolation)")
    assert told[3].endswith("(not proved)")
    assert "  stable cycle of period 3 s; multipliers 0.5" in told
    saddle = "manifold of the saddle at x = 0, v = 0"
    assert f"  stable {saddle} comes from the edge of the domain" in told
    assert f"  unstable {saddle} goes to the stable node at x = -1, v = 0" in told
    assert f"  unstable {saddle} goes to the stable cycle of period 3 s" in told
    assert "  42.5 % of the domain goes to the cycle of period 3 s" in told
    assert told[-1] == "  a note"
    assert summary(Sweep("mu", (everything(),))) == "\n".join(told)


def test_json_carries_proofs_cycles_separatrices_and_basins_in_own_units() -> None:
    record = json.loads(json.dumps(as_json(everything()), allow_nan=False))

    assert record["complete"] is False
    assert [p["proved"] for p in record["fixed_points"]] == [True, True, False]
    assert record["fixed_points"][0]["at"] == pytest.approx({"x": -1.0, "v": 0.0})
    assert record["undecided"] == [
        {"low": pytest.approx({"x": 0.9, "v": 0.4}), "high": pytest.approx({"x": 1.1, "v": 0.6})}
    ]
    assert record["lost"] == [pytest.approx({"x": 0.5, "v": -1.0})]
    first = record["cycles"][0]
    assert (first["period"], first["stable"], first["multipliers"]) == (3.0, True, [[0.5, 0.0]])
    assert max(p[0] for p in first["points"]) == pytest.approx(1.2)
    assert [s["to"] for s in record["separatrices"]] == [None, 0, 0]
    assert record["basins"]["attractors"][1] == {
        "of": "cycles",
        "index": 0,
        "name": "cycle of period 3 s",
        "share": 0.425,
        "within": 0.0,
    }
    assert record["switching"][0]["to"] == "back"


def test_three_axes_are_drawn_as_a_box_with_named_edges() -> None:
    z = AxisRange("z", X.unit, 0.0, 0.05, periodic=False)
    flat = everything()
    solid = replace(
        flat,
        axes=(*flat.axes, z),
        field=Grid((*field().nodes, np.zeros(1)), np.zeros((33, 33, 1, 3))),
        fixed_points=tuple(replace(p, at=np.append(p.at, 0.02)) for p in flat.fixed_points),
        cycles=tuple(
            replace(c, points=np.column_stack([c.points, 0.02 + 0.0 * c.times]))
            for c in flat.cycles
        ),
        separatrices=(),
        trajectories=(),
        switching=(),
        basins=None,
        completeness=replace(proof(complete=True), lost=np.empty((0, 3))),
    )

    (axes,) = draw_portrait(solid).axes

    texts = {text.get_text() for text in axes.texts}
    assert {"x [cm]", "v", "z [cm]", "−2", "2", "0"} <= texts
    names = [text.get_text() for text in axes.get_legend().get_texts()]
    assert names == ["stable node", "saddle", "degenerate", "stable cycle", "unstable cycle"]
    heads = [c for c in axes.collections if isinstance(c, PolyCollection)]
    assert len(heads[0].get_paths()) >= 2
