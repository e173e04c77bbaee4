"""What an effect is called once its numbers are known."""

from typing import Final

from verifier.diagnosis.altered import Effect, Values
from verifier.diagnosis.candidates.readings import ANGLES, LENGTHS
from verifier.report.diagnosis import CandidateKind, ParameterKind
from verifier.report.wording import listed

NEAR: Final = 0.1
"""A gain within this share of a slip's factor is that slip."""
SIGNED: Final = (ParameterKind.INPUT_GAIN, ParameterKind.RATE_GAIN, ParameterKind.SENSOR_SCALE)


def kind_of(effect: Effect, values: Values) -> CandidateKind:
    """Delays by their direction, gains by their size."""
    if effect.kind is CandidateKind.DEAD_TIME and values[0] < 0.0:
        return CandidateKind.LATE_LOG
    if effect.parameter in SIGNED:
        if abs(values[0] + 1.0) < NEAR:
            return CandidateKind.SIGN
        if slip_of(values[0]):
            return CandidateKind.UNIT_SLIP
    return effect.kind


def label_of(effect: Effect, values: Values) -> str:
    """A short name: `late log of turn`, `sign of turn`."""
    kind, names = kind_of(effect, values), listed(list(effect.applies_to))
    if effect.label.startswith("delay of "):
        return f"{kind} of {names}"
    if kind is CandidateKind.SIGN:
        return f"sign of {names}"
    if kind is CandidateKind.UNIT_SLIP:
        return f"{slip_of(values[0])} in {names}"
    return effect.label


def slip_of(factor: float) -> str:
    """The unit slip that this factor would mend; empty if it is none.

    >>> slip_of(0.0175), slip_of(1.2)
    ('degrees for radians', '')
    """
    near = [words for words, f in (ANGLES | LENGTHS).items() if abs(factor / f - 1.0) < NEAR]
    return near[0] if near else ""
