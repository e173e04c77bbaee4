"""Numbers and quantities as people read them: in the user's unit, with a real minus sign."""

import math
from fractions import Fraction

from runtime.program import Unit


def axis_label(name: str, unit: Unit) -> str:
    """`x [m]`; a quantity without a unit is its name alone."""
    return name if unit.text in {"", "1"} else f"{name} [{unit.text}]"


def rate_of(name: str) -> str:
    """The derivative of a variable by time: `dx/dt`, `d speed/dt`."""
    return f"d{name}/dt" if len(name) == 1 else f"d {name}/dt"


def quantity(value: float, unit: Unit, digits: int = 3) -> str:
    """An SI value with its unit: `quantity(0.05, Unit("cm", 0.01))` is `5 cm`."""
    text = number(value / unit.scale, digits)
    return text if unit.text in {"", "1"} else f"{text} {unit.text}"


def number(value: float, digits: int = 3) -> str:
    """A number with `digits` significant digits.

    >>> number(-0.000123456), number(1234.5678), number(2.0)
    ('−1.23×10⁻⁴', '1235', '2')
    """
    if math.isnan(value):
        return "–"
    if math.isinf(value):
        return "∞" if value > 0 else "−∞"
    size = abs(value)
    if size and not 1e-3 <= size < 1e5:
        mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
        mantissa = mantissa.rstrip("0").rstrip(".") if "." in mantissa else mantissa
        return f"{_minus(mantissa)}×10{_superscript(int(exponent))}"
    decimals = max(0, digits - 1 - math.floor(math.log10(size))) if size else 0
    text = f"{value:.{decimals}f}"
    return _minus(text.rstrip("0").rstrip(".") if "." in text else text)


def range_shown(low: float, high: float) -> tuple[float, float]:
    """Both ends of a range to a thousandth of it: 0 for 6e-6 to 1.

    >>> range_shown(6e-6, 0.99998), range_shown(0.4935, 5.0), range_shown(-math.inf, 2.0)
    ((0.0, 1.0), (0.49, 5.0), (-inf, 2.0))
    """
    if not math.isfinite(high - low) or high <= low:
        return low, high
    digits = 2 - math.floor(math.log10(high - low))
    return round(low, digits), round(high, digits)


def seconds(value: float) -> str:
    """A duration: `0.4 s`, `2 min 5 s`."""
    if value < 120.0:
        return f"{number(value)} s"
    minutes, rest = divmod(round(value), 60)
    return f"{minutes} min {rest} s" if rest else f"{minutes} min"


def degrees(angle: float) -> str:
    """A direction in whole degrees, from −179 to 180.

    >>> degrees(math.pi), degrees(-math.pi / 2.0), degrees(7.0)
    ('180°', '−90°', '41°')
    """
    turned = round(math.degrees(angle)) % 360
    return f"{_minus(str(turned - 360 if turned > 180 else turned))}°"


def percent(share: float) -> str:
    """A share of one as a whole percentage; never rounded up to all of it."""
    return f"{math.floor(100.0 * share + 1e-9)} %"


def multiple_of_pi(value: float) -> str:
    """`value` as a multiple of pi with a small denominator: `−π/2`, `0`, `3π/4`."""
    share = Fraction(value / math.pi).limit_denominator(12)
    if share == 0:
        return "0"
    sign = "−" if share < 0 else ""
    top = "" if abs(share.numerator) == 1 else str(abs(share.numerator))
    bottom = "" if share.denominator == 1 else f"/{share.denominator}"
    return f"{sign}{top}π{bottom}"


def is_multiple_of_pi(value: float) -> bool:
    """Whether `value` is a multiple of pi/4, up to rounding."""
    quarters = 4.0 * value / math.pi
    return abs(quarters - round(quarters)) < 1e-6


def _minus(text: str) -> str:
    return text.replace("-", "−")


def _superscript(exponent: int) -> str:
    return str(exponent).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
