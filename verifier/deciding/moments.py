"""The decisions of a recording one by one: which rule decided, by spec, and what the robot chose.

Rules that latch are followed from the first decision on, as the runtime's arbiter does it.
"""

from dataclasses import dataclass
from typing import final

import numpy as np

from runtime.arbiter import Arbiter, Rule
from runtime.arrays import Array, Booleans, Integers
from runtime.code import ONE
from runtime.machine import evaluate
from verifier.arbitration.choosing import Chooser, latched
from verifier.arbitration.decisions import Decisions
from verifier.deciding.rulings import NEVER, NOTHING, OF_RULES, rulings_at


@final
@dataclass(frozen=True, eq=False, slots=True)
class Memory:
    """What rules keep from decision to decision, before each: (T, rules).

    held: whether each held. bound: whether `lasts` keeps it, whatever is read.
    """

    held: Booleans
    bound: Booleans


@final
@dataclass(frozen=True, eq=False, slots=True)
class Moments:
    """T decisions. expected (T,): the spec's choices; places (T,): the rules that decide so.

    NOTHING where there is none. memory: of an arbiter of rules, else None.
    """

    arbiter: Arbiter
    decisions: Decisions
    expected: Integers
    places: Integers
    memory: Memory | None

    @property
    def agrees(self) -> Booleans:
        """(T,) where the robot chose as the spec does, or was not judged."""
        same: Booleans = (self.decisions.chosen == self.expected) | ~self.decisions.judged
        return same


def moments_of(arbiter: Arbiter, decisions: Decisions, chooser: Chooser | None) -> Moments:
    """The spec's decisions beside the robot's.

    chooser: of an arbiter that has to run (a plan, a competition, code); it has no rules.
    """
    nowhere = np.full(decisions.times.shape, NOTHING)
    if arbiter.paradigm in OF_RULES:
        holds, memory = _followed(arbiter, decisions)
        places = np.where(holds.any(axis=1), holds.argmax(axis=1), NOTHING)
        choices = np.array([*(rule.choice for rule in arbiter.rules), NOTHING])
        return Moments(arbiter, decisions, choices[places], places, memory)
    if chooser is not None:
        return Moments(arbiter, decisions, chooser(decisions), nowhere, None)
    expected = np.array([r.choices[0] for r in rulings_at(arbiter, decisions.register)])
    return Moments(arbiter, decisions, expected, nowhere, None)


def _followed(arbiter: Arbiter, decisions: Decisions) -> tuple[Booleans, Memory]:
    """Which rules hold (T, rules), and what they kept before."""
    when, until = truths_of(arbiter, decisions.register)
    times = decisions.times
    holds = np.stack(
        [latched(r, when[:, k], until[:, k], times) for k, r in enumerate(arbiter.rules)], axis=1
    )
    held = np.vstack([np.zeros_like(holds[:1]), holds[:-1]])
    bound = np.stack(
        [_bound(r, held[:, k], holds[:, k], times) for k, r in enumerate(arbiter.rules)], axis=1
    )
    return holds, Memory(held, bound)


def _bound(rule: Rule, held: Booleans, holds: Booleans, times: Array) -> Booleans:
    """Where `lasts` keeps a rule, because it began to hold not long ago."""
    begins = holds & ~held
    places = np.maximum.accumulate(np.where(begins, np.arange(times.size), 0))
    kept: Booleans = held & (times - times[places] < rule.lasts * (1.0 - 1e-9))
    return kept


def truths_of(arbiter: Arbiter, register: Array) -> tuple[Booleans, Booleans]:
    """Where each rule's `when` and `until` hold, (N, rules) each."""
    codes = [code for rule in arbiter.rules for code in (rule.when or ONE, rule.until or NEVER)]
    truths = evaluate(codes, arbiter.register, register) != 0.0
    return truths[:, 0::2], truths[:, 1::2]


def choices_if(moments: Moments, register: Array, at: Integers) -> Integers:
    """What the spec would choose had it read `register` (N, r) at the decisions `at` (N,)."""
    arbiter = moments.arbiter
    if moments.memory is None:
        return np.array([ruling.choices[0] for ruling in rulings_at(arbiter, register)])
    when, until = truths_of(arbiter, register)
    latches = np.array([rule.until is not None for rule in arbiter.rules])
    goes_on = moments.memory.held[at] & (moments.memory.bound[at] | (latches & ~until))
    holds = when | goes_on
    places = np.where(holds.any(axis=1), holds.argmax(axis=1), NOTHING)
    choices = np.array([*(rule.choice for rule in arbiter.rules), NOTHING])
    return np.asarray(choices[places])
