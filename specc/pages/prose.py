"""Sentences of a report as they stand in a page: real minus signs, and code set as code."""

import re
from typing import Final

from markupsafe import Markup, escape

CODE: Final = re.compile(r"`([^`\n]+)`")
"""What is to be written, within a sentence."""
HYPHEN: Final = re.compile(r"(?<![\w.)\-−])-(?=\.?\d)")
"""The minus of a number; not that of a date, a range or an exponent."""
GLUED: Final = re.compile(r"(?<=\d) (?=[%±])|(?<=±) (?=\d)")
"""Blanks at which no line ends."""


def prose(text: str) -> Markup:
    """The sentence, escaped.

    >>> str(prose("write `offset: -1 m` if x < -2 m"))
    'write <code>offset: -1 m</code> if x &lt; −2 m'
    """
    pieces = CODE.split(text)
    return Markup("").join(
        Markup("<code>{}</code>").format(piece)
        if k % 2
        else escape(GLUED.sub("\u00a0", HYPHEN.sub("−", piece)))
        for k, piece in enumerate(pieces)
    )
