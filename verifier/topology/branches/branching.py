"""Fixed points and cycles followed along one control: the bifurcation diagram as numbers.

Portraits are made at even values of the control; features of neighbours are matched by place, those
that are left begin or end a branch. Between neighbours that differ the bifurcation is located by
bisection, and portraits on both sides of it are added, so that branches reach it. Where two
branches cross, as their tangents show, the same is done, although there are as many points of each
type on both sides. S: samples.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Final, final

import numpy as np

from runtime.arrays import Array, frozen
from runtime.program import Control, Program
from runtime.progress import Progress, in_silence
from verifier.topology.branches.bifurcations import (
    Difference,
    Steps,
    difference,
    exchanged,
    signature,
)
from verifier.topology.branches.boundaries import (
    BIRTH,
    CLOSE,
    COARSE,
    Bracket,
    explained,
    narrowed,
)
from verifier.topology.branches.continuation import (
    Bifurcation,
    Branches,
    Change,
)
from verifier.topology.branches.lines import cycle_branches, point_branches
from verifier.topology.branches.retyping import retypings
from verifier.topology.branches.tangents import tangents
from verifier.topology.features import Portrait
from verifier.topology.scenes import Scenes
from verifier.topology.slices import SliceError

SAMPLES: Final = 33
"""Values of the control at which portraits are made, at first."""

NUDGE: Final = 0.0314
"""How far a value is moved that is a bifurcation, as a share of the gap to the next."""

BESIDE: Final = (0.0, 0.04, 0.25)
"""Where portraits are added beside a bifurcation, as shares of the gap to the next value."""

CROSSING: Final = 1e-4
"""How closely branches that cross must be told apart, as a share of the control's domain."""

UNEVEN: Final = 0.4812
"""Where an interval is cut: not in its middle, which is a bifurcation more often than not."""

BIRTHS: Final = frozenset({Change.HOPF, Change.PERIOD_DOUBLING})
"""Where a cycle is born, too small to be seen at first."""

MOST_BETWEEN: Final = 4
"""Bifurcations that are told apart between two neighbours."""


def find_branches(
    program: Program,
    control: str,
    held: Mapping[str, float],
    limits: tuple[float, float] | None = None,
    samples: int = SAMPLES,
    progress: Progress = in_silence,
) -> Branches:
    """The branches along `control` (SI) from one limit to the other, everything else at `held`.

    Without limits all over its domain. `progress(what, done, of)` is called before each of the
    even portraits; what is between them follows.

    Raises:
        SliceError: no control has this name, the limits are outside its domain, or nothing moves.
    """
    part = _control(program, control, held, limits)
    low, high = limits or (part.low, part.high)
    line = _Line(program, control, dict(held), (low, high), part.high - part.low)
    even = np.linspace(low, high, samples)
    for k, value in enumerate(even.tolist()):
        progress(f"portraits along {control}", k, samples)
        line.everything(value)
    progress("between them", samples, samples)
    values = line.regular(even)
    found = line.bifurcations(values)
    places = sorted({*values, *(v for one in found for v in one.sides)})
    portraits = [line.everything(value) for value in places]
    first = portraits[0]
    joined = point_branches(places, portraits, line.steps)
    changes = tuple(one.bifurcation for one in found)
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
        points=joined,
        cycles=cycle_branches(places, portraits),
        bifurcations=changes,
        notes=tuple(dict.fromkeys(note for seen in portraits for note in seen.notes)),
        retypings=retypings(joined, changes, line.points),
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
    """A bifurcation, values close to it on both sides, and the ends of where it is."""

    bifurcation: Bifurcation
    sides: tuple[float, ...]
    ends: tuple[float, float]


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
        self._moving: dict[float, Array] = {}

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
            if -1 in signature(self.everything(value))[0]
            else value
            for value in values.tolist()
        ]

    def steps(self, low: float, high: float) -> Steps:
        """How far the points at two values move between them, along their tangents."""
        return Steps(*((high - low) * self._tangents(value) for value in (low, high)))

    def bifurcations(self, values: list[float]) -> list[_Found]:
        """The bifurcations between the values, in their order: of points first, then of cycles."""
        found = [one for a, b in pairwise(values) for one in self._of_points(a, b, MOST_BETWEEN)]
        for a, b in pairwise(values):
            inside = [one for one in found if a < one.ends[0] and one.ends[1] < b]
            lows = [a, *(one.ends[1] for one in inside)]
            highs = [*(one.ends[0] for one in inside), b]
            for low, high in zip(lows, highs, strict=True):
                found += self._of_cycles(low, high, found, (a, b))
        return sorted(found, key=lambda one: one.bifurcation.value)

    def _of_points(self, low: float, high: float, depth: int) -> list[_Found]:
        """The bifurcations of fixed points between two values."""
        if signature(self.points(low))[0] != signature(self.points(high))[0]:
            where, why = explained(Bracket(low, high), self._span, self.points, self.points)
        elif self._exchanged(low, high):
            crossing = self._around(self._crossing(Bracket(low, high)), low, high)
            if crossing is None:
                return []
            where = crossing
            ends = (self.points(where.low), self.points(where.high))
            why = difference(*ends, self.steps(where.low, where.high))
        else:
            return []
        if why.is_none or depth == 0:
            return []
        one = self._found(where, why, low, high)
        before = self._of_points(low, where.low, depth - 1) if low < where.low else []
        after = self._of_points(where.high, high, depth - 1) if where.high < high else []
        return [*before, one, *after]

    def _of_cycles(
        self, low: float, high: float, found: list[_Found], ends: tuple[float, float]
    ) -> list[_Found]:
        """The bifurcations of cycles between two values that no bifurcation of points parts."""
        low, high = (self._past_births(low, found, 1.0), self._past_births(high, found, -1.0))
        if low >= high:
            return []
        kinds = [signature(self.everything(value))[1] for value in (low, high)]
        if kinds[0] == kinds[1]:
            return []
        bracket = narrowed(
            Bracket(low, high), lambda v: signature(self.everything(v))[1], COARSE * self._span
        )
        where, why = explained(bracket, self._span, self.points, self.everything)
        known = any(abs(where.middle - one.bifurcation.value) < BIRTH * self._span for one in found)
        if why.is_none or (known and why.change in BIRTHS):
            return []
        return [self._found(where, why, *ends)]

    def _past_births(self, value: float, found: list[_Found], side: float) -> float:
        """The value, or beside it where cycles are too small to be seen that were just born."""
        for one in found:
            born = one.bifurcation.change in BIRTHS
            if born and abs(one.bifurcation.value - value) < BIRTH * self._span:
                return one.bifurcation.value + side * BIRTH * self._span
        return value

    def _exchanged(self, low: float, high: float) -> bool:
        return exchanged(self.points(low), self.points(high), self.steps(low, high))

    def _crossing(self, bracket: Bracket) -> Bracket:
        """The bracket by bisection where points exchange their stability; wide if none do."""
        while bracket.high - bracket.low > CLOSE * self._span:
            middle = bracket.low + UNEVEN * (bracket.high - bracket.low)
            if -1 in signature(self.points(middle))[0]:
                return Bracket(middle, middle)
            if self._exchanged(bracket.low, middle):
                bracket = Bracket(bracket.low, middle)
            elif self._exchanged(middle, bracket.high):
                bracket = Bracket(middle, bracket.high)
            else:
                break
        return bracket

    def _around(self, bracket: Bracket, low: float, high: float) -> Bracket | None:
        """The bracket, widened until what happens shows at its ends; None where nothing does.

        Where two points nearly touch, their types are not decided.
        """
        step = CLOSE * self._span
        while bracket.high - bracket.low < CROSSING * self._span:
            bracket = Bracket(max(bracket.low - step, low), min(bracket.high + step, high))
            kinds = [signature(self.points(end))[0] for end in (bracket.low, bracket.high)]
            if -1 not in (*kinds[0], *kinds[1]) and self._exchanged(bracket.low, bracket.high):
                return bracket
            step *= 2.0
        return None

    def _found(self, where: Bracket, why: Difference, low: float, high: float) -> _Found:
        within = 0.5 * (where.high - where.low)
        one = Bifurcation(why.change, where.middle, within, why.at, why.about)
        return _Found(one, self._beside(where, low, high), (where.low, where.high))

    def _tangents(self, value: float) -> Array:
        if value not in self._moving:
            settings = {**dict(self._held), self._control: value}
            axes = self._scenes.axes(tuple(settings.items()))
            seen = self.points(value)
            self._moving[value] = tangents(
                self._scenes.program, axes, settings, self._control, seen
            )
        return self._moving[value]

    def _beside(self, where: Bracket, before: float, after: float) -> tuple[float, ...]:
        """Values on both sides of a bifurcation, the closer the more of them: branches bend."""
        lower = [where.low - share * (where.low - before) for share in BESIDE]
        upper = [where.high + share * (after - where.high) for share in BESIDE]
        return tuple(v for v in (*lower, *upper) if self._limits[0] <= v <= self._limits[1])

    def _at(self, value: float, *, cycles: bool) -> Portrait:
        inside = min(max(value, self._limits[0]), self._limits[1])
        return self._scenes.at((*self._held, (self._control, inside)), cycles=cycles, basins=False)
