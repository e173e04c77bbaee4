"""Fixed points and cycles followed along one control: the bifurcation diagram as numbers.

Portraits are made at even values of the control; features of neighbours are matched by place, those
that are left begin or end a branch. Between neighbours that differ the bifurcation is located by
bisection, and portraits on both sides of it are added, so that branches reach it. S: samples.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Final, final

import numpy as np

from runtime.arrays import Array, frozen
from runtime.program import Control, Program
from verifier.topology.bifurcations import matched, signature
from verifier.topology.boundaries import COARSE, Bracket, explained, narrowed
from verifier.topology.claim_at import Scenes
from verifier.topology.continuation import Bifurcation, Branches, CycleBranch, PointBranch
from verifier.topology.features import Cycle, FixedPoint, Portrait
from verifier.topology.slices import SliceError

SAMPLES: Final = 33
"""Values of the control at which portraits are made, at first."""

NUDGE: Final = 0.0314
"""How far a value is moved that is a bifurcation, as a share of the gap to the next."""

BESIDE: Final = (0.0, 0.04, 0.25)
"""Where portraits are added beside a bifurcation, as shares of the gap to the next value."""

LIKE: Final = 0.25
"""Two cycles of neighbours whose swings and periods differ by less, relatively, are one."""

MOST_BETWEEN: Final = 4
"""Bifurcations that are told apart between two neighbours."""


def find_branches(
    program: Program,
    control: str,
    held: Mapping[str, float],
    limits: tuple[float, float] | None = None,
    samples: int = SAMPLES,
) -> Branches:
    """The branches along `control` (SI) from one limit to the other, everything else at `held`.

    Without limits all over its domain.

    Raises:
        SliceError: no control has this name, the limits are outside its domain, or nothing moves.
    """
    part = _control(program, control, held, limits)
    low, high = limits or (part.low, part.high)
    line = _Line(program, control, dict(held), (low, high), part.high - part.low)
    values = line.regular(np.linspace(low, high, samples))
    found = [one for a, b in pairwise(values) for one in line.between(a, b)]
    places = sorted({*values, *(v for one in found for v in one.sides)})
    portraits = [line.everything(value) for value in places]
    first = portraits[0]
    return Branches(
        name=program.name,
        about=program.about,
        control=control,
        unit=part.unit,
        low=low,
        high=high,
        axes=first.axes,
        held=tuple(one for one in first.held if one.name != control),
        values=frozen(values),
        points=_point_branches(places, portraits),
        cycles=_cycle_branches(places, portraits),
        bifurcations=tuple(one.bifurcation for one in found),
        notes=tuple(dict.fromkeys(note for seen in portraits for note in seen.notes)),
    )


def _control(
    program: Program,
    name: str,
    held: Mapping[str, float],
    limits: tuple[float, float] | None,
) -> Control:
    known = {control.name: control for control in program.controls}
    if name not in known:
        there = f"there are {', '.join(known)}" if known else "this behavior has none"
        raise SliceError(f"no control is named '{name}'; {there}")
    if name in held:
        raise SliceError(f"'{name}' takes all values and can't be held as well")
    part = known[name]
    low, high = limits or (part.low, part.high)
    if not part.low <= low < high <= part.high:
        scale, text = part.unit.scale, part.unit.text
        domain = f"{part.low / scale:g}..{part.high / scale:g} {text}"
        raise SliceError(f"the limits of '{name}' must increase within {domain}")
    return part


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Found:
    """A bifurcation, and values of the control close to it on both sides."""

    bifurcation: Bifurcation
    sides: tuple[float, ...]


@final
class _Line:
    """Portraits along the control."""

    def __init__(
        self,
        program: Program,
        control: str,
        held: dict[str, float],
        limits: tuple[float, float],
        span: float,
    ) -> None:
        self._scenes = Scenes(program)
        self._control = control
        self._held = tuple(held.items())
        self._limits = limits
        self._span = span

    def points(self, value: float) -> Portrait:
        """The portrait at a value, without cycles; at the nearest limit beyond them."""
        return self._at(value, cycles=False)

    def everything(self, value: float) -> Portrait:
        """The portrait at a value, with cycles."""
        return self._at(value, cycles=True)

    def regular(self, values: Array) -> list[float]:
        """The values, but beside those that are bifurcations themselves."""
        step = NUDGE * (float(values[1]) - float(values[0]))
        last = float(values[-1])
        return [
            value + (step if value < last else -step)
            if -1 in signature(self.points(value))[0]
            else value
            for value in values.tolist()
        ]

    def between(self, low: float, high: float) -> list[_Found]:
        """The bifurcations between two values, in their order."""
        found: list[_Found] = []
        before, after = low, high
        for _ in range(MOST_BETWEEN):
            if signature(self.everything(low)) == signature(self.everything(high)):
                break
            bracket = Bracket(low, high)
            if signature(self.points(low))[0] == signature(self.points(high))[0]:
                bracket = narrowed(
                    bracket, lambda v: signature(self.everything(v)), COARSE * self._span
                )
            where, why = explained(bracket, self._span, self.points, self.everything)
            if why.is_none:
                break
            within = 0.5 * (where.high - where.low)
            # A cycle that is born is seen a little later: that is no other bifurcation.
            if not found or abs(where.middle - found[-1].bifurcation.value) > 3.0 * within:
                one = Bifurcation(why.change, where.middle, within, why.at, why.about)
                found.append(_Found(one, self._beside(where, before, after)))
            low = max(bracket.high if bracket.high < high else where.high, where.high)
            if low >= high:
                break
        return found

    def _beside(self, where: Bracket, before: float, after: float) -> tuple[float, ...]:
        """Values on both sides of a bifurcation, the closer the more of them: branches bend."""
        lower = [where.low - share * (where.low - before) for share in BESIDE]
        upper = [where.high + share * (after - where.high) for share in BESIDE]
        return tuple(v for v in (*lower, *upper) if self._limits[0] <= v <= self._limits[1])

    def _at(self, value: float, *, cycles: bool) -> Portrait:
        inside = min(max(value, self._limits[0]), self._limits[1])
        return self._scenes.at((*self._held, (self._control, inside)), cycles=cycles, basins=False)


@final
@dataclass(slots=True)
class _Growing:
    """A branch under way: the values of the control, and what was found there."""

    values: list[float] = field(default_factory=list)
    points: list[FixedPoint] = field(default_factory=list)
    cycles: list[Cycle] = field(default_factory=list)


def _point_branches(values: list[float], portraits: list[Portrait]) -> tuple[PointBranch, ...]:
    open_ones: list[_Growing] = []
    done: list[_Growing] = []
    for value, seen in zip(values, portraits, strict=True):
        last = tuple(branch.points[-1] for branch in open_ones)
        pairs, gone, new = matched(seen.axes, last, seen.fixed_points)
        done += [open_ones[i] for i in gone]
        kept = []
        for i, j in sorted(pairs):
            open_ones[i].values.append(value)
            open_ones[i].points.append(seen.fixed_points[j])
            kept.append(open_ones[i])
        open_ones = kept + [_Growing([value], [seen.fixed_points[j]]) for j in new]
    return tuple(
        PointBranch(
            frozen(branch.values),
            frozen(np.array([point.at for point in branch.points])),
            tuple(point.kind for point in branch.points),
        )
        for branch in (*done, *open_ones)
    )


def _cycle_branches(values: list[float], portraits: list[Portrait]) -> tuple[CycleBranch, ...]:
    open_ones: list[_Growing] = []
    done: list[_Growing] = []
    for value, seen in zip(values, portraits, strict=True):
        width = np.array([axis.width for axis in seen.axes])
        free = list(seen.cycles)
        kept = []
        for branch in open_ones:
            before = branch.cycles[-1]
            unlike = [_unlike(before, cycle, width) for cycle in free]
            if not free or min(unlike) > LIKE:
                done.append(branch)
                continue
            nearest = free.pop(unlike.index(min(unlike)))
            branch.values.append(value)
            branch.cycles.append(nearest)
            kept.append(branch)
        open_ones = kept + [_Growing([value], cycles=[cycle]) for cycle in free]
    return tuple(_finished(branch) for branch in (*done, *open_ones))


def _unlike(a: Cycle, b: Cycle, width: Array) -> float:
    """How different two cycles are: in reach, in widths, and in period, relatively."""
    low = np.abs(a.points.min(axis=0) - b.points.min(axis=0)) / width
    high = np.abs(a.points.max(axis=0) - b.points.max(axis=0)) / width
    period = abs(a.period - b.period) / max(a.period, b.period)
    return float(max(low.max(), high.max(), 0.5 * period))


def _finished(branch: _Growing) -> CycleBranch:
    return CycleBranch(
        values=frozen(branch.values),
        lows=frozen(np.array([cycle.points.min(axis=0) for cycle in branch.cycles])),
        highs=frozen(np.array([cycle.points.max(axis=0) for cycle in branch.cycles])),
        periods=frozen([cycle.period for cycle in branch.cycles]),
        stabilities=tuple(cycle.stability for cycle in branch.cycles),
    )
