"""A claim as its author wrote it: the sentence and its conditions, on one line."""

from collections.abc import Mapping

from spec_schema.expect import ClaimOptions, ClaimSpec
from spec_schema.units import Unit


def claim_text(claim: ClaimSpec, units: Mapping[str, Unit]) -> str:
    """The sentence and all conditions but `over`: `one saddle at x = gap (within 2 %)`.

    units: of states and controls, for plain numbers.
    """
    options = claim.options
    text = claim.sentence
    if options.at:
        text += f" at {_values(options.at, units)}"
    if options.reaches:
        text += f" reaching {_reaches(options, units)}"
    if options.period is not None:
        unit = "" if isinstance(options.period, str) else " s"
        text += f" with period {_number(options.period)}{unit}"
    if options.within is not None:
        rooms = (
            f"{name} {_value(room, units.get(name))}".strip()
            for name, room in options.within.root.items()
        )
        text += f" (within {', '.join(rooms)})"
    if options.where:
        text += f" where {_values(options.where, units)}"
    return f"{text}, called {options.called}" if options.called else text


def _values(given: Mapping[str, float | str], units: Mapping[str, Unit]) -> str:
    return ", ".join(f"{name} = {_value(v, units.get(name))}" for name, v in given.items())


def _reaches(options: ClaimOptions, units: Mapping[str, Unit]) -> str:
    return ", ".join(
        f"{name} from {_value(low, units.get(name))} to {_value(high, units.get(name))}"
        for name, (low, high) in options.reaches.items()
    )


def _value(value: float | str, unit: Unit | None) -> str:
    """As written; a plain number gets the unit that it is in."""
    plain = isinstance(value, str) or unit is None or unit.text == "1"
    return _number(value) if plain or unit is None else f"{_number(value)} {unit.text}"


def _number(value: float | str) -> str:
    return value if isinstance(value, str) else f"{value:.12g}"
