"""States that stop at a bound: `|x| <= L`, `x <= L` or `x >= L`; beyond it their rate is zero.

A bound shows in the log as samples that pile up at an extreme value, so fits begin near there.
"""

from dataclasses import dataclass
from enum import Enum
from typing import Final, final

import numpy as np

from runtime.arrays import Array
from verifier.diagnosis.altered import Altered, Effect, Number, Values
from verifier.diagnosis.loosened import PACE, least_of, most_of
from verifier.diagnosis.scene import Observed, Scene
from verifier.report.diagnosis import CandidateKind

QUANTILES: Final = (0.99, 0.95, 0.85)
"""Where fits of a bound begin: so much of what was seen lies within it."""
WITHIN: Final = 0.5
"""At least so much does."""
EVEN: Final = 0.8
"""Two sides that reach as far but for this factor may have one bound."""


@final
class Side(Enum):
    """On which side a state is bounded, with how far it goes in words."""

    BOTH = "no further than {} to either side"
    UPPER = "no higher than {}"
    LOWER = "no lower than {}"


def effects_of_bounds(scene: Scene) -> tuple[Effect, ...]:
    """Of every driven state that does not go round a circle."""
    field = scene.program.field
    if field.is_map or field.formula is None:
        return ()
    return tuple(
        _effect(scene, each, side)
        for each in scene.observed
        if each.name in field.driven and each.turn == 0.0
        for side in _sides(each.values[each.used])
    )


def _sides(values: Array) -> tuple[Side, ...]:
    low, high = -float(np.min(values)), float(np.max(values))
    if min(low, high) > EVEN * max(low, high):
        return (Side.BOTH, Side.UPPER, Side.LOWER)
    return (Side.UPPER, Side.LOWER)


def _effect(scene: Scene, observed: Observed, side: Side) -> Effect:
    """Its neutral value is far beyond all that was seen."""
    name = observed.name
    sign = -1.0 if side is Side.LOWER else 1.0
    values = observed.values[observed.used]
    seen = np.abs(values) if side is Side.BOTH else sign * values
    inner, *begins = (sign * float(np.quantile(seen, q)) for q in (WITHIN, *QUANTILES))
    far = sign * (float(np.max(seen)) + observed.width)
    (state,) = (each for each in scene.program.states if each.name == name)
    low, high = sorted((inner, far))
    number = Number("bound", state.unit, far, 1e-4 * observed.width, low, high)
    return Effect(
        kind=CandidateKind.BOUND,
        applies_to=(name,),
        label=_label(name, side),
        numbers=(number,),
        apply=_Stop(name, side, far),
        origin=scene.program.field.origin,
        starts=tuple((each,) for each in begins),
        detail=side.value,
    )


def _label(name: str, side: Side) -> str:
    return f"bound of {name}" if side is Side.BOTH else f"{side.name.lower()} bound of {name}"


@final
@dataclass(frozen=True, slots=True)
class _Stop:
    name: str
    side: Side
    far: float

    def __call__(self, setting: Altered, values: Values) -> Altered:
        (bound,) = values
        if abs(bound) >= abs(self.far):
            return setting
        setting = setting.moved(PACE, 1.0)
        if self.side is Side.LOWER:
            return setting.moved(least_of(self.name), bound)
        if self.side is Side.BOTH:
            setting = setting.moved(least_of(self.name), -bound)
        return setting.moved(most_of(self.name), bound)
