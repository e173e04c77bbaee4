"""Ways between modes that never open, or that open again at once."""

from collections.abc import Iterator, Mapping
from typing import Final

import numpy as np

from compiler.declare import Declarations
from compiler.findings import Findings
from compiler.read_modes import Way
from spec_schema.expressions.bounds import bounds
from spec_schema.expressions.evaluate import evaluate
from spec_schema.expressions.rewrite import substitute
from spec_schema.field_modes import Modes

PLACES: Final = 24
"""Places where a way opens that are looked at; each is found between two random points."""
PAIRS: Final = 8 * PLACES
HALVINGS: Final = 40
SLACK: Final = 1e-6
"""What counts as zero, as a share of the largest value that a condition was seen to have."""
SEED: Final = 11


def check_ways(
    form: Modes, ways: tuple[Way, ...], declared: Declarations, findings: Findings
) -> None:
    """A warning for each way that can't open, and for each that follows another at once."""
    values = declared.values.get(form.of, ())
    box = _box(declared)
    for way in ways:
        _, highest = bounds(way.condition, box)
        if highest < 0.0:
            message = f"this way out of '{values[way.mode]}' never opens within the domains"
            remedy = "mend the condition, widen a domain, or remove the way"
            findings.warning("S257", (*way.path, "when"), message, remedy)
    places = {way.path: tuple(_openings(way, box, declared)) for way in ways}
    for way in ways:
        for after in ways:
            if after.mode != way.target:
                continue
            if _follows_at_once(way, after, places[way.path], _size(after, box, declared)):
                message = (
                    f"where this way leads to '{values[way.target]}', the way on to "
                    f"'{values[after.target]}' is open already, so no time is spent there"
                )
                remedy = "keep the two conditions apart, or reset a state so that the next is shut"
                findings.warning("S258", (*way.path, "when"), message, remedy)


def _box(declared: Declarations) -> dict[str, tuple[float, float]]:
    constants = {constant.name: (constant.value, constant.value) for constant in declared.constants}
    return {part.name: (part.low, part.high) for part in declared.variables} | constants


def _openings(
    way: Way, box: Mapping[str, tuple[float, float]], declared: Declarations
) -> Iterator[dict[str, float]]:
    """Places of the domain where the way's condition passes through zero."""
    rng = np.random.default_rng(SEED)
    found = 0
    for _ in range(PAIRS):
        ends = [_random(box, declared, rng) for _ in range(2)]
        ends[1] |= {name: ends[0][name] for name in declared.values}
        signs = [evaluate(way.condition, end) >= 0.0 for end in ends]
        if signs[0] != signs[1]:
            shut, open_ = (ends[0], ends[1]) if signs[1] else (ends[1], ends[0])
            yield _crossing(way, shut, open_)
            found += 1
        if found == PLACES:
            return


def _random(
    box: Mapping[str, tuple[float, float]], declared: Declarations, rng: np.random.Generator
) -> dict[str, float]:
    found = {name: float(rng.uniform(low, high)) for name, (low, high) in box.items()}
    for name, values in declared.values.items():
        found[name] = float(rng.integers(len(values)))
    return found


def _crossing(way: Way, shut: dict[str, float], open_: dict[str, float]) -> dict[str, float]:
    """The place between two others where the condition becomes zero or more."""
    for _ in range(HALVINGS):
        middle = {name: 0.5 * (shut[name] + open_[name]) for name in shut}
        if evaluate(way.condition, middle) >= 0.0:
            open_ = middle
        else:
            shut = middle
    return open_


def _size(way: Way, box: Mapping[str, tuple[float, float]], declared: Declarations) -> float:
    """How large the way's condition becomes."""
    rng = np.random.default_rng(SEED)
    found = [abs(evaluate(way.condition, _random(box, declared, rng))) for _ in range(PLACES)]
    return max(found)


def _follows_at_once(
    way: Way, after: Way, places: tuple[dict[str, float], ...], size: float
) -> bool:
    """Whether `after`, as large as `size`, is open wherever `way` has just been taken."""
    condition = substitute(after.condition, way.resets)
    values = [evaluate(condition, place) for place in places]
    return bool(values) and min(values) >= -SLACK * size
