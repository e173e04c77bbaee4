"""Numbers with as many digits as their intervals support."""

import math
from typing import Final

MOST: Final = 12
"""A value that is known to more decimals counts as exact."""


def rounded(value: float, half: float) -> str:
    """The value, to the last digit that matters beside `half`, half the width of its interval.

    That is the place of the first digit of `half`, or of its second where `half` begins with a 1
    (1 up to 1.95). Rounding then moves the value by no more than 0.26 of `half`. An exact value
    (`half` 0) keeps all its digits, and so does one of which nothing is known (infinite `half`).

    >>> rounded(0.45967, 0.0101), rounded(1234.5, 30.0), rounded(-1.0, 0.0), rounded(2.0004, 0.02)
    ('0.46', '1230', '-1', '2')
    """
    if half <= 0.0 or not math.isfinite(half):
        return _plain(value, MOST, exact=True)
    decimals = -math.floor(math.log10(half))
    if half * 10.0**decimals < 1.95:
        decimals += 1
    return _plain(round(value, decimals), decimals, exact=decimals > MOST)


def _plain(value: float, decimals: int, *, exact: bool) -> str:
    """Without an exponent where that stays short; never `-0`."""
    if value == 0.0:
        return "0"
    if exact or not 1e-6 <= abs(value) < 1e12:
        text = repr(float(value))
        return text.removesuffix(".0")
    text = f"{value:.{max(decimals, 0)}f}"
    return text.rstrip("0").rstrip(".") if "." in text else text
