"""What shall be moved: places in the spec with the values that the robot has there, in SI."""

from dataclasses import dataclass, replace
from typing import TypeAlias, final

from spec_schema.places import Path


@final
@dataclass(frozen=True, slots=True)
class Aim:
    """A number at `path` that shall be `value`, known to within `half`, both in SI.

    name: for people. unit: of a plain number there; scale: the SI value of one of it.
    sentence: what was found of the robot. source: the recording that tells it, where there are
    several.
    """

    path: Path
    name: str
    value: float
    half: float
    unit: str
    scale: float
    sentence: str
    source: str = ""


@final
@dataclass(frozen=True, slots=True)
class UnitAim:
    """A logged unit that shall be another one."""

    path: Path
    name: str
    text: str
    sentence: str
    source: str = ""


AnyAim: TypeAlias = Aim | UnitAim


@final
@dataclass(frozen=True, slots=True)
class Aims:
    """What recordings say; all but the aims are sentences.

    beyond: what departs and no number of the spec stands for. left: what the aims would leave
    open. With either, the structure differs. choices: what the recordings can't tell. by_hand:
    what a number would mend that stands within an expression. witnesses: numbers that the
    recordings tell, and that agree with the spec. contradicts: the first choices are between
    recordings that need different numbers.
    """

    aims: tuple[AnyAim, ...]
    beyond: tuple[str, ...] = ()
    left: tuple[str, ...] = ()
    choices: tuple[str, ...] = ()
    by_hand: tuple[str, ...] = ()
    witnesses: tuple[Aim, ...] = ()
    contradicts: bool = False


def named(aims: Aims, source: str) -> Aims:
    """The same, each sentence and each number with the recording that tells it."""
    lists = (aims.beyond, aims.left, aims.choices, aims.by_hand)
    said = [tuple(f"{source}: {sentence}" for sentence in each) for each in lists]
    moved = tuple(replace(each, source=source) for each in aims.aims)
    witnesses = tuple(replace(each, source=source) for each in aims.witnesses)
    return Aims(moved, said[0], said[1], said[2], said[3], witnesses)
