"""Labels in the areas of a portrait of decisions, where they cover no boundary.

A place is the better the farther all boundaries are from it, measured in sizes of the words.
"""

from dataclasses import dataclass
from itertools import product
from typing import Final, final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.path import Path

from runtime.arrays import Array
from specc.figures.labels import Words, dense
from specc.figures.legend import Look
from specc.figures.palettes import Palette
from specc.portraying_arbiters import ArbiterPortrait
from specc.texts.arbiter_portraits import choice_name
from specc.texts.arbiters import word_of
from verifier.deciding.plane import Area
from verifier.deciding.rulings import NOTHING, Ruling
from verifier.report.wording import exact

DOT: Final = 0.06
"""Inches around the end of a line that words keep off."""
SMALL: Final = 6.5
THIN: Final = 2.0
CLOSE: Final = 1.5
"""Points between a boundary and its value."""
GRID: Final = 48
"""Places along each axis that are tried."""
POINTS: Final = 72.0
SIZES: Final = (8.5, 7.5, 6.5)
SPACING: Final = 1.25
ENOUGH: Final = 3.0
"""Words that fit so many times are as good in the middle of all such places."""
ROOM: Final = 3.0
"""Points around words."""
STEP: Final = 0.05
"""Inches between two points of a boundary that words keep from."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Put:
    """Words that stand: centre and half size in inches."""

    at: Array
    half: Array


def label_areas(
    axes: Axes, found: ArbiterPortrait, scales: Array, size: Array, palette: Palette
) -> None:
    """Write choice and rule into each area, the large ones first; small ones get a line to them.

    scales: of SI in the units drawn. size: (2,) of the panel, inches.
    """
    ends = np.array([axes.get_xlim(), axes.get_ylim()])
    low, width = ends[:, 0], ends[:, 1] - ends[:, 0]

    def inches(points: Array) -> Array:
        return np.asarray((points / scales - low) / width * size)

    areas = sorted(found.plane.areas, key=lambda area: -area.share)
    rings = [[inches(ring) for ring in area.rings] for area in areas]
    walls = np.vstack([dense(ring, STEP) for each in rings for ring in each])
    places = _grid(size)
    put: list[_Put] = []
    left = []
    for area, ring in zip(areas, rings, strict=True):
        inside = places[_holds(ring, places)]
        if not _inside(axes, found, area, inside, walls, put, (low, width, size), palette):
            left.append((area, inside, ring))
    for area, inside, ring in left:
        spot = _deepest(inside, walls) if len(inside) else ring[0].mean(axis=0)
        _beside(axes, found, area, spot, places, walls, put, (low, width, size), palette)
    told: set[tuple[int, str]] = set()
    for border in sorted(found.plane.borders, key=lambda each: -len(each.points)):
        line = inches(border.points)
        paper = (low, width, size)
        _name_threshold(axes, found, border.points, line, walls, put, told, paper, palette)


def _inside(
    axes: Axes,
    found: ArbiterPortrait,
    area: Area,
    inside: Array,
    walls: Array,
    put: list[_Put],
    paper: tuple[Array, Array, Array],
    palette: Palette,
) -> bool:
    """Write into the area with the words and the size that fit; False where none does."""
    if not len(inside):
        return False
    ruling = found.plane.rulings[area.ruling]
    for text in _texts(found, ruling):
        for points in SIZES:
            half = _half(text, points)
            room = _room(inside, walls, half)
            if room.max() >= 1.0:
                at = _middle(inside, room)
                _write(axes, text, points, at, paper, palette)
                put.append(_Put(at, half))
                return True
    return False


def _beside(
    axes: Axes,
    found: ArbiterPortrait,
    area: Area,
    spot: Array,
    places: Array,
    walls: Array,
    put: list[_Put],
    paper: tuple[Array, Array, Array],
    palette: Palette,
) -> None:
    """Write near a small area, and lead a line to it."""
    text = _texts(found, found.plane.rulings[area.ruling])[-2]
    half = _half(text, SIZES[-1])
    free = places[_room(places, walls, half) >= 1.0]
    clear = np.ones(len(free), dtype=np.bool_)
    for one in put:
        clear &= (np.abs(free - one.at) > one.half + half).any(axis=1)
    free = free[clear]
    if not len(free):
        return
    at = free[int(np.argmin(np.hypot(*(free - spot).T)))]
    low, width, size = paper
    begin = np.clip(spot, at - half, at + half)
    line = np.array([begin, spot]) / size * width + low
    axes.plot(*line.T, color=palette.ink, lw=0.6, zorder=5)
    axes.plot(*line[1], marker="o", ms=2.2, color=palette.ink, zorder=5)
    _write(axes, text, SIZES[-1], at, paper, palette)
    put += [_Put(at, half), _Put(spot, np.full(2, DOT))]


def _name_threshold(
    axes: Axes,
    found: ArbiterPortrait,
    points: Array,
    line: Array,
    walls: Array,
    put: list[_Put],
    told: set[tuple[int, str]],
    paper: tuple[Array, Array, Array],
    palette: Palette,
) -> None:
    """Write beside the longest straight part of a boundary along an axis at which value it lies."""
    low, width, size = paper
    lengths = np.abs(np.diff(line, axis=0))
    for along in (0, 1):
        across = 1 - along
        k = int(np.argmax(np.where(lengths[:, across] < 1e-6, lengths[:, along], 0.0)))
        if lengths[k, across] > 1e-6 or across >= len(found.plane.axes):
            continue
        axis = found.plane.axes[across]
        if axis.values:
            continue
        text = exact(float(points[k, across]), axis.unit)
        if (across, text) in told:
            continue
        half = _half(text, SMALL)[:: 1 if along == 0 else -1] - THIN / POINTS
        away = np.zeros(2)
        away[across] = half[across] + CLOSE / POINTS
        for share, side in product((0.92, 0.08, 0.75, 0.25, 0.5), (1.0, -1.0)):
            at = line[k] + share * (line[k + 1] - line[k])
            at[along] = np.clip(at[along], half[along], size[along] - half[along])
            at += side * away
            is_free = _room(at[None], walls, half)[0] >= 1.0 and bool(
                np.all((at > 0) & (at < size))
            )
            if is_free and all((np.abs(at - p.at) > p.half + half).any() for p in put):
                x, y = (at / size * width + low).tolist()
                axes.text(
                    x, y, text, fontsize=SMALL, color=palette.faint, ha="center", va="center",
                    rotation=90.0 * along, zorder=4, bbox=_halo(palette),
                )  # fmt: skip
                put.append(_Put(at, half))
                told.add((across, text))
                break


def _texts(found: ArbiterPortrait, ruling: Ruling) -> list[str]:
    """What may be written, the longest first; the last one is but numbers."""
    names = [choice_name(found.arbiter, choice) for choice in ruling.choices]
    if not ruling.places:
        return [names[0], names[0]]
    numbers = [str(place + 1) if place != NOTHING else "none" for place in ruling.places]
    word = word_of(found.arbiter)
    if len(ruling.places) == 1:
        rule = "no rule" if ruling.places[0] == NOTHING else f"{word} {numbers[0]}"
        return [f"{names[0]}\n{rule}", f"{names[0]} ({numbers[0]})", numbers[0]]
    *before, last = numbers
    held = " or ".join(f"{word} {number}" for number in before)
    short = f"{', '.join(before)} if held, else {last}"
    if not ruling.is_band:
        return [f"{names[-1]}\n{held} or {last}", f"{names[-1]} {', '.join(numbers)}", last]
    going = " or ".join(dict.fromkeys(names[:-1]))
    return [
        f"{names[-1]}, {word} {last}\n({going} if {held} held)",
        f"{names[-1]} {last}\n({', '.join(before)} if held)",
        short,
        f"({', '.join(before)}) {last}",
    ]


def _grid(size: Array) -> Array:
    """Places (n, 2) all over the panel, inches."""
    x, y = ((np.arange(GRID) + 0.5) / GRID * each for each in size)
    return np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)


def _holds(rings: list[Array], places: Array) -> Array:
    """Which places lie within rings, of which holes run the other way round."""
    outline = Path.make_compound_path(*(Path(ring, closed=True) for ring in rings))
    return np.asarray(outline.contains_points(places))


def _half(text: str, points: float) -> Array:
    """Half the width and height of words, in inches."""
    lines = text.split("\n")
    width = max(Words(line, points, "").extent[0] for line in lines)
    return np.array([width / 2.0 + ROOM, len(lines) * points * SPACING / 2.0 + ROOM]) / POINTS


def _room(places: Array, walls: Array, half: Array) -> Array:
    """How many times the words would fit around each place before they meet a wall."""
    gaps = np.abs(places[:, None, :] - walls[None, :, :]) / half
    return np.asarray(gaps.max(axis=-1).min(axis=1))


def _middle(places: Array, room: Array) -> Array:
    """Of the places with the most room, or enough, the one in the midst of them."""
    best = places[room >= min(0.95 * room.max(), ENOUGH)]
    return np.asarray(best[int(np.argmin(np.hypot(*(best - best.mean(axis=0)).T)))])


def _deepest(places: Array, walls: Array) -> Array:
    return np.asarray(places[int(np.argmax(_room(places, walls, np.ones(2))))])


def _write(
    axes: Axes,
    text: str,
    points: float,
    at: Array,
    paper: tuple[Array, Array, Array],
    palette: Palette,
) -> None:
    low, width, size = paper
    x, y = (at / size * width + low).tolist()
    axes.text(
        x, y, text, fontsize=points, color=palette.ink, ha="center", va="center",
        linespacing=SPACING, zorder=6, bbox=_halo(palette),
    )  # fmt: skip


def _halo(palette: Palette) -> Look:
    return {"facecolor": palette.paper, "alpha": 0.72, "edgecolor": "none", "pad": 1.0}
