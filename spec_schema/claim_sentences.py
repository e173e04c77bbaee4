"""The sentences of `expect:`: how many features of which type, or how much goes where.

`no other attractor`, `exactly two saddles`, `at least 95 % of the domain goes to home`. A small
grammar: a count, then the words of a feature. What is not in it is refused at the very word.
"""

import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final, final

from spec_schema.faults import Fault
from spec_schema.suggest import did_you_mean
from spec_schema.wording import listed, quoted

BASIN: Final = "basin"
"""The feature of a claim on how much of the domain goes somewhere."""

_PLAIN: Final = (
    "fixed point",
    "stable fixed point",
    "unstable fixed point",
    "node",
    "stable node",
    "unstable node",
    "focus",
    "stable focus",
    "unstable focus",
    "saddle",
    "center",
    "attractor",
    "repeller",
)
_CYCLES: Final = ("cycle", "stable cycle", "unstable cycle", "semi-stable cycle", "saddle cycle")

FEATURES: Final = (*_PLAIN, *_CYCLES)
"""What can be counted."""

CYCLES: Final = frozenset(_CYCLES)
"""The features that have a period and a reach."""

_NUMBERS: Final = (
    *("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten"),
    *("eleven", "twelve"),
)
_BOUNDS: Final = ("exactly", "at least", "at most")
_WORD: Final = re.compile(r"\S+")
_SHARE: Final = re.compile(r"(\d{1,3}(?:\.\d{1,9})?) ?%")
_NAME: Final = re.compile(r"[A-Za-z_]\w{0,63}", re.ASCII)
_OF_THE_DOMAIN: Final = ("of", "the", "domain", "goes", "to")
_ARTICLES: Final = frozenset({"a", "an", "the"})
_PERCENT: Final = frozenset({"percent", "per", "pct", "%"})
_LINKS: Final = frozenset({"and", "or", "plus", "&"})
_EXAMPLES: Final = "`one stable cycle`, `no other attractor`, `at least two saddles`"


@final
@dataclass(frozen=True, slots=True)
class Sentence:
    """A sentence, understood.

    feature: one of `FEATURES`, or `BASIN`. least, most: how many; `most` is None for no limit.
    share: of the domain, 0 to 1, for a basin; goes_to: the name of what it goes to, empty for what
    the last claim above counts.
    """

    feature: str
    least: int
    most: int | None
    other: bool
    share: float | None = None
    goes_to: str = ""


@final
class SentenceError(Exception):
    """A sentence that is not of the language; `fault` says at which characters."""

    def __init__(self, fault: Fault) -> None:
        self.fault = fault
        super().__init__(fault.message)


def read_sentence(text: str) -> Sentence:
    """What a claim says.

    Raises:
        SentenceError: a word that does not belong where it stands.

    >>> read_sentence("no other attractor")
    Sentence(feature='attractor', least=0, most=0, other=True, share=None, goes_to='')
    """
    words = _Words(text)
    bound = words.any_of(_BOUNDS)
    share = words.share() if bound == "at least" else _everything(words, bound)
    if share is not None:
        return Sentence(BASIN, 0, None, other=False, share=share, goes_to=_goal(words))
    count = _count(words, bound)
    other = words.any_of(("other",)) is not None
    feature = words.feature()
    words.end()
    if bound == "at least":
        return Sentence(feature, count, None, other)
    return Sentence(feature, 0 if bound == "at most" else count, count, other)


def _everything(words: "_Words", bound: str | None) -> float | None:
    """The share of `all of the domain`."""
    return 1.0 if bound is None and words.any_of(("all",)) else None


def _goal(words: "_Words") -> str:
    for expected in _OF_THE_DOMAIN:
        words.expect(expected)
    name = words.name()
    words.end()
    return "" if name in {"it", "them"} else name


def _count(words: "_Words", bound: str | None) -> int:
    word, start, end = words.here()
    if word.isdecimal() and word.isascii() and len(word) <= 3:
        words.step()
        return int(word)
    if word in _NUMBERS:
        words.step()
        return _NUMBERS.index(word)
    beginnings = _NUMBERS if bound else (*_NUMBERS, *_BOUNDS, "all")
    shown = quoted(word) if word else "the end"
    what = f"after {quoted(bound)} comes a number" if bound else "a claim begins with how many"
    remedy = did_you_mean(word, beginnings) or f"write e.g. {_EXAMPLES}"
    if word in _ARTICLES:
        remedy = "write `one` instead"
    elif found := _SHARE.fullmatch(word):
        remedy = _share_of_domain(found[1])
    raise SentenceError(Fault(start, end, "S271", f"{what}, not {shown}", remedy))


@final
class _Words:
    """The words of a sentence, read from left to right."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._words = [(m[0], m.start(), m.end()) for m in _WORD.finditer(text)]
        self._next = 0

    def here(self) -> tuple[str, int, int]:
        """The next word and where it stands; an empty one at the end."""
        if self._next < len(self._words):
            return self._words[self._next]
        return "", max(len(self._text.rstrip()) - 1, 0), len(self._text.rstrip())

    def step(self, count: int = 1) -> None:
        """Go on to the next word."""
        self._next += count

    def any_of(self, phrases: Iterable[str]) -> str | None:
        """The phrase that stands here, passed over."""
        for phrase in phrases:
            parts = phrase.split()
            found = [word for word, _, _ in self._words[self._next : self._next + len(parts)]]
            if found == parts:
                self.step(len(parts))
                return phrase
        return None

    def share(self) -> float | None:
        """A percentage that stands here, as a share, passed over."""
        word, start, _ = self.here()
        found = _SHARE.match(self._text, start) if word else None
        if found is None:
            return None
        share = float(found[1]) / 100.0
        if not 0.0 < share <= 1.0:
            message = f"a share of the domain is above 0 and at most 100 %, not {found[0]}"
            raise SentenceError(Fault(found.start(), found.end(), "S271", message, "write 95 %"))
        self.step(len(found[0].split()))
        return share

    def expect(self, wanted: str) -> None:
        """Pass over a word that must stand here."""
        word, start, end = self.here()
        if word != wanted and (word, wanted) != ("go", "goes"):
            shown = quoted(word) if word else "the end"
            message = f"expected {quoted(wanted)} here, not {shown}"
            remedy = "write `at least 95 % of the domain goes to NAME`"
            raise SentenceError(Fault(start, end, "S271", message, remedy))
        self.step()

    def name(self) -> str:
        """The name that stands here, passed over."""
        word, start, end = self.here()
        if not _NAME.fullmatch(word):
            message = f"expected a name here, not {quoted(word) if word else 'the end'}"
            remedy = "name what it goes to: `called: home` at the claim above, or write `it`"
            raise SentenceError(Fault(start, end, "S271", message, remedy))
        self.step()
        return word

    def feature(self) -> str:
        """The feature that stands here, passed over."""
        matched: tuple[str, ...] = ()
        while True:
            following = {
                phrase[len(matched)]
                for phrase in _PHRASES
                if phrase[: len(matched)] == matched and len(phrase) > len(matched)
            }
            word, start, end = self.here()
            if word in following:
                matched = (*matched, word)
                self.step()
            elif matched in _PHRASES:
                return _PHRASES[matched]
            elif not matched and word in _PERCENT:
                raise SentenceError(self._unshared(word, start, end))
            else:
                raise SentenceError(_unknown(word, start, end, matched, following))

    def _unshared(self, word: str, start: int, end: int) -> Fault:
        """A share that is not written as one: `95 percent`, or `95 %` without `at least`."""
        before = self._words[self._next - 1][0]
        remedy = _share_of_domain(before)
        message = f"a share of the domain is not written so: '{before} {word}'"
        return Fault(start, end, "S271", message, remedy)

    def end(self) -> None:
        """Nothing may follow.

        Raises:
            SentenceError: something does.
        """
        word, start, _ = self.here()
        if word:
            rest = quoted(self._text[start:].rstrip())
            message = f"the claim is complete before {rest}"
            remedy = (
                "conditions stand behind a colon: "
                "`one stable focus: {at: {x: 0}, within: 2 %, over: [gain], called: home}`"
            )
            if word in _LINKS:
                remedy = f"write two claims: one ends before '{word}', the other gets its own '-'"
            raise SentenceError(Fault(start, len(self._text.rstrip()), "S271", message, remedy))


def _share_of_domain(percents: str) -> str:
    return f"write `at least {percents} % of the domain goes to NAME`"


def _unknown(
    word: str, start: int, end: int, matched: tuple[str, ...], following: Iterable[str]
) -> Fault:
    known = sorted(following)
    singular = [word for word in known if word in {w for f in FEATURES for w in f.split()}]
    shown = quoted(word) if word else "the end"
    after = f"after {quoted(' '.join(matched))}" if matched else "here"
    message = f"no feature is named so {after}: {shown}"
    if not word:
        message = f"the feature is missing {after}"
    remedy = did_you_mean(word, known) or f"write one of {listed(singular)}"
    return Fault(start, end, "S271", message, remedy)


def _phrases() -> dict[tuple[str, ...], str]:
    """Each way to write each feature."""
    found = {}
    for feature in FEATURES:
        *before, noun = feature.split()
        for form in _forms(noun):
            found[(*before, form)] = feature
            if noun == "cycle":
                found[(*before, "limit", form)] = feature
    return found


def _forms(noun: str) -> tuple[str, ...]:
    match noun:
        case "focus":
            return ("focus", "foci", "focuses")
        case "center":
            return ("center", "centers", "centre", "centres")
        case _:
            return (noun, f"{noun}s")


_PHRASES: Final = _phrases()
