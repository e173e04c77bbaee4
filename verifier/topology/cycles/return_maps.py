"""Where a planar flow's return maps have fixed points: the closed trajectories across sections.

P(s): the return to a section of the start at s; f(s) = P(s) - s. R: rows, each a stretch of a
section at S places. A simple zero of f is a cycle that attracts or repels, a zero without change
of sign one that does both (semi-stable), a stretch of zeros a continuum of closed trajectories.
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Booleans, Integers
from verifier.flags import runs_of
from verifier.topology.cycles.sections import Lanes, Section, first_returns, points_of
from verifier.topology.slices import Slice

PLACES: Final = 40
"""Starts on each section, closer together towards a ray's fixed point (Hopf), and"""

NEAREST: Final = np.geomspace(1e-5, 0.5 / PLACES**2, 10)
"""some on a ray that are closer still, as shares of it; a line has as many more."""

FINER: Final = 9
"""Starts on a stretch of a section that is looked at again."""

LEVELS: Final = 2
"""How often a stretch with a change of sign is looked at again; then Newton's method takes over."""

TOUCHING_LEVELS: Final = 5
"""The same for a stretch in which f may touch zero."""

ROUNDING: Final = 3e-8
"""What f may be off where the field is exact."""

NOISE: Final = 0.1
"""A change of sign between values below this share of what can't be told from 0 says nothing."""

CONTINUUM: Final = 0.12
"""The share of a section on which every trajectory must close before they count as a continuum."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Candidate:
    """A trajectory that nearly closes: from `start` (2,) in `period` s, negative if backwards.

    The sign is that of the direction in which others come closer. section: on which it was
    found, -1 for none; backwards: by following time backwards. touching: f touches zero there.
    """

    start: Array
    period: float
    section: int
    backwards: bool
    touching: bool


@final
@dataclass(frozen=True, eq=False, slots=True)
class Scan:
    """What the return maps of some sections show; continuum: whether all trajectories close."""

    candidates: tuple[Candidate, ...]
    continuum: bool


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Rows:
    """Return maps on stretches: which section (R,); s, f, times, sides, floor (R, S).

    floor: below it f can't be told from zero.
    """

    which: Integers
    s: Array
    f: Array
    times: Array
    sides: Array
    floor: Array


def scan(
    view: Slice, sections: tuple[Section, ...], lengths: tuple[float, ...], step: float
) -> Scan:
    """The closed trajectories that cross `sections` within `lengths`, widths; step: a pace.

    A negative step follows time backwards, which finds what forwards is out of reach.
    """
    share = np.arange(1, PLACES + 1) / PLACES
    ray = np.concatenate([NEAREST, share**2])
    around = (np.arange(ray.size) + 0.5) / ray.size
    reach = [around if one.around >= 0 else ray for one in sections]
    s = np.array([0.999 * b * r for b, r in zip(lengths, reach, strict=True)])
    rows = _mapped(view, sections, np.arange(len(sections)), s, step)
    closing = _continua(rows, np.array(lengths))
    simple = _stretches(rows, _changes(rows) & ~(closing[:, 1:] & closing[:, :-1]))
    borders = _stretches(rows, _borders(rows))
    near_borders = _zoomed(view, sections, borders, step)
    touching, found = _touching(view, sections, rows, closing, step)
    simple = [*simple, *found]
    if near_borders is not None:
        simple += _stretches(near_borders, _changes(near_borders))
    return Scan(
        (*_simple(view, sections, simple, step), *touching),
        bool(closing.any()),
    )


_Stretch = tuple[int, float, float]
"""A section, and from where to where on it."""


def _mapped(
    view: Slice, sections: tuple[Section, ...], which: Integers, s: Array, step: float
) -> _Rows:
    lanes = Lanes(sections, np.repeat(which, s.shape[1]), s.ravel())
    back = first_returns(view, lanes, step)
    f = back.r.reshape(s.shape) - s
    for row, k in enumerate(which):
        if sections[k].around >= 0 and view.periodic[1 - sections[k].around]:
            f[row] -= np.round(f[row])
    times = back.times.reshape(s.shape)
    error = float(np.max(view.accuracy / view.width))
    floor = ROUNDING + 2.0 * error * np.abs(times)
    return _Rows(which, s, f, times, back.sides.reshape(s.shape), floor)


def _changes(rows: _Rows) -> Booleans:
    """Between which neighbours (R, S - 1) f changes its sign."""
    a, b = rows.f[:, :-1], rows.f[:, 1:]
    with np.errstate(invalid="ignore"):
        change = ((a < 0.0) != (b < 0.0)) & (np.abs(a - b) < 0.5)
        known = np.maximum(np.abs(a), np.abs(b)) > NOISE * rows.floor[:, 1:]
    return np.asarray(change & known & (rows.sides[:, :-1] == rows.sides[:, 1:]))


def _borders(rows: _Rows) -> Booleans:
    """Between which neighbours (R, S - 1) trajectories cease to return."""
    known = np.isfinite(rows.f)
    return np.asarray(known[:, 1:] != known[:, :-1])


def _continua(rows: _Rows, lengths: Array) -> Booleans:
    """Places (R, S) within a stretch of trajectories that all close."""
    with np.errstate(invalid="ignore"):
        closes = np.abs(rows.f) <= rows.floor
    result = np.zeros_like(closes)
    for row, flags in enumerate(closes):
        for begin, end in runs_of(flags):
            if rows.s[row, end - 1] - rows.s[row, begin] > CONTINUUM * lengths[row]:
                result[row, begin:end] = True
    return result


def _stretches(rows: _Rows, between: Booleans) -> list[_Stretch]:
    return [
        (int(rows.which[r]), float(rows.s[r, i]), float(rows.s[r, i + 1]))
        for r, i in np.argwhere(between)
    ]


def _zoomed(
    view: Slice, sections: tuple[Section, ...], stretches: list[_Stretch], step: float
) -> _Rows | None:
    """The stretches at `FINER` places each."""
    if not stretches:
        return None
    which = np.array([section for section, _, _ in stretches])
    s = np.array([np.linspace(a, b, FINER) for _, a, b in stretches])
    return _mapped(view, sections, which, s, step)


def _simple(
    view: Slice, sections: tuple[Section, ...], stretches: list[_Stretch], step: float
) -> list[Candidate]:
    """Candidates where f changes its sign within stretches, closer and closer."""
    rows: _Rows | None = None
    for _ in range(LEVELS):
        rows = _zoomed(view, sections, stretches, step)
        if rows is None:
            return []
        stretches = _stretches(rows, _changes(rows))
    assert rows is not None, "there are levels"
    found = []
    for r, i in np.argwhere(_changes(rows)):
        a, b = rows.f[r, i], rows.f[r, i + 1]
        part = a / (a - b) if a != b else 0.5
        s = rows.s[r, i] + part * (rows.s[r, i + 1] - rows.s[r, i])
        period = (1.0 - part) * rows.times[r, i] + part * rows.times[r, i + 1]
        expands = a < b
        start = points_of(view, Lanes(sections, rows.which[r : r + 1], np.array([s])))[0]
        signed = float(-period if expands else period)
        found.append(Candidate(start, signed, int(rows.which[r]), step < 0.0, touching=False))
    return found


def _touching(
    view: Slice, sections: tuple[Section, ...], rows: _Rows, skipped: Booleans, step: float
) -> tuple[list[Candidate], list[_Stretch]]:
    """Candidates where f touches zero, and stretches where looked at closely it crosses it."""
    sign = np.sign(rows.f)
    bends = _bends(rows, sign) & ~skipped[:, 1:-1]
    stretches = [
        (int(rows.which[r]), float(rows.s[r, i]), float(rows.s[r, i + 2]))
        for r, i in np.argwhere(bends)
    ]
    signs = [sign[r, i] for r, i in np.argwhere(bends)]
    found: list[Candidate] = []
    crossing: list[_Stretch] = []
    for level in range(TOUCHING_LEVELS):
        fine = _zoomed(view, sections, stretches, step)
        if fine is None:
            break
        following: list[_Stretch] = []
        kept: list[float] = []
        for r, ((section, a, b), side) in enumerate(zip(stretches, signs, strict=True)):
            heights = np.where(np.isfinite(fine.f[r]), side * fine.f[r], np.inf)
            i = int(np.argmin(heights))
            if heights[i] < -fine.floor[r, i]:
                crossing += [(section, a, float(fine.s[r, i])), (section, float(fine.s[r, i]), b)]
            elif i in {0, FINER - 1}:
                continue
            elif level < TOUCHING_LEVELS - 1:
                following.append((section, float(fine.s[r, i - 1]), float(fine.s[r, i + 1])))
                kept.append(side)
            else:
                s, height = _vertex(fine.s[r], heights)
                if abs(height) <= fine.floor[r, i]:
                    period = float(np.interp(s, fine.s[r], fine.times[r]))
                    lane = Lanes(sections, np.array([section]), np.array([s]))
                    start = points_of(view, lane)[0]
                    found.append(Candidate(start, period, section, step < 0.0, touching=True))
        stretches, signs = following, kept
    return found, crossing


def _vertex(s: Array, heights: Array) -> tuple[float, float]:
    """Where the parabola fitted to `heights` is least, within s, and how high it is there.

    Infinitely high where too few of them are finite.
    """
    known = np.isfinite(heights)
    middle, half = 0.5 * (s[0] + s[-1]), 0.5 * (s[-1] - s[0])
    if np.sum(known) < 3:
        return float(middle), np.inf
    parabola = np.polyfit((s[known] - middle) / half, heights[known], 2)
    place = np.clip(-0.5 * parabola[1] / max(parabola[0], 1e-300), -1.0, 1.0)
    return float(middle + half * place), float(np.polyval(parabola, place))


def _bends(rows: _Rows, sign: Array) -> Booleans:
    """Inner places (R, S - 2) where |f| is least among neighbours, and a parabola comes near 0."""
    size = np.abs(rows.f)
    before, here, after = size[:, :-2], size[:, 1:-1], size[:, 2:]
    same = (sign[:, :-2] == sign[:, 1:-1]) & (sign[:, 1:-1] == sign[:, 2:])
    side = rows.sides
    same &= (side[:, :-2] == side[:, 1:-1]) & (side[:, 1:-1] == side[:, 2:])
    with np.errstate(invalid="ignore", divide="ignore"):
        least = (here <= before) & (here <= after)
        bend = before - 2.0 * here + after
        vertex = here - (after - before) ** 2 / (8.0 * bend)
        near = vertex <= 0.3 * np.maximum(before, after)
        # What can't be told from zero around either, as close to a weak focus, has no least place.
        near &= np.maximum(before, after) > 3.0 * rows.floor[:, 1:-1]
    return np.asarray(same & least & near)
