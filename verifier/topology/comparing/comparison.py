"""One behavior held against another: place by place, and feature by feature.

The first one is what there is, such as code; the second one what is wanted, such as a sketch
(thesis, section 3.2.2). m: number of axes; widths: of the part of the domains that both share.
"""

import math
from dataclasses import dataclass
from pathlib import PurePath
from typing import Final, final

import numpy as np

from runtime.arrays import Array, frozen
from runtime.program import Program
from verifier.topology.comparing.matching import Fate, Feature, matched_features
from verifier.topology.features import AxisRange, Held, Portrait
from verifier.topology.slices import Slice, cut, rates_at, shortest

PLACES: Final = {1: 2001, 2: 141, 3: 31}
"""Places per axis at which fields are compared, by the number of axes."""


@final
class ComparisonError(Exception):
    """Behaviors that can't be compared; `code` of the documentation, and why in a sentence."""

    def __init__(self, code: str, message: str) -> None:
        """Keep the code beside the message."""
        super().__init__(message)
        self.code = code


@final
@dataclass(frozen=True, slots=True)
class Tolerances:
    """field: of each rate, as a share of its largest size; features: of places, of the widths."""

    field: float = 0.05
    features: float = 0.05


@final
@dataclass(frozen=True, eq=False, slots=True)
class Side:
    """A behavior, and its portrait as it is to be compared."""

    program: Program
    portrait: Portrait


@final
@dataclass(frozen=True, eq=False, slots=True)
class RateDifference:
    """How far one rate is off: at most `largest` (SI), at the place `at` (m,); allowed (SI).

    within: the share of places where it is off by no more than is allowed.
    """

    axis: AxisRange
    largest: float
    at: Array
    allowed: float
    within: float


@final
@dataclass(frozen=True, slots=True)
class Taken:
    """At which value each side had a control or held state; None: it has no such."""

    name: str
    found: Held | None
    wanted: Held | None

    @property
    def differs(self) -> bool:
        """Whether both have it, at values that are not the same."""
        if self.found is None or self.wanted is None:
            return False
        if self.found.label or self.wanted.label:
            return self.found.label != self.wanted.label
        ours, theirs = self.found.value, self.wanted.value
        return not math.isclose(ours, theirs, rel_tol=1e-9, abs_tol=1e-12)


@final
@dataclass(frozen=True, eq=False, slots=True)
class Comparison:
    """What differs between `found` and `wanted`, names of behaviors or files, over `axes`.

    taken: the values that controls and held states had. axes: what both domains share. worst:
    (n1, ..., nm) the largest difference of a rate in units of what is allowed, on `nodes`;
    infinite where only one field has a value.
    """

    found: str
    wanted: str
    axes: tuple[AxisRange, ...]
    is_map: bool
    tolerances: Tolerances
    rates: tuple[RateDifference, ...]
    within: float
    features: tuple[Feature, ...]
    nodes: tuple[Array, ...]
    worst: Array
    taken: tuple[Taken, ...] = ()

    @property
    def adheres(self) -> bool:
        """Whether the field is within tolerance everywhere, and every feature is the same."""
        return self.within == 1.0 and all(one.fate is Fate.SAME for one in self.features)


def compare(found: Side, wanted: Side, tolerances: Tolerances) -> Comparison:
    """Hold `found` against `wanted`, over the axes of their portraits.

    Raises:
        ComparisonError: other axes, domains that have nothing in common, a map and a flow.
    """
    axes = _shared_axes(found.portrait, wanted.portrait)
    views = _view(found), _view(wanted)
    nodes, points = _places(axes)
    ours, theirs = rates_at(views[0], points), rates_at(views[1], points)
    if views[0].is_map:
        ours = shortest(views[0], ours - theirs) + theirs
    allowed = _allowed(theirs, tolerances.field)
    share = _shares(ours, theirs, allowed)
    names = _names(found.program, wanted.program)
    return Comparison(
        found=names[0],
        wanted=names[1],
        axes=axes,
        is_map=views[0].is_map,
        tolerances=tolerances,
        rates=tuple(
            _rate(axes, points, (ours - theirs)[..., j], share[..., j], allowed, j)
            for j in range(len(axes))
        ),
        within=_within(share.max(axis=-1)),
        features=matched_features(
            views[0], found.portrait, wanted.portrait, axes, tolerances.features
        ),
        nodes=nodes,
        worst=frozen(share.max(axis=-1)),
        taken=_taken(found.portrait, wanted.portrait),
    )


def _names(found: Program, wanted: Program) -> tuple[str, str]:
    """The names of the behaviors; of their files where the behaviors are called the same."""
    files = [PurePath(program.source.file or program.name) for program in (found, wanted)]
    for ours, theirs in (
        (found.name, wanted.name),
        (files[0].name, files[1].name),
        (str(files[0]), str(files[1])),
    ):
        if ours != theirs:
            return ours, theirs
    return found.name, wanted.name


def _taken(found: Portrait, wanted: Portrait) -> tuple[Taken, ...]:
    """What either portrait holds still, by name, those of the found one first."""
    ours, theirs = ({held.name: held for held in portrait.held} for portrait in (found, wanted))
    return tuple(
        Taken(name, ours.get(name), theirs.get(name)) for name in dict.fromkeys([*ours, *theirs])
    )


def _view(side: Side) -> Slice:
    portrait = side.portrait
    held = {one.name: one.value for one in portrait.held}
    return cut(side.program, tuple(axis.name for axis in portrait.axes), held)


def _shared_axes(found: Portrait, wanted: Portrait) -> tuple[AxisRange, ...]:
    """What the domains of both share, on every axis."""
    names = [[axis.name for axis in portrait.axes] for portrait in (found, wanted)]
    if names[0] != names[1]:
        raise ComparisonError(
            "V361",
            f"the axes of '{found.name}' are {', '.join(names[0])}, "
            f"those of '{wanted.name}' are {', '.join(names[1])}",
        )
    if (found.every > 0.0) is not (wanted.every > 0.0):
        step, flow = (found, wanted) if found.every > 0.0 else (wanted, found)
        raise ComparisonError("V363", f"'{step.name}' is a step map, '{flow.name}' is none")
    return tuple(_shared(a, b) for a, b in zip(found.axes, wanted.axes, strict=True))


def _shared(a: AxisRange, b: AxisRange) -> AxisRange:
    if a.periodic and b.periodic and np.isclose(a.width, b.width):
        return b
    low, high = max(a.low, b.low), min(a.high, b.high)
    if not low < high:
        raise ComparisonError(
            "V362", f"the domains of '{a.name}' have nothing in common: {_text(a)} and {_text(b)}"
        )
    return AxisRange(b.name, b.unit, low, high, periodic=False)


def _text(axis: AxisRange) -> str:
    scale = axis.unit.scale
    return f"[{axis.low / scale:g}, {axis.high / scale:g}] {axis.unit.text}"


def _places(axes: tuple[AxisRange, ...]) -> tuple[tuple[Array, ...], Array]:
    count = PLACES[len(axes)]
    nodes = tuple(frozen(np.linspace(axis.low, axis.high, count)) for axis in axes)
    return nodes, np.stack(np.meshgrid(*nodes, indexing="ij"), axis=-1)


def _allowed(wanted: Array, tolerance: float) -> Array:
    """What each rate may be off, (m,): a share of its largest size, or of that of any if it is 0.

    A rate that is nowhere else than zero has no size of its own.
    """
    sizes = np.nan_to_num(np.abs(wanted)).reshape(-1, wanted.shape[-1]).max(axis=0)
    return np.asarray(tolerance * np.where(sizes > 0.0, sizes, max(float(sizes.max()), 1e-300)))


def _shares(found: Array, wanted: Array, allowed: Array) -> Array:
    """Differences (..., m) in units of what is allowed; infinite where only one has a value."""
    one, other = np.isfinite(found), np.isfinite(wanted)
    with np.errstate(invalid="ignore"):
        share = np.abs(found - wanted) / allowed
    return np.where(one & other, share, np.where(one == other, 0.0, np.inf))


def _within(share: Array) -> float:
    return float(np.mean(share <= 1.0))


def _rate(
    axes: tuple[AxisRange, ...],
    points: Array,
    difference: Array,
    share: Array,
    allowed: Array,
    j: int,
) -> RateDifference:
    worst = np.unravel_index(int(np.argmax(share)), share.shape)
    largest = float(np.abs(difference[worst])) if np.isfinite(difference[worst]) else float("inf")
    return RateDifference(
        axes[j], largest, frozen(points[worst]), float(allowed[j]), _within(share)
    )
