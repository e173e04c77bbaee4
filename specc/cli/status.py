"""What an exit status of `specc` means (design, section 6)."""

from enum import IntEnum
from typing import final


@final
class Status(IntEnum):
    """0 yes, 1 no, 2 bad spec, trace or usage, 3 a bug of ours, 4 inconclusive, 130 Ctrl-C."""

    YES = 0
    NO = 1
    BAD_INPUT = 2
    BUG = 3
    INCONCLUSIVE = 4
    INTERRUPTED = 130
