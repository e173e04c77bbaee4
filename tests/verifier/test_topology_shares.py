"""How far the shares of basins may be off: closed forms, and grids of other fineness."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from specc.texts.portrait import portrait_summary
from tests.verifier.topology_scenes import line, plane
from verifier.topology.ends.shares import share_within
from verifier.topology.portrait import Detail, portrait
from verifier.topology.portrait_json import as_json


@given(st.integers(12, 60), st.floats(0.15, 0.3), st.floats(0.3, 0.7), st.floats(0.3, 0.7))
def test_the_area_of_a_disc_counted_in_cells_is_right_within_what_is_said(
    count: int, radius: float, x: float, y: float
) -> None:
    centres = (np.arange(count) + 0.5) / count
    inside = np.hypot(*np.meshgrid(centres - x, centres - y)) < radius

    assert abs(inside.mean() - np.pi * radius**2) <= share_within(inside) + 0.5 / count**2


def test_where_there_is_no_border_the_share_is_known() -> None:
    assert share_within(np.ones((5, 7), dtype=bool)) == 0.0
    assert share_within(np.zeros((5, 7), dtype=bool)) == 0.0


def test_a_lone_cell_is_as_uncertain_as_the_cells_around_it() -> None:
    inside = np.zeros((5, 7), dtype=bool)
    inside[2, 3] = True
    assert share_within(inside) == share_within(~inside) == pytest.approx(2.0 / 35)


@pytest.mark.parametrize("cells", [7, 16, 33])
def test_the_true_share_lies_within_what_text_and_json_say(cells: int) -> None:
    # The unstable point of x' is at 0.3 in [-2, 2]: 2.3 / 4 of the places go to the left.
    found = portrait(
        plane("x 0.3 sub x 1.5 sub mul x 1.5 add mul neg", "y neg"),
        detail=Detail(plane=65, trajectories=0, cycles=False, basins=cells),
    )
    basins = found.basins
    assert basins is not None
    left, right = basins.attractors
    assert abs(left.share - 2.3 / 4) <= left.within + 1e-12
    assert left.within == right.within == pytest.approx(0.5 / cells)
    assert f"± {100 * left.within:.1f} % of the domain goes to" in portrait_summary(found)
    record = as_json(found)["basins"]
    assert isinstance(record, dict)
    assert [a["within"] for a in record["attractors"]] == [left.within, right.within]


def test_a_basin_that_is_everything_is_told_without_doubt() -> None:
    found = portrait(line("x neg"), detail=Detail(line=65, trajectories=0, basins=16))
    assert "100.0 % of the domain goes to" in portrait_summary(found)
