"""How a variable departs, and in which situations, in words."""

from runtime.program import Unit
from verifier.report.report import RegionMean, Standing, VariableResult
from verifier.report.wording import listed, number, quantity, span


def exceeded(result: VariableResult, units: dict[str, Unit]) -> str:
    """The variable, by how much, against what, how much of it is systematic, and where.

    `heading departs by 0.033 rad after 5 s (0.02 rad is allowed), at least 0.028 rad of it
    systematically: where it should fall by 0.4 rad, it ends 0.034 rad above the prediction`.
    """
    figure, unit = result.declared, result.unit
    least = quantity(result.systematic, unit)
    share = (
        f", at least {least} of it systematically"
        if result.systematic <= figure.departure
        else f", and in some situations by at least {least} systematically"
    )
    return (
        f"{result.name} departs by {quantity(figure.departure, unit)} after"
        f" {number(figure.horizon)} s ({quantity(result.tolerance, unit)} is allowed){share}"
        f"{_worst(result, units)}"
    )


def stands(result: VariableResult) -> str:
    """Where a variable stands against its tolerance, in a few words."""
    if result.standing is Standing.EXCEEDED and result.declared.standing is not Standing.EXCEEDED:
        return f"{result.standing} in some situations"
    return str(result.standing)


def _worst(result: VariableResult, units: dict[str, Unit]) -> str:
    """In which situation it is worst, and in which direction; none may stand out."""
    region = result.worst
    if region is None or abs(region.mean) <= result.tolerance:
        return ": windows in the same situation err alike"
    side = "above" if region.mean > 0.0 else "below"
    ends = sorted([abs(region.interval.low), abs(region.interval.high)])
    place = where(region, result.unit, units)
    return (
        f": {f'{place}, it' if place else 'it'} ends {quantity(abs(region.mean), result.unit)}"
        f" {side} the prediction on average (95 % interval {span(ends[0], ends[1], result.unit)},"
        f" {region.windows} windows)"
    )


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
        told.append(
            f"its rate should {'rise' if region.hurried > 0.0 else 'fall'} during the window"
        )
    return f"where {listed(told)}" if told else ""


def _way(moved: float, unit: Unit) -> str:
    if moved == 0.0:
        return "stay"
    return f"{'rise' if moved > 0.0 else 'fall'} by {quantity(abs(moved), unit)}"
