"""What portraits are drawn for; apart from the palettes, so that naming one loads no drawing."""

from enum import StrEnum
from typing import final


@final
class Style(StrEnum):
    """What a portrait is drawn for."""

    SCREEN = "screen"
    JOURNAL = "journal"
    DARK = "dark"
