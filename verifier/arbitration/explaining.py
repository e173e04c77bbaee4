"""What would make the spec decide as the robot: other thresholds, decisions that come late."""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arbiter import Arbiter
from runtime.arrays import Booleans, Integers
from runtime.program import Unit
from verifier.arbitration.choosing import RuleChooser
from verifier.arbitration.comparisons import Comparison, infix, is_number
from verifier.arbitration.decisions import Decisions
from verifier.arbitration.refitting import (
    Scales,
    agreeing,
    is_better,
    later,
    refitted,
    roundest,
    scan,
)
from verifier.report.arbitration import Explanation, Stray, Threshold, ThresholdStanding
from verifier.report.report import Interval
from verifier.report.wording import exact

LATEST: Final = 20
"""Samples by which a robot may decide late."""
MOST_STRAYS: Final = 10
MOST_MOVED: Final = 12
"""Of more thresholds, as learned rules have them, none is moved: each would take seconds."""
UNTOLD_WIDTH: Final = 0.1
"""A threshold known no better than to this share of what was read is not told."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Explained:
    """The change of the spec that explains most: decided by `chooser`, `delay` samples later.

    agrees: (T,) with whom. tried: all changes that were, the best first.
    """

    chooser: RuleChooser
    delay: int
    agrees: Booleans
    tried: tuple[Explanation, ...]


def explained_by(
    arbiter: Arbiter, rules: RuleChooser, decisions: Decisions, agrees: Booleans, scales: Scales
) -> Explained:
    """Thresholds moved, decisions that come late, or both; the simplest that is no worse."""
    if bool(agrees[decisions.judged].all()):
        return Explained(rules, 0, agrees, ())
    options = []
    for k in dict.fromkeys((0, _delay(rules, decisions, scales))):
        options.append((rules, k))
        if can_move(rules):
            options.append((refitted(rules, later(decisions, k), scales), k))
    tried = [(c, k, agreeing(c, later(decisions, k))) for c, k in options]
    best = tried[0]
    for option in tried[1:]:
        if is_better(option[2], best[2], scales):
            best = option
    told = tuple(
        Explanation(_label(arbiter, rules, c, k, decisions), int(a.sum())) for c, k, a in tried[1:]
    )
    told = tuple(sorted({e.label: e for e in told if e.label}.values(), key=lambda e: -e.agreeing))
    return Explained(best[0], best[1], best[2], told)


def can_move(rules: RuleChooser) -> bool:
    """Whether thresholds are few enough to be moved one by one."""
    return len(rules.values) <= MOST_MOVED


def _delay(rules: RuleChooser, decisions: Decisions, scales: Scales) -> int:
    """By how many samples it decides late, where that is shown to explain decisions; else 0."""
    expected = rules(decisions)

    def agrees(samples: int) -> Booleans:
        moved = later(decisions, samples)
        agreed: Booleans = (expected == moved.chosen) & moved.judged
        return agreed

    most = min(LATEST, decisions.times.size // 10)
    counts = {k: int(agrees(k).sum()) for k in range(-min(most, 3), most + 1)}
    best = max(counts, key=lambda k: (counts[k], -abs(k)))
    return best if best and is_better(agrees(best), agrees(0), scales) else 0


def _label(
    arbiter: Arbiter, rules: RuleChooser, moved: RuleChooser, delay: int, decisions: Decisions
) -> str:
    parts = [
        f"{_name_of(each)} {exact(moved.values[each.entry], unit_of(arbiter, each))} instead of"
        f" {exact(rules.values[each.entry], unit_of(arbiter, each))}"
        for each in _one_each(rules)
        if moved.values[each.entry] != rules.values[each.entry]
    ]
    if delay:
        when = "later" if delay > 0 else "earlier"
        parts.append(f"decisions {abs(delay) * decisions.period:.3g} s {when}")
    return ", ".join(parts)


def unit_of(arbiter: Arbiter, comparison: Comparison) -> Unit:
    """The unit of the constant or control, else of what is compared with it."""
    units = {read.name: read.unit for read in arbiter.reads}
    units |= {c.name: c.unit for c in arbiter.controls}
    units |= {c.name: c.unit for c in arbiter.constants}
    names = [name for name in comparison.reading.tokens if name in units]
    return units.get(comparison.side.text, units[names[0]] if names else Unit("1", 1.0))


def _name_of(comparison: Comparison) -> str:
    """The constant or control, or the whole comparison where it is a number."""
    side = comparison.side.text
    return infix(comparison.side) if not is_number(side) else comparison.text


def _one_each(rules: RuleChooser) -> tuple[Comparison, ...]:
    """The first comparison with each threshold."""
    return tuple({c.entry: c for c in reversed(rules.opened.comparisons)}.values())[::-1]


def thresholds_of(
    arbiter: Arbiter,
    rules: RuleChooser,
    explained: Explained,
    decisions: Decisions,
    scales: Scales,
) -> tuple[Threshold, ...]:
    """What the log says of each threshold, all others as explained; of too many, nothing."""
    if not can_move(rules):
        return ()
    moved = later(decisions, explained.delay)
    return tuple(
        _threshold(arbiter, each, rules, explained, moved, scales) for each in _one_each(rules)
    )


def _threshold(
    arbiter: Arbiter,
    comparison: Comparison,
    rules: RuleChooser,
    explained: Explained,
    decisions: Decisions,
    scales: Scales,
) -> Threshold:
    origins = {c.name: c.origin for c in arbiter.controls}
    origins |= {c.name: c.origin for c in arbiter.constants}
    names = [name for name in comparison.reading.tokens if name in arbiter.register]
    unit = unit_of(arbiter, comparison)
    own = rules.values[comparison.entry]
    found = scan(explained.chooser, comparison.entry, decisions, scales)
    low, high = found.interval.low, found.interval.high
    widest = _width(arbiter, names, decisions)
    if low <= own <= high:
        is_wide = high - low > UNTOLD_WIDTH * widest
        standing = ThresholdStanding.UNTOLD if is_wide else ThresholdStanding.KEPT
    else:
        standing = ThresholdStanding.MOVED
    return Threshold(
        name=_name_of(comparison),
        comparison=comparison.text,
        unit=unit,
        value=own,
        fitted=found.value
        if found.value == own
        else roundest(found.level, unit.scale, found.value),
        interval=Interval(low, high),
        agreeing=int(found.agrees.sum()),
        standing=standing,
        origin=origins.get(comparison.side.text, comparison.origin),
    )


def _width(arbiter: Arbiter, names: list[str], decisions: Decisions) -> float:
    """Of what was read where the threshold is compared."""
    places = [i for i, read in enumerate(arbiter.reads) if read.name in names]
    values = decisions.register[decisions.judged][:, places]
    return float(np.ptp(values)) if values.size else 0.0


def strays_of(
    arbiter: Arbiter, followed: Decisions, expected: Integers, agrees: Booleans
) -> tuple[Stray, ...]:
    """Stretches of decisions that are not as `expected` (T,), the longest first."""
    out = np.flatnonzero(followed.judged & ~agrees)
    if not out.size:
        return ()
    is_new = np.diff(out, prepend=-2) > 1
    is_new[1:] |= np.diff(followed.chosen[out]) != 0
    is_new[1:] |= np.diff(expected[out]) != 0
    groups = np.split(out, np.flatnonzero(is_new)[1:])
    found = [
        Stray(
            start=float(followed.times[group[0]]),
            end=float(followed.times[group[-1]]),
            decisions=group.size,
            robot=arbiter.choices[followed.chosen[group[0]]],
            spec=arbiter.choices[expected[group[0]]] if expected[group[0]] >= 0 else "nothing",
        )
        for group in groups
    ]
    return tuple(sorted(found, key=lambda each: -each.decisions)[:MOST_STRAYS])
