"""Whether nodes never act at once, in words: the one place where exclusion is asked for."""

from dataclasses import dataclass
from typing import final

from compiler.architecture.exclusion.answer import Proof, Undecided
from compiler.architecture.exclusion.ask import Wiring, question_of
from compiler.architecture.exclusion.decide import decide


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
    reasons: list[str] = []
    for first, second in pairs:
        answer = decide(question_of(wiring, first, second))
        if isinstance(answer, Undecided):
            names = f"{wiring.nodes[first].name} and {wiring.nodes[second].name}"
            sentence = f"it can't be shown that {names} never act at once: {answer.reason}"
            return Exclusion(is_proved=False, sentence=sentence, help=answer.help)
        if not isinstance(answer, Proof):
            return Exclusion(is_proved=False, sentence=answer.text, help=answer.help)
        reasons.append(answer.reason)
    return Exclusion(is_proved=True, sentence="; ".join(dict.fromkeys(reasons)))
