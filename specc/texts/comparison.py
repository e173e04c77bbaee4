"""A comparison of two behaviors as text for people and as a record for programs."""

import math
from collections import Counter
from typing import Final

from compiler.quantities import rate_text
from runtime.arrays import Array
from spec_schema.wording import with_article
from verifier.topology.comparing.comparison import Comparison, RateDifference
from verifier.topology.comparing.matching import Fate, Feature
from verifier.topology.features import AxisRange, Held

STYLES: Final = {True: "bold green", False: "bold red"}
"""Of the last word, by whether the behavior adheres."""

SAME: Final = 1e-9
"""Differences below this share of what is allowed are rounding."""


def comparison_text(comparison: Comparison) -> str:
    """What differs, one line each, the verdict last."""
    over = ", ".join(_range(axis) for axis in comparison.axes)
    rows = [f"{comparison.found} held against {comparison.wanted}, over {over}"]
    rows += [f"  {line}" for line in taken_lines(comparison)]
    rows += [f"  {_rate(comparison, rate)}" for rate in comparison.rates]
    rows += [f"  {_feature(comparison, feature)}" for feature in comparison.features]
    if not comparison.features:
        rows.append("  neither has a fixed point or a cycle here")
    return "\n".join([*rows, verdict_text(comparison)])


def taken_lines(comparison: Comparison) -> list[str]:
    """At which values of controls and held states both were taken, and where these differ."""
    taken = comparison.taken
    same = [one for one in taken if one.found and one.wanted and not one.differs]
    other = [one for one in taken if one.differs]
    lines = []
    if same:
        lines.append(f"both at {', '.join(f'{one.name} = {_held(one.found)}' for one in same)}")
    if other:
        pairs = (f"{one.name} = {_held(one.found)} against {_held(one.wanted)}" for one in other)
        lines.append(
            f"at values that differ: {', '.join(pairs)}; `--set {other[0].name}=...` sets both"
        )
    for side, name in (("found", comparison.found), ("wanted", comparison.wanted)):
        alone = [getattr(one, side) for one in taken if not (one.found and one.wanted)]
        words = [f"{held.name} = {_held(held)}" for held in alone if held]
        if words:
            lines.append(f"only {name}: {', '.join(words)}")
    return lines


def _held(held: Held | None) -> str:
    """A value that is held, in its own unit or by its name."""
    if held is None:
        return "nothing"
    unit = "" if held.unit.text == "1" else f" {held.unit.text}"
    return held.label or f"{held.value / held.unit.scale:.6g}{unit}"


def _held_value(held: Held | None) -> float | str | None:
    return None if held is None else held.label or float(f"{held.value / held.unit.scale:.15g}")


def verdict_text(comparison: Comparison) -> str:
    """`adheres`, or in how far it does not."""
    if comparison.adheres:
        return "adheres"
    parts = []
    if comparison.within < 1.0:
        parts.append(f"the field is out of tolerance at {_percent(1.0 - comparison.within)}")
    counts = Counter(feature.fate for feature in comparison.features)
    parts += [f"{counts[fate]} {fate}" for fate in Fate if fate is not Fate.SAME and counts[fate]]
    return f"does not adhere: {', '.join(parts)}"


def comparison_record(comparison: Comparison) -> dict[str, object]:
    """What `specc compare --format json` prints; values in the wanted behavior's units."""
    axes = comparison.axes
    return {
        "found": comparison.found,
        "wanted": comparison.wanted,
        "adheres": comparison.adheres,
        "domain": {a.name: [a.low / a.unit.scale, a.high / a.unit.scale] for a in axes},
        "units": {axis.name: axis.unit.text for axis in axes},
        "taken_at": {
            one.name: {
                "found": _held_value(one.found),
                "wanted": _held_value(one.wanted),
                "units": [held.unit.text if held else None for held in (one.found, one.wanted)],
                "differs": one.differs,
            }
            for one in comparison.taken
        },
        "tolerances": {
            "field": comparison.tolerances.field,
            "features": comparison.tolerances.features,
        },
        "within": comparison.within,
        "rates": {
            rate.axis.name: {
                "largest": _number(rate.largest / rate.axis.unit.scale),
                "allowed": rate.allowed / rate.axis.unit.scale,
                "at": _place(axes, rate.at),
                "within": rate.within,
            }
            for rate in comparison.rates
        },
        "features": [
            {
                "fate": str(feature.fate),
                "found": feature.found or None,
                "wanted": feature.wanted or None,
                "at": _place(axes, feature.at),
                "moved": _place(axes, feature.moved),
                "periods": [period or None for period in feature.periods],
            }
            for feature in comparison.features
        ],
    }


def _rate(comparison: Comparison, rate: RateDifference) -> str:
    axis = rate.axis
    what = f"{axis.name} a step later" if comparison.is_map else f"{axis.name}'"
    unit = axis.unit.text if comparison.is_map else rate_text(axis.unit.text)
    if rate.largest <= SAME * rate.allowed:
        return f"{what} is the same everywhere"
    place = _words(comparison.axes, rate.at)
    if not math.isfinite(rate.largest):
        return f"{what} has a value in one of them only at {place}"
    scale = axis.unit.scale
    return (
        f"{what} is off by at most {rate.largest / scale:.3g} {unit}, at {place}; "
        f"allowed are {rate.allowed / scale:.3g}; kept at {_percent(rate.within)}"
    )


def _percent(share: float) -> str:
    """Rounded towards the middle: nothing but all is `100 %`."""
    rounded = f"{100.0 * share:.1f}"
    if share < 1.0 and rounded == "100.0":
        return "more than 99.9 % of the places"
    return f"{rounded.removesuffix('.0')} % of the places"


def _feature(comparison: Comparison, feature: Feature) -> str:
    at = _words(comparison.axes, feature.at)
    found, wanted = feature.periods
    match feature.fate:
        case Fate.SAME | Fate.MOVED:
            gap = _words(comparison.axes, feature.moved, "by")
            period = f", period {found:.4g} s for {wanted:.4g} s" if found else ""
            apart = f"moved by {gap}" if feature.fate is Fate.MOVED else f"off by {gap}"
            return f"{feature.fate}: {feature.found} at {at}, {apart}{period}"
        case Fate.CHANGED:
            return f"changed: {feature.wanted} is {with_article(str(feature.found))} here, at {at}"
        case Fate.MISSING:
            return f"missing: {feature.wanted} at {at}"
        case Fate.EXTRA:
            return f"extra: {feature.found} at {at}"


def _words(axes: tuple[AxisRange, ...], point: Array, what: str = "at") -> str:
    """A place `x = 1 m, v = 2 m/s`, or with "by" a distance `x 1 m, v 2 m/s`."""
    equals = " = " if what == "at" else " "
    return ", ".join(
        f"{a.name}{equals}{_shown(a, value)}" for a, value in zip(axes, point, strict=True)
    )


def _shown(axis: AxisRange, value: float) -> str:
    tiny = abs(value) < 1e-9 * axis.width
    unit = "" if axis.unit.text == "1" else f" {axis.unit.text}"
    return f"{0.0 if tiny else value / axis.unit.scale:.4g}{unit}"


def _range(axis: AxisRange) -> str:
    scale = axis.unit.scale
    unit = "" if axis.unit.text == "1" else f" {axis.unit.text}"
    return f"{axis.name} [{axis.low / scale:g}, {axis.high / scale:g}]{unit}"


def _place(axes: tuple[AxisRange, ...], point: Array) -> dict[str, float | None]:
    return {
        axis.name: _number(float(value) / axis.unit.scale)
        for axis, value in zip(axes, point, strict=True)
    }


def _number(value: float) -> float | None:
    return value if math.isfinite(value) else None
