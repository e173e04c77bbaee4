"""How disagreements follow one another in a robot that only just decides as often as is required.

A log without disagreements does not show how long one lasts. So thresholds are moved, in thought,
until the share that is required is reached, and what then differs is looked at.
"""

from typing import Final

import numpy as np

from runtime.arrays import Booleans
from runtime.machine import evaluate
from verifier.arbitration.choosing import RuleChooser
from verifier.arbitration.decisions import Decisions
from verifier.arbitration.shares import FEW, slowness_of

PLAIN: Final = 2.0
"""A threshold whose least move changes so many times what is allowed shows without statistics."""


def slowness_at_limit(rules: RuleChooser, decisions: Decisions, required: float) -> float:
    """The greatest autocorrelation time, in decisions, of what one moved threshold changes.

    Infinite where none changes so many: then nothing is known of it.
    """
    judged = decisions.judged
    wanted = max((1.0 - required) * judged.sum(), FEW)
    expected = rules(decisions)[judged]
    found = []
    for entry, own in rules.values.items():
        codes = [each.reading for each in rules.opened.comparisons if each.entry == entry]
        readings = np.unique(evaluate(codes, rules.register, decisions.register[judged]))
        for values in (readings[readings < own][::-1], readings[readings > own]):

            def changed(place: int, entry: str = entry, values: object = values) -> Booleans:
                moved = rules.moved(entry, float(np.asarray(values)[place]))
                other: Booleans = moved(decisions)[judged] != expected
                return other

            near, far = 0, values.size - 1
            if far < 0 or changed(far).sum() < wanted:
                continue
            while near < far:
                middle = (near + far) // 2
                near, far = (near, middle) if changed(middle).sum() >= wanted else (middle + 1, far)
            at_limit = changed(near)
            if at_limit.sum() <= PLAIN * wanted:
                found.append(slowness_of(at_limit.astype(float)))
    return max(found, default=np.inf)
