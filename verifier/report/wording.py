"""Numbers and quantities as people read them. Values come in SI and leave in the user's unit."""

import math
from collections.abc import Sequence
from datetime import UTC, datetime
from typing import Final

from runtime.program import Unit

YEAR: Final = 365.25 * 86400.0
CENTURIES: Final = 200.0 * YEAR
"""Later than so many seconds after 1970 no robot was recorded."""
LEFT_OUT: Final = " is left out: "
"""Between a recording that is not judged with the others, and why."""
MILLIMETRE: Final = Unit("mm", 1e-3)


def number(value: float, digits: int = 3) -> str:
    """Three significant digits or so, without an exponent where that stays short.

    >>> number(0.0123456), number(1234.5), number(-2.0), number(1e-9), number(math.inf)
    ('0.0123', '1234', '-2', '1e-09', 'unbounded')
    """
    if math.isinf(value):
        return "unbounded"
    size = abs(value)
    if 10.0 ** (digits - 1) <= size < 1e6:
        return f"{value:.0f}"
    return f"{value:.{digits}g}"


def shown(value: float, unit: Unit) -> str:
    """A value in its unit, without the unit's name."""
    return number(value / unit.scale)


def quantity(value: float, unit: Unit) -> str:
    """A value with its unit; a dimensionless one has none, and a tiny length is in millimetres.

    >>> quantity(0.5, Unit("deg", 0.01745329)), quantity(0.5, Unit("1", 1.0))
    ('28.6 deg', '0.5')
    >>> quantity(2.57e-05, Unit("m", 1.0))
    '0.0257 mm'
    """
    unit = _fine(abs(value), unit)
    return f"{shown(value, unit)}{suffix(unit)}"


def _fine(size: float, unit: Unit) -> Unit:
    """Millimetres for a length below one of them that would be told in metres."""
    return MILLIMETRE if unit.text == "m" and 0.0 < size < MILLIMETRE.scale else unit


def exact(value: float, unit: Unit) -> str:
    """A value with its unit, in as many digits as a person would copy.

    >>> exact(0.4945, Unit("m", 1.0))
    '0.4945 m'
    """
    return f"{value / unit.scale:.6g}{suffix(unit)}"


def span(low: float, high: float, unit: Unit) -> str:
    """Two values, in as many digits as tell them apart.

    >>> span(0.1, 0.2, Unit("m", 1.0)), span(291.72, 292.34, Unit("K", 1.0))
    ('0.1 to 0.2 m', '291.7 to 292.3 K')
    >>> span(0.1, math.inf, Unit("m", 1.0)), span(0.0, math.inf, Unit("m", 1.0))
    ('0.1 m or more', 'not known')
    """
    if math.isinf(high):
        return f"{quantity(low, unit)} or more" if low > 0.0 else "not known"
    unit = _fine(max(abs(low), abs(high)), unit)
    ends = (low / unit.scale, high / unit.scale)
    digits = digits_of(*ends)
    return f"{number(ends[0], digits)} to {number(ends[1], digits)}{suffix(unit)}"


def digits_of(low: float, high: float) -> int:
    """How many significant digits show the width of a span within a tenth."""
    size, width = max(abs(low), abs(high)), high - low
    if not 0.0 < width < math.inf:
        return 3
    needed = math.floor(math.log10(size)) - math.floor(math.log10(0.2 * width)) + 1
    return min(max(needed, 3), 6)


def suffix(unit: Unit) -> str:
    """The unit's name after a blank; nothing for a dimensionless one."""
    return "" if unit.text in {"", "1"} else f" {unit.text}"


def percent(share: float) -> str:
    """A share as whole per cent, never rounded up to 100 or down to 0.

    >>> percent(0.996), percent(0.5), percent(0.001), percent(1.0)
    ('99 %', '50 %', '1 %', '100 %')
    """
    rounded = round(100.0 * share)
    if 0.0 < share < 1.0:
        rounded = min(max(rounded, 1), 99)
    return f"{rounded} %"


def percents(shares: Sequence[float]) -> list[str]:
    """Shares of one whole as per cent that add up as the shares do, by the largest remainders.

    >>> percents([0.816, 0.122, 0.062]), percents([1 / 3, 1 / 3, 1 / 3]), percents([])
    (['82 %', '12 %', '6 %'], ['34 %', '33 %', '33 %'], [])
    """
    whole = [math.floor(100.0 * share) for share in shares]
    rest = [100.0 * share - floor for share, floor in zip(shares, whole, strict=True)]
    more = round(100.0 * sum(shares)) - sum(whole)
    for place in sorted(range(len(rest)), key=lambda i: -rest[i])[:more]:
        whole[place] += 1
    return [f"{each} %" for each in whole]


def seconds(value: float) -> str:
    """A duration.

    >>> seconds(4.21), seconds(395.1), seconds(7300.0)
    ('4.21 s', '395 s', '2 h 2 min')
    """
    if value < 600.0:
        return f"{number(value)} s"
    minutes = round(value / 60.0)
    return f"{minutes} min" if minutes < 120 else f"{minutes // 60} h {minutes % 60} min"


def date_of(stamp: float) -> datetime | None:
    """The date of a stamp in seconds since 1970, where the clock that made it was set.

    One that is not set counts from when it was switched on: as if it were 1970.

    >>> str(date_of(1.7e9)), date_of(12.0)
    ('2023-11-14 22:13:20+00:00', None)
    """
    return datetime.fromtimestamp(stamp, UTC) if YEAR < stamp < CENTURIES else None


def often(times: int) -> str:
    """`once`, `twice`, `3 times`."""
    return {1: "once", 2: "twice"}.get(times, f"{times} times")


def listed(names: list[str]) -> str:
    """Names in a sentence.

    >>> listed(["x"]), listed(["x", "y", "v"])
    ('x', 'x, y and v')
    """
    return " and ".join([part for part in (", ".join(names[:-1]), names[-1]) if part])
