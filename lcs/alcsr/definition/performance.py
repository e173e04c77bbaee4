"""The performance system (4.3.2): which action is taken, and what its reward is thought to be."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import final

from lcs.alcsr.definition.organisms import Chance, Organism, World, is_mature, pick
from lcs.alcsr.readings import VoteOfNone


@final
@dataclass(frozen=True, slots=True)
class Choice:
    """The action of a cycle; is_test where it is the best, and ends there."""

    action: int
    is_test: bool
    votes: tuple[float, ...]


def choose(world: World, sets: Sequence[Sequence[Organism]], rng: Chance) -> Choice:
    """An action at random where one is unknown, and with P(explore); else the best."""
    empty = [action for action, each in enumerate(sets) if not _votes(world, each)]
    if empty:
        return Choice(empty[pick(rng, len(empty))], is_test=False, votes=())
    if rng.random() < world.config.explore:
        return Choice(pick(rng, len(sets)), is_test=False, votes=())
    votes = tuple(vote(world, each) for each in sets)
    best = [action for action, each in enumerate(votes) if each == max(votes)]
    action = best[0] if len(best) == 1 else best[pick(rng, len(best))]
    return Choice(action, is_test=True, votes=votes)


def vote(world: World, voters: Sequence[Organism]) -> float:
    """The reward that they expect, each weighed by its strength per volume."""
    total = weighed = plain = 0.0
    for voter in voters:
        weight = voter.strength / voter.volume
        if not is_mature(world, voter):
            weight *= world.config.immature_vote
        total += weight
        weighed += weight * voter.prediction
        plain += voter.prediction
    return weighed / total if total > 0.0 else plain / len(voters)


def _votes(world: World, voters: Sequence[Organism]) -> bool:
    if world.config.readings.vote_of_none is VoteOfNone.EQUAL:
        return bool(voters)
    return any(voter.strength > 0.0 for voter in voters)
