"""Whether nodes never act at once: the one place where exclusion is shown.

The simplest sound rule: one arbiter that holds one choice at a time governs all of them, and none
of its choices lets two act.
"""

from dataclasses import dataclass
from typing import Final, final

from compiler.architecture.parts import Part, Parts
from runtime.arbiter import Paradigm

ONE_AT_A_TIME: Final = frozenset({Paradigm.RULES, Paradigm.PLAN})
"""Paradigms that give one choice a weight above 0, and all others none."""


@final
@dataclass(frozen=True, slots=True)
class Exclusion:
    """Whether it is shown that two nodes never act at once.

    sentence: why, or why not. help: what would do.
    """

    is_proved: bool
    sentence: str
    help: str = ""


def exclusion_of(arbiter: Part, pairs: list[tuple[str, str]], parts: Parts) -> Exclusion:
    """Whether the arbiter keeps all `pairs` of nodes from acting at once."""
    assert arbiter.arbiter is not None, "asked of arbiters that could be read"
    if arbiter.arbiter.paradigm not in ONE_AT_A_TIME:
        sentence = (
            f"{arbiter.name} decides by {arbiter.arbiter.paradigm}, "
            "which lets several choices hold at once"
        )
        return Exclusion(
            is_proved=False, sentence=sentence, help="write `blend` or `priority`, or use `rules`"
        )
    governed = {name for acting in arbiter.spec.choices.values() for name in acting.act}
    for first, second in pairs:
        for name in (first, second):
            if name not in governed:
                return Exclusion(
                    is_proved=False,
                    sentence=f"no choice of {arbiter.name} names {name}, so it always acts",
                    help=f"name it in a choice of {arbiter.name}",
                )
            for other in _others(name, arbiter, parts):
                return Exclusion(
                    is_proved=False,
                    sentence=f"{other} lets {name} act, too, whatever {arbiter.name} chooses",
                    help="let one arbiter govern them all",
                )
        for choice, acting in arbiter.spec.choices.items():
            if first in acting.act and second in acting.act:
                return Exclusion(
                    is_proved=False,
                    sentence=f"{first} and {second} both act while {arbiter.name} chooses {choice}",
                    help="leave one of them out of the choice, or resolve it another way",
                )
    sentence = f"{arbiter.name} holds one choice at a time, and none lets two of them act"
    return Exclusion(is_proved=True, sentence=sentence)


def _others(name: str, arbiter: Part, parts: Parts) -> list[str]:
    """Other arbiters that let the node act."""
    return [
        other.name
        for other in parts.nodes.values()
        if other is not arbiter
        and any(name in acting.act for acting in other.spec.choices.values())
    ]
