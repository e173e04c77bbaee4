"""The portrait of a plane, from the ground up: basins, field, curves, fixed points."""

import numpy as np

from runtime.arrays import Array
from specc.figures.areas import draw_basins, draw_undecided
from specc.figures.axes_of_states import name_x, name_y
from specc.figures.curves import (
    draw_cycles,
    draw_nullclines,
    draw_separatrices,
    draw_switching,
    draw_trajectories,
)
from specc.figures.field import draw_field, draw_steps
from specc.figures.legend import Entry
from specc.figures.markers import cross, mark, rest, ring
from specc.figures.panel import Panel
from verifier.topology.features import Portrait, Standing


def draw_plane(panel: Panel, portrait: Portrait) -> list[Entry]:
    """Draws into `panel`; gives what the legend shows, the most important first."""
    x, y = portrait.axes
    name_x(panel.axes, x)
    name_y(panel.axes, y)
    basins = draw_basins(panel, portrait)
    if portrait.every > 0.0:
        field = draw_steps(panel, portrait.field)
    else:
        field = draw_field(panel, portrait.field, _curves(panel, portrait))
    nullclines = draw_nullclines(panel, portrait)
    paths = draw_trajectories(panel, portrait)
    switching = draw_switching(panel, portrait)
    separatrices = draw_separatrices(panel, portrait)
    cycles = draw_cycles(panel, portrait)
    boxes = draw_undecided(panel, portrait)
    points = _draw_points(panel, portrait)
    return [
        *points,
        *cycles,
        *separatrices,
        *switching,
        *boxes,
        *paths,
        *nullclines,
        *field,
        *basins,
    ]


def _curves(panel: Panel, portrait: Portrait) -> list[Array]:
    """All that the field's lines keep away from."""
    paths = [
        *(cycle.points for cycle in portrait.cycles),
        *(branch.points for branch in portrait.separatrices),
        *(path.points for path in portrait.trajectories),
    ]
    return [piece for path in paths for piece in panel.pieces(path)]


def _draw_points(panel: Panel, portrait: Portrait) -> list[Entry]:
    """The fixed points by type; one on the seam of a periodic axis at both of its ends."""
    copies = [(point, at) for point in portrait.fixed_points for at in _copies(portrait, point.at)]
    at = _stacked(panel, [place for _, place in copies])
    invented = np.array([point.standing is Standing.INVENTED for point, _ in copies], dtype=bool)
    lost = [place for zero in portrait.completeness.lost for place in _copies(portrait, zero)]
    palette, weight = panel.palette, panel.weight
    return [
        *mark(panel.axes, at, [point.kind for point, _ in copies], palette, weight),
        *ring(panel.axes, at[invented], palette, weight),
        *cross(panel.axes, _stacked(panel, lost), palette, weight),
        *rest(panel.axes, _stacked(panel, list(portrait.rests)), palette, weight),
    ]


def _stacked(panel: Panel, points: list[Array]) -> Array:
    return panel.shown(np.array(points).reshape(-1, 2))


def _copies(portrait: Portrait, at: Array) -> list[Array]:
    copies = [at]
    for j, axis in enumerate(portrait.axes):
        if not axis.periodic:
            continue
        low = [c for c in copies if c[j] - axis.low < 1e-6 * axis.width]
        high = [c for c in copies if axis.high - c[j] < 1e-6 * axis.width]
        shift = axis.width * np.eye(len(at))[j]
        copies += [c + shift for c in low] + [c - shift for c in high]
    return copies
