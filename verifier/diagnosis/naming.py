"""What an effect is called once its numbers are known."""

from typing import Final

from verifier.diagnosis.altered import Effect, Values
from verifier.mixed_units import slip_by
from verifier.report.diagnosis import CandidateKind, ParameterKind
from verifier.report.wording import listed

AWRY: Final = 0.1
"""A gain within so much of -1 is a wrong sign."""
SIGNED: Final = (ParameterKind.INPUT_GAIN, ParameterKind.RATE_GAIN, ParameterKind.SENSOR_SCALE)


def kind_of(effect: Effect, values: Values) -> CandidateKind:
    """Delays by their direction, gains by their size."""
    if effect.kind is CandidateKind.DEAD_TIME and values[0] < 0.0:
        return CandidateKind.LATE_LOG
    if effect.parameter in SIGNED:
        if abs(values[0] + 1.0) < AWRY:
            return CandidateKind.SIGN
        if slip_of(effect, values):
            return CandidateKind.UNIT_SLIP
    return effect.kind


def label_of(effect: Effect, values: Values) -> str:
    """A short name: `turn logged late`, `sign of turn`."""
    kind, names = kind_of(effect, values), listed(list(effect.applies_to))
    if effect.is_delay:
        if kind is CandidateKind.LATE_LOG:
            return f"{names} logged {'early' if values[0] > 0.0 else 'late'}"
        return f"{kind} of {names}"
    if kind is CandidateKind.SIGN:
        return f"sign of {names}"
    if kind is CandidateKind.UNIT_SLIP:
        return f"{slip_of(effect, values)} in {names}"
    return effect.label


def slip_of(effect: Effect, values: Values) -> str:
    """The unit slip that this gain would mend, in words; empty if it is none.

    A sensor's scale is what the log has too much of: its inverse mends it.
    """
    is_scale = effect.parameter is ParameterKind.SENSOR_SCALE
    factor = 1.0 / values[0] if is_scale and values[0] != 0.0 else values[0]
    slip = slip_by(factor, effect.slips)
    return "" if slip is None else slip.words
