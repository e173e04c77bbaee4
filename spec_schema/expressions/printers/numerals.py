"""How a double is written so that every reader gets the same double back."""

import math


def numeral(value: float) -> str:
    """The shortest decimal that reads as exactly this double; whole numbers without a point.

    >>> numeral(2.0), numeral(0.1), numeral(-1e30)
    ('2', '0.1', '-1e+30')
    """
    assert math.isfinite(value), "a literal is finite"
    if (
        value.is_integer()
        and abs(value) < 1e15
        and not (value == 0 and math.copysign(1, value) < 0)
    ):
        return str(int(value))
    return repr(value)
