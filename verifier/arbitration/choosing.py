"""What the spec would choose at each decision, from what was read there.

Latches go on from decision to decision: whole arrays at a time where a rule has no least
duration, else episode by episode.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import TypeAlias, final

import numpy as np

from runtime.arbiter import Arbiter, Rule
from runtime.arrays import Array, Booleans, Integers
from runtime.code import ONE, Code
from runtime.machine import evaluate
from verifier.arbitration.comparisons import Opened
from verifier.arbitration.decisions import Decisions

NEVER = Code("0")
NONE = -1
"""No choice at all."""

Chooser: TypeAlias = Callable[[Decisions], Integers]
"""What is chosen (T,) at each decision, NONE where nothing is."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class RuleChooser:
    """Rules, or layers of a subsumption, of which the first that holds is the choice.

    values: SI, of the thresholds' entries.
    """

    opened: Opened
    register: tuple[str, ...]
    values: dict[str, float]

    def __call__(self, decisions: Decisions) -> Integers:
        """The choice at each decision."""
        codes = [c for r in self.opened.rules for c in (r.when or ONE, r.until or NEVER)]
        held = np.array([self.values[name] for name in self.opened.entries])
        wide = np.broadcast_to(held, (decisions.times.size, held.size))
        names = (*self.register, *self.opened.entries)
        truths = evaluate(codes, names, np.hstack([decisions.register, wide])) != 0.0
        chosen = np.full(decisions.times.shape, NONE)
        for place in reversed(range(len(self.opened.rules))):
            rule = self.opened.rules[place]
            holds = latched(rule, truths[:, 2 * place], truths[:, 2 * place + 1], decisions.times)
            chosen[holds] = rule.choice
        return chosen

    def moved(self, entry: str, value: float) -> "RuleChooser":
        """The same with another threshold."""
        return RuleChooser(self.opened, self.register, {**self.values, entry: value})


def rule_chooser(
    arbiter: Arbiter, opened: Opened, set_to: Mapping[str, float] = MappingProxyType({})
) -> RuleChooser:
    """The spec's own rules, with their thresholds at the values that it gives them.

    set_to: of controls that were set to something else all the while.
    """
    defaults = {c.name: c.default for c in arbiter.controls} | dict(set_to)
    defaults |= {c.name: c.value for c in arbiter.constants}
    point = np.array([defaults.get(name, 0.0) for name in arbiter.register])
    values = {
        each.entry: float(evaluate([each.side], arbiter.register, point)[0])
        for each in opened.comparisons
    }
    return RuleChooser(opened, arbiter.register, values)


def latched(rule: Rule, when: Booleans, until: Booleans, times: Array) -> Booleans:
    """Where the rule holds: from `when` on, until it is released, and for at least `lasts`."""
    released = ~when if rule.until is None else ~when & until
    if rule.lasts > 0.0:
        return _in_episodes(when, released, times, rule.lasts * (1.0 - 1e-9))
    places = np.arange(when.size)
    last_begun = np.maximum.accumulate(np.where(when, places, -1))
    last_ended = np.maximum.accumulate(np.where(released, places, -1))
    holds: Booleans = last_begun > last_ended
    return holds


def _in_episodes(when: Booleans, released: Booleans, times: Array, lasts: float) -> Booleans:
    holds = np.zeros(when.shape, dtype=np.bool_)
    begins, ends = np.flatnonzero(when), np.flatnonzero(released)
    start = int(begins[0]) if begins.size else when.size
    while start < when.size:
        first = int(np.searchsorted(times, times[start] + lasts))
        after = int(np.searchsorted(ends, max(first, start + 1)))
        stop = int(ends[after]) if after < ends.size else when.size
        holds[start:stop] = True
        following = int(np.searchsorted(begins, stop))
        start = int(begins[following]) if following < begins.size else when.size
    return holds


def stepwise(
    decide: Callable[[Array, float], Array], inputs: int, choices: Sequence[str]
) -> Chooser:
    """The strongest choice of each tick of an arbiter that runs; NONE where all are 0."""
    assert choices, "an arbiter has choices"

    def choose(decisions: Decisions) -> Integers:
        chosen = np.full(decisions.times.shape, NONE)
        for place, time in enumerate(decisions.times.tolist()):
            numbers = decide(decisions.register[place, :inputs], time)
            if numbers.max() > 0.0:
                chosen[place] = int(np.argmax(numbers))
        return chosen

    return choose
