"""Situations in which a variable departs, in words."""

from runtime.program import Unit
from verifier.report.report import RegionMean
from verifier.report.wording import listed, quantity, span


def where(region: RegionMean, unit: Unit, units: dict[str, Unit]) -> str:
    """A situation in words, empty where it is every one.

    `where x is 0 to 1 m and it should fall by 0.3 m`. `it` is the variable, of this unit; units:
    of the names that bound the region.
    """
    told = [f"{name} is {value}" for name, value in region.values.items()]
    told += [
        f"{name} is {span(low, high, units[name])}" for name, (low, high) in region.bounds.items()
    ]
    if region.moved is not None:
        told.append(f"it should {_way(region.moved, unit)}")
    if region.hurried is not None:
        told.append(f"its rate should {'rise' if region.hurried > 0.0 else 'fall'} meanwhile")
    return f"where {listed(told)}" if told else ""


def _way(moved: float, unit: Unit) -> str:
    if moved == 0.0:
        return "stay"
    return f"{'rise' if moved > 0.0 else 'fall'} by {quantity(abs(moved), unit)}"
