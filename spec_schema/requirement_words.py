"""The words of a requirement: names, quantities, signs and keywords, with their places."""

import re
from dataclasses import dataclass
from typing import Final, final

from spec_schema.faults import Fault
from spec_schema.wording import quoted

TEMPORAL: Final = frozenset({"always", "eventually"})
WINDOWS: Final = frozenset({"within", "after", "from", "to"})
KEYWORDS: Final = frozenset({*TEMPORAL, *WINDOWS, "until", "not", "and", "or", "if", "then"})
LONGEST: Final = 2_000
"""Characters of a sentence."""
COMPARE: Final = "compare quantities and finite numbers, as in `r.clearance > 5 cm`"
OTHER_WORDS: Final = {
    "globally": "always",
    "finally": "eventually",
    "sometime": "eventually",
    "sometimes": "eventually",
    "never": "always not",
    "implies": "if ... then",
    "while": "until",
    "unless": "until",
    "before": "until",
    "during": "within",
    "when": "if",
    "whenever": "always if",
}
"""Words of other languages, and ours."""

_UNIT: Final = r"[A-Za-zµμ°Ω]+(?:\^-?\d)?"
_NOT_UNIT: Final = rf"(?!(?:{'|'.join(sorted(KEYWORDS))}|pi)\b)"
_ONE_UNIT: Final = rf"{_NOT_UNIT}{_UNIT}(?![\w.(])"
_NUMBER: Final = r"(?>(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?)"
_TOKEN: Final = re.compile(
    rf"(?P<quantity>{_NUMBER}[ ]*(?:1/)?{_ONE_UNIT}(?:[*/]{_ONE_UNIT})*)"
    rf"|(?P<number>{_NUMBER})"
    r"|(?P<name>[A-Za-z_]\w*(?:\.[A-Za-z_]\w*)*)"
    r"|(?P<text>'[^']*'|\"[^\"]*\")"
    r"|(?P<sign><=|>=|==|!=|\*\*|[-+*/%<>(),])"
    r"|(?P<space>\s+)"
    r"|(?P<strange>.)",
    re.ASCII,
)


@final
@dataclass(frozen=True, slots=True)
class Word:
    """A word or sign, and the characters where it stands."""

    text: str
    start: int
    end: int
    is_quantity: bool = False
    is_name: bool = False


@final
class RequirementError(Exception):
    """A sentence that is not of the language, with its faults."""

    def __init__(self, *faults: Fault) -> None:
        self.faults = faults
        super().__init__("; ".join(fault.message for fault in faults))


def words_of(text: str, what: str = "a requirement") -> tuple[list[Word], list[Fault]]:
    """The words in order, and a fault for each that belongs to another language than `what`.

    >>> [word.text for word in words_of("r.x/2 >= 5 m/s until r.y < 1")[0]]
    ['r.x', '/', '2', '>=', '5 m/s', 'until', 'r.y', '<', '1']
    """
    if len(text) > LONGEST:
        message = f"the sentence has more than {LONGEST} characters"
        return [], [Fault(0, 1, "S370", message, "say it in several sentences")]
    words: list[Word] = []
    faults: list[Fault] = []
    for match in _TOKEN.finditer(text):
        kind, found = match.lastgroup, match[0]
        start, end = match.span()
        if kind == "space":
            continue
        if kind == "strange":
            remedy = {"=": "write == to compare", "&": "write and", "|": "write or"}.get(
                found, COMPARE
            )
            message = f"{quoted(found)} is not part of {what}"
            faults.append(Fault(start, end, "S370", message, remedy))
        elif kind == "name" and found.casefold() in OTHER_WORDS:
            remedy = f"write `{OTHER_WORDS[found.casefold()]}`"
            message = f"{quoted(found)} is no word of requirements"
            faults.append(Fault(start, end, "S370", message, remedy))
        else:
            words.append(Word(found, start, end, kind == "quantity", kind == "name"))
    return words, faults
