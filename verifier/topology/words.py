"""Features, places and settings in words, in the users' units."""

from collections import Counter
from collections.abc import Iterable
from typing import Final

from runtime.program import Control, Program, State
from verifier.topology.features import AxisRange, Cycle, FixedPoint, Portrait, Settings, Standing

ROUNDING: Final = 1e-9
"""What is smaller than this share of a domain's width is shown as 0."""


def plural(feature: str, count: int) -> str:
    """The name of a feature, for so many.

    >>> plural("stable focus", 2), plural("saddle", 1)
    ('stable foci', 'saddle')
    """
    if count == 1:
        return feature
    return f"{feature[:-2]}i" if feature.endswith("us") else f"{feature}s"


def described_point(axes: tuple[AxisRange, ...], point: FixedPoint) -> str:
    """A fixed point: its type and place."""
    invented = ", invented by the interpolation" if point.standing is Standing.INVENTED else ""
    return f"{point.kind} at {place_words(axes, point.at)}{invented}"


def described_cycle(axes: tuple[AxisRange, ...], cycle: Cycle) -> str:
    """A cycle: its stability, period and reach on the first axis."""
    reach = ", ".join(
        f"{axis.name} from {shown(axis, float(cycle.points[:, j].min()))} to "
        f"{shown(axis, float(cycle.points[:, j].max()))}"
        for j, axis in enumerate(axes[:1])
    )
    return f"{cycle.stability} cycle with period {cycle.period:.6g} s ({reach})"


def place_words(axes: tuple[AxisRange, ...], at: Iterable[float]) -> str:
    """A place: `x = 0.5 m, v = 0 m/s`."""
    return ", ".join(
        f"{axis.name} = {shown(axis, float(value))}" for axis, value in zip(axes, at, strict=True)
    )


def listed_features(seen: Portrait) -> str:
    """What there is in a portrait, by type."""
    kinds = Counter(
        [str(point.kind) for point in seen.fixed_points]
        + [f"{cycle.stability} cycle" for cycle in seen.cycles]
    )
    if not kinds:
        return "there is no fixed point and no cycle"
    verb = "is" if kinds.total() == 1 else "are"
    return f"there {verb} " + ", ".join(
        f"{count} {plural(kind, count)}" for kind, count in kinds.items()
    )


def settings_words(program: Program, settings: Settings) -> str:
    """Values of controls and states in their own units: `mu = 0.5, gain = 2 1/s`."""
    named: list[State | Control] = [*program.states, *program.controls]
    parts = {part.name: part for part in named}
    return ", ".join(f"{name} = {value_words(parts[name], value)}" for name, value in settings)


def value_words(part: State | Control, value: float) -> str:
    """A value of a state or control, in its own unit, or by its name."""
    if isinstance(part, State) and part.values:
        return part.values[round(value)]
    unit = "" if part.unit.text == "1" else f" {part.unit.text}"
    if abs(value) < ROUNDING * (part.high - part.low):
        value = 0.0
    return f"{value / part.unit.scale + 0.0:.6g}{unit}"


def share_words(share: float, within: float = 0.0) -> str:
    """A share of the domain, with how far it may be off, both in per cent.

    >>> share_words(0.867, 0.0123), share_words(1.0), share_words(0.9996, 0.00021)
    ('86.7 ± 1.2 %', '100.0 %', '99.96 ± 0.02 %')
    """
    if within == 0.0:
        return f"{100.0 * share:.1f} %"
    decimals = 1 if within >= 0.0005 else 2
    off = max(100.0 * within, 10.0**-decimals)
    return f"{100.0 * share:.{decimals}f} ± {off:.{decimals}f} %"


def shown(axis: AxisRange, value: float) -> str:
    """A value on an axis for people, in its unit."""
    text = "" if axis.unit.text == "1" else f" {axis.unit.text}"
    return f"{_clean(axis, value) / axis.unit.scale + 0.0:.5g}{text}"


def _clean(axis: AxisRange, value: float) -> float:
    """Rounding errors beside the domain's width are zero."""
    return 0.0 if abs(value) < ROUNDING * axis.width else value
