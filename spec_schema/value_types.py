"""The kinds of values that specs are made of: names, units, numbers, quantities, expressions.

Units, quantities and expressions stay text here (or a plain number): what they mean is the
compiler's first question, so that a mistake in one hides none in another.
"""

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, Any, TypeAlias, final

from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Field,
    PlainValidator,
    Strict,
    WithJsonSchema,
)

from spec_schema.mistake import Mistake, refuse, refused
from spec_schema.names import PATTERN, why_no_name, why_reserved
from spec_schema.suggest import did_you_mean
from spec_schema.wording import described, number, quoted

_BYTES = {"B": 1, "kB": 10**3, "MB": 10**6, "GB": 10**9, "KiB": 2**10, "MiB": 2**20, "GiB": 2**30}
_CALL = r"[A-Za-z_]\w*(\.[A-Za-z_]\w*)*:[A-Za-z_]\w*"
_MODES = ("rate", "set-point", "acceleration")
_CHANNEL_HELP = "write the channel of a body and how it is set: base.speed as set-point"
_SIZE = re.compile(r"([0-9]{1,12}(?:\.[0-9]{1,12})?) ?([A-Za-z]+)")


class StrictModel(BaseModel):
    """The base of all models: nothing is converted, nothing unknown accepted, nothing changed."""

    model_config = ConfigDict(
        strict=True, extra="forbid", frozen=True, populate_by_name=True, defer_build=True
    )


@final
@dataclass(frozen=True, slots=True)
class Channel:
    """A channel of a body, and as what a variable acts on it; `sign` is 1 or -1."""

    name: str
    mode: str
    sign: float = 1.0


def _identifier(text: str) -> str:
    reason = why_no_name(text)
    if reason:
        raise refused("S108", f"{quoted(text)} can't be a name", reason)
    return text


def _variable(text: str) -> str:
    reason = why_reserved(_identifier(text))
    if reason:
        raise refused(
            "S109", f"{quoted(text)} can't name a variable: it {reason}", "take another name"
        )
    return text


def _filled(text: str) -> str:
    if not text.strip():
        raise refused("S110", "the text is empty", "write something between the quotes")
    return text


def _finite(value: float) -> float:
    if not math.isfinite(value):
        message = f"expected a finite number, got {number(value)}"
        raise refused("S107", message, "write a number")
    return value


def _number(value: object) -> float:
    match value:
        case bool():
            pass
        case int() | float():
            return _finite(float(value))
        case str():
            raise refused("S103", f"expected a number, got {described(value)}", _number_help(value))
    raise refused("S103", f"expected a number, got {described(value)}")


def _number_help(text: str) -> str:
    """What was probably meant by a text where a number belongs."""
    bare = text.strip().replace("_", "")
    for candidate in (bare, bare.replace(",", ".")):
        try:
            if math.isfinite(float(candidate)):
                return f"write {candidate}"
        except ValueError:
            continue
    if re.match(r"[-+.0-9]", bare) and re.search(r"[A-Za-z%]", bare):
        return "a plain number is wanted here, without a unit"
    return "write a number, without quotes"


def as_quantity(value: object) -> float | str:
    """A number or a text, as `Quantity` takes it.

    Raises:
        PydanticCustomError: it is something else.
    """
    match value:
        case bool():
            pass
        case int() | float():
            return _finite(float(value))
        case str():
            return _filled(value)
    message = f"expected a number or a quantity, got {described(value)}"
    raise refused(
        "S103",
        message,
        'write a number in the variable\'s own unit, or one with its unit: "0.05 m"',
    )


def _expression(value: object) -> str:
    match value:
        case bool():
            pass
        case int() | float():
            return repr(_finite(value))
        case str():
            return _filled(value)
    message = f"expected an expression, got {described(value)}"
    raise refused("S103", message, 'write it as text: "-k*(x - goal)"')


def _unit(value: object) -> str:
    if isinstance(value, str):
        return _filled(value)
    message = f"expected a unit as text, got {described(value)}"
    plain = isinstance(value, int | float) and not isinstance(value, bool)
    help_ = (
        'the unit of a plain number is "1", in quotes'
        if plain
        else 'write a unit: m, m/s, rad, "1"'
    )
    raise refused("S103", message, help_)


def _domain(value: object) -> tuple[float | str, float | str]:
    if not isinstance(value, list | tuple):
        raise refused(
            "S103", f"expected [low, high], got {described(value)}", "write two limits: [-2, 2]"
        )
    if len(value) != 2:
        raise refused(
            "S111",
            f"a domain is [low, high]: two limits, not {len(value)}",
            "write two limits: [-2, 2]",
        )
    limits: list[float | str] = []
    for place, limit in enumerate(value):
        if isinstance(limit, bool) or not isinstance(limit, int | float | str):
            refuse(
                [
                    Mistake(
                        "S103",
                        f"expected a limit, got {described(limit)}",
                        "write a number",
                        (place,),
                    )
                ]
            )
        limits.append(limit if isinstance(limit, str) else float(limit))
    refuse(_limit_mistakes(limits[0], limits[1]))
    return limits[0], limits[1]


def _limit_mistakes(low: float | str, high: float | str) -> Iterator[Mistake]:
    for place, limit in enumerate((low, high)):
        if isinstance(limit, float) and not math.isfinite(limit):
            yield Mistake(
                "S107",
                f"{number(limit)} is no limit: a domain is bounded",
                "write a finite number",
                (place,),
            )
        if isinstance(limit, str) and not limit.strip():
            yield Mistake("S110", "the text is empty", "write a number", (place,))
    if isinstance(low, float) and isinstance(high, float) and low >= high:
        message = f"the lower limit {number(low)} is not below the upper limit {number(high)}"
        help_ = (
            f"write [{number(high)}, {number(low)}]" if low > high else "a domain has some width"
        )
        yield Mistake("S111", message, help_)


def _bytes(value: object) -> int:
    found = _SIZE.fullmatch(value) if isinstance(value, str) else None
    if found is None or found[2] not in _BYTES:
        message = f"expected an amount of memory, got {described(value)}"
        raise refused("S103", message, f'write a number with one of {", ".join(_BYTES)}: "64 MiB"')
    return int(float(found[1]) * _BYTES[found[2]])


def _version(value: object) -> int:
    if isinstance(value, bool) or value != 1 or not isinstance(value, int):
        raise refused(
            "S105", f"the version of the language is 1, not {described(value)}", "write 'specc: 1'"
        )
    return value


def _channel(value: object) -> Channel:
    if not isinstance(value, str):
        raise refused("S103", f"expected a channel, got {described(value)}", _CHANNEL_HELP)
    written, _, mode = (part.strip() for part in value.partition(" as "))
    name = written.removeprefix("-").strip()
    if not re.fullmatch(r"[A-Za-z_]\w*(\.[A-Za-z_]\w*)*", name, re.ASCII) or not mode:
        raise refused("S120", f"{quoted(value)} names no channel and how it is set", _CHANNEL_HELP)
    if mode not in _MODES:
        remedy = did_you_mean(mode, _MODES) or f"expected one of: {', '.join(_MODES)}"
        raise refused("S104", f"a channel can't be realized as {quoted(mode)}", remedy)
    return Channel(name, mode, -1.0 if written.startswith("-") else 1.0)


def _callee(text: str) -> str:
    if not re.fullmatch(_CALL, text):
        raise refused("S119", f"{quoted(text)} names no function", "write package.module:function")
    return text


def _schema(**keywords: Any) -> WithJsonSchema:
    return WithJsonSchema(keywords)


Limits: TypeAlias = tuple[float | str, float | str]
"""The two ends of a domain, as they are written."""

Identifier: TypeAlias = Annotated[
    str, AfterValidator(_identifier), _schema(type="string", pattern=PATTERN)
]
"""A name that expressions don't read: of a behavior, a project."""

Name: TypeAlias = Annotated[str, AfterValidator(_variable), _schema(type="string", pattern=PATTERN)]
"""A name that expressions may read."""

Text: TypeAlias = Annotated[str, AfterValidator(_filled), _schema(type="string", minLength=1)]
"""A text that says something."""

Number: TypeAlias = Annotated[float, PlainValidator(_number), _schema(type="number")]
"""A finite number."""

Quantity: TypeAlias = Annotated[
    float | str, PlainValidator(as_quantity), _schema(type=["number", "string"])
]
"""A plain number in the variable's own unit, or a number with its unit as text: `"0.05 m"`."""

Expression: TypeAlias = Annotated[
    str, PlainValidator(_expression), _schema(type=["string", "number"])
]
"""An expression as text; a plain number becomes its text."""

UnitText: TypeAlias = Annotated[str, PlainValidator(_unit), _schema(type="string", minLength=1)]
"""A unit as text."""

Domain: TypeAlias = Annotated[
    Limits,
    PlainValidator(_domain),
    _schema(type="array", items={"type": ["number", "string"]}, minItems=2, maxItems=2),
]
"""Two limits: numbers, quantities (`180 deg`) or expressions of numbers (`-pi`)."""

Bytes: TypeAlias = Annotated[
    int, PlainValidator(_bytes), _schema(type="string", examples=["64 MiB"])
]
"""An amount of memory, in bytes."""

Version: TypeAlias = Annotated[int, PlainValidator(_version), _schema(const=1)]
"""The version of the language."""

ChannelText: TypeAlias = Annotated[
    Channel,
    PlainValidator(_channel),
    _schema(type="string", pattern=f"^-?[A-Za-z_][A-Za-z0-9_.]* as ({'|'.join(_MODES)})$"),
]
"""A channel and its mode as `CHANNEL as MODE`, or `-CHANNEL as MODE`."""

Callee: TypeAlias = Annotated[
    str, AfterValidator(_callee), _schema(type="string", pattern=f"^{_CALL}$")
]
"""A Python function as `package.module:function`."""

Names: TypeAlias = Annotated[tuple[Name, ...], Strict(strict=False), Field(min_length=1)]
"""Some names, in order."""

Vector: TypeAlias = Annotated[tuple[Number, ...], Strict(strict=False), Field(min_length=1)]
"""Some numbers, in order."""
