"""What may decide where: each rule surely, or only if it held already (hysteresis), or not."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Final, TypeAlias, final

import numpy as np

from runtime.arbiter import Arbiter, Paradigm
from runtime.arrays import Array
from runtime.code import ONE, Code
from runtime.machine import evaluate
from verifier.deciding.conditions import Values
from verifier.deciding.features import Feature, differences, features_of
from verifier.deciding.reading import values_of

NEVER: Final = Code("0")
NOTHING: Final = -1
"""No rule, and no choice."""
OF_RULES: Final = frozenset({Paradigm.RULES, Paradigm.SUBSUMPTION})
DRAWN: Final = OF_RULES | {Paradigm.WEIGHTS}
"""What decides by what is read alone, or nearly: others remember too much to be drawn."""


@final
@dataclass(frozen=True, slots=True)
class Ruling:
    """What may decide: the places of rules, the last of which surely holds, -1 for none.

    Those before it hold only where they held already. choices: what may be chosen, each once.
    Weights have no rules: `places` is empty.
    """

    places: tuple[int, ...]
    choices: tuple[int, ...]

    @property
    def is_band(self) -> bool:
        """Whether what is chosen depends on what was."""
        return len(self.choices) > 1


Rulings: TypeAlias = list[Ruling]


def register_at(arbiter: Arbiter, held: Values) -> Array:
    """The register (r,) with reads in the middle of their domains, the lowest of discrete ones."""
    values = values_of(arbiter, {})
    for read in arbiter.reads:
        values[read.name] = 0.0 if read.values else 0.5 * (read.low + read.high)
    values |= held
    return np.array([values[name] for name in arbiter.register])


def rulings_at(arbiter: Arbiter, register: Array) -> Rulings:
    """The ruling at each of some points (N, r), SI."""
    if arbiter.paradigm is Paradigm.WEIGHTS:
        return _by_weights(arbiter, register)
    codes = [code for rule in arbiter.rules for code in (rule.when or ONE, rule.until or NEVER)]
    truths = evaluate(codes, arbiter.register, register) != 0.0
    holds, ends = truths[:, 0::2], truths[:, 1::2]
    latches = np.array([rule.until is not None for rule in arbiter.rules])
    states = np.where(holds, 2, np.where(latches & ~ends, 1, 0))
    kinds, of_kind = np.unique(states, axis=0, return_inverse=True)
    known = [_ruling(arbiter, kind.tolist()) for kind in kinds]
    return [known[i] for i in of_kind.reshape(-1).tolist()]


def _ruling(arbiter: Arbiter, states: list[int]) -> Ruling:
    sure = states.index(2) if 2 in states else NOTHING
    before = states[: sure if sure != NOTHING else len(states)]
    places = (*(place for place, state in enumerate(before) if state == 1), sure)
    chosen = [NOTHING if p == NOTHING else arbiter.rules[p].choice for p in places]
    return Ruling(places, tuple(dict.fromkeys(chosen)))


def _by_weights(arbiter: Arbiter, register: Array) -> Rulings:
    weights = np.nan_to_num(evaluate(arbiter.weights, arbiter.register, register))
    best = np.where(weights.max(axis=1) > 0.0, weights.argmax(axis=1), NOTHING)
    known: Mapping[int, Ruling] = {k: Ruling((), (k,)) for k in np.unique(best).tolist()}
    return [known[k] for k in best.tolist()]


def boundaries(arbiter: Arbiter, moving: Collection[str]) -> tuple[Feature, ...]:
    """The functions at whose zeros another rule, or another weight, may decide."""
    if arbiter.paradigm is Paradigm.WEIGHTS:
        return differences(arbiter.weights, moving)
    conditions = [code for rule in arbiter.rules for code in (rule.when, rule.until) if code]
    return features_of(conditions, moving)
