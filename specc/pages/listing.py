"""Text of specs and programs in a page: comments, keys and texts are told apart by classes."""

import re
from typing import Final

from markupsafe import Markup, escape

PARTS: Final = re.compile(
    r"""(?P<text>"(?:[^"\\\n]|\\.)*"|'(?:[^'\n]|'')*')"""
    r"""|(?P<comment>(?:(?<=\s)|^)\#[^\n]*)"""
    r"""|(?P<key>(?<![\w.'"])[A-Za-z_][\w.]*(?=:(?:\s|$)))""",
    re.MULTILINE,
)
CLASSES: Final = {"text": "s", "comment": "c", "key": "k"}


def listing(text: str) -> Markup:
    """The text, escaped, with its parts in `<span>`s.

    >>> str(listing("x: 1  # < 2"))
    '<span class="k">x</span>: 1  <span class="c"># &lt; 2</span>'
    """
    found, done = Markup(""), 0
    for part in PARTS.finditer(text):
        kind = CLASSES[str(part.lastgroup)]
        found += escape(text[done : part.start()])
        found += Markup('<span class="{}">{}</span>').format(kind, part[0])
        done = part.end()
    return found + escape(text[done:])
