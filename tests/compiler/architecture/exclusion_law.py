"""The law of exclusion, of one architecture: what is proved never happens, what is refuted does."""

from collections.abc import Sequence
from enum import StrEnum

from compiler.architecture.exclusion.answer import Answer, Proof, Witness
from tests.compiler.architecture.exclusions import Case, random_readings


class Fate(StrEnum):
    """What an answer came to."""

    PROVED = "proved; no run had both act"
    REFUTED = "refuted; both act in the replay, and a conflict is told"
    REFUTED_IF = "refuted, if nodes tell or keep what is assumed"
    UNDECIDED = "undecided; no run had both act"
    UNDECIDED_AND_ACT = "undecided; both act in a run"


def fate_of(case: Case, answer: Answer, seeds: Sequence[int], steps: int) -> Fate:
    """What the scheduler says to an answer, in a replay or in runs of random readings.

    Raises:
        AssertionError: the law is broken.
    """
    if isinstance(answer, Witness):
        if answer.assumed:
            return Fate.REFUTED_IF
        assert case.replayed(answer), f"not replayed: {answer.text}"
        return Fate.REFUTED
    for seed in seeds:
        both, conflicts = case.run(random_readings(seed, steps), steps)
        if both or conflicts:
            assert not isinstance(answer, Proof), f"both act at {both} (seed {seed}): {answer}"
            return Fate.UNDECIDED_AND_ACT
    return Fate.PROVED if isinstance(answer, Proof) else Fate.UNDECIDED
