"""The lists that may be better than the best so far: what is learnt, and lists like the best."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Final

import numpy as np

from lcs.arrays import Array, Integers
from lcs.policies.decision_list import DecisionList
from lcs.policies.learner import Found, found_policy, offer_of
from lcs.policies.mending import mended
from lcs.policies.shortened import shortened
from lcs.policies.steps import Steps
from lcs.policies.variations import Variation
from runtime.arbiter import Arbiter
from runtime.scenario import Scenario
from specc.training.episode import trained_arbiter, training_of
from specc.training.settings import Settings

VARYING: Final = 3
"""What sets the chance of variations apart from other chance."""


def challengers_of(
    lived: Steps,
    champion: DecisionList | None,
    scenario: Scenario,
    settings: Settings,
    number: int,
) -> Found:
    """What is learnt now, with all lists that may be better than the best so far.

    Those that are made of it come first, then the best so far with rules more where it loses most,
    then the same changed at random.

    Raises:
        LearnerError: what is read, or rewarded, is not finite.
    """
    found = policy_of(lived, scenario, settings, number)
    if champion is None:
        return found
    chance = np.random.default_rng([settings.seed, number, VARYING])
    actions = len(trained_arbiter(scenario).choices)
    variation = Variation(found.lists, found.x, actions, settings.rules, chance)
    like = [*_mended(champion, lived, found, settings)]
    like += [variation.of(champion) for _ in range(settings.varied)]
    return replace(found, lists=(*found.lists, *(shortened(each, found.x) for each in like)))


def _mended(
    champion: DecisionList, lived: Steps, found: Found, settings: Settings
) -> Iterator[DecisionList]:
    """The champion with rules more, where its own decisions lose most by what is known now."""
    own = own_places(champion, lived)
    x, cost = found.x[own], found.cost[own]
    count = settings.mended // 2
    yield from mended(
        champion, offer_of(found.tables[0]), x, cost, most=settings.rules, count=count
    )


def own_places(rules: DecisionList, lived: Steps) -> Integers:
    """The steps (D,) of all episodes in which a list would have chosen the same throughout."""
    same = rules.decide(lived.x) == lived.action
    ends = np.flatnonzero(lived.last) + 1
    starts = np.append(0, ends[:-1])
    throughout = np.logical_and.reduceat(same, starts) if len(starts) else np.zeros(0, np.bool_)
    own: Integers = np.flatnonzero(np.repeat(throughout, ends - starts))
    return own


def policy_of(lived: Steps, scenario: Scenario, settings: Settings, number: int) -> Found:
    """What is learnt from all steps so far, in the generation of that number.

    Rules have bounds of few digits, and decide on these steps as those that were learnt.
    """
    arbiter = trained_arbiter(scenario)
    found = found_policy(
        lived,
        ranges_of(arbiter),
        len(arbiter.choices),
        discount=training_of(scenario).discount,
        learner=settings.learner,
        seed=_seed(settings.seed, number),
        most=settings.rules,
    )
    return replace(found, lists=tuple(shortened(rules, found.x) for rules in found.lists))


def _seed(*parts: int) -> int:
    """One number that follows from several, and hardly from others."""
    return int(np.random.SeedSequence(parts).generate_state(1)[0])


def ranges_of(arbiter: Arbiter) -> tuple[Array, Array]:
    """The lowest and the highest of what it reads, (m,) each, SI; of a value by name its index."""
    low = [0.0 if each.values else each.low for each in arbiter.reads]
    high = [float(len(each.values) - 1) if each.values else each.high for each in arbiter.reads]
    return np.array(low), np.array(high)
