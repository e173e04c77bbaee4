"""Whether nodes never act at once, in words: the one place where exclusion is asked for."""

from dataclasses import dataclass
from itertools import combinations
from typing import Final, final

from compiler.architecture.exclusion.answer import Proof, Undecided
from compiler.architecture.exclusion.ask import question_of
from compiler.architecture.exclusion.decide import decide
from compiler.architecture.exclusion.wiring import Wiring
from spec_schema.wording import listed

PAIR: Final = "{pair}"
"""Stands for the two that a reason is about."""


@final
@dataclass(frozen=True, slots=True)
class Exclusion:
    """Whether it is shown that nodes never act at once.

    sentence: why, or why not. help: what would do.
    """

    is_proved: bool
    sentence: str
    help: str = ""


def exclusion_of(wiring: Wiring, pairs: list[tuple[int, int]]) -> Exclusion:
    """Whether all `pairs` of nodes are kept from acting at once."""
    reasons: list[tuple[str, str, str]] = []
    for first, second in pairs:
        one, two = wiring.nodes[first].name, wiring.nodes[second].name
        answer = decide(question_of(wiring, first, second))
        if isinstance(answer, Undecided):
            sentence = f"it can't be shown that {one} and {two} never act at once: {answer.reason}"
            return Exclusion(is_proved=False, sentence=sentence, help=answer.help)
        if not isinstance(answer, Proof):
            return Exclusion(is_proved=False, sentence=answer.text, help=answer.help)
        reasons.append((answer.reason, one, two))
    return Exclusion(is_proved=True, sentence=_together(reasons))


def _together(reasons: list[tuple[str, str, str]]) -> str:
    """The reasons why pairs of nodes exclude each other; one for all pairs of some, once."""
    by_form: dict[str, list[tuple[str, str]]] = {}
    for reason, one, two in reasons:
        by_form.setdefault(reason.replace(f"both {one} and {two} ", PAIR), []).append((one, two))
    found = []
    for form, pairs in by_form.items():
        names = tuple(dict.fromkeys(name for pair in pairs for name in pair))
        if len(pairs) > 1 and set(pairs) == set(combinations(names, 2)):
            found.append(form.replace(PAIR, f"two of {listed(names, last='and')} "))
        else:
            found += [form.replace(PAIR, f"both {one} and {two} ") for one, two in pairs]
    return "; ".join(dict.fromkeys(found))
