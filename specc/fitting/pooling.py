"""What several recordings say together: weighted means, and where they contradict one another."""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from scipy import special

from specc.fitting.aims import Aim, Aims, AnyAim
from specc.fitting.rounding import rounded
from verifier.fidelity.judging.departure import CONFIDENCE

ALARMS: Final = 0.01
"""Share of all numbers on which the recordings agree that are taken for a contradiction."""

HALF: Final = float(special.ndtri(0.5 + 0.5 * CONFIDENCE))
"""Half the width of an interval, in standard deviations."""


def pooled(told: Sequence[Aims]) -> Aims:
    """What all of them say, each sentence once."""
    aims, contradictions = pooled_aims([each.aims for each in told])
    choices = [*(sentence for each in told for sentence in each.choices), *contradictions]
    beyond = dict.fromkeys(sentence for each in told for sentence in each.beyond)
    left = dict.fromkeys(sentence for each in told for sentence in each.left)
    by_hand = dict.fromkeys(sentence for each in told for sentence in each.by_hand)
    return Aims(aims, tuple(beyond), tuple(left), tuple(dict.fromkeys(choices)), tuple(by_hand))


def pooled_aims(
    told: Sequence[tuple[AnyAim, ...]],
) -> tuple[tuple[AnyAim, ...], tuple[str, ...]]:
    """One aim for each place, and sentences on contradictions.

    A recording that says nothing of a place has no say in it.
    """
    aims: list[AnyAim] = []
    contradictions: list[str] = []
    for path in dict.fromkeys(aim.path for each in told for aim in each):
        found = [aim for each in told for aim in each if aim.path == path]
        numbers = [aim for aim in found if isinstance(aim, Aim)]
        aims.append(_mean(numbers) if len(numbers) == len(found) else found[0])
        if _is_contradiction(found):
            values = " and ".join(_shown(aim) for aim in found)
            contradictions.append(
                f"{found[0].name}: the recordings contradict one another: {values}"
            )
    return tuple(aims), tuple(contradictions)


def _mean(found: Sequence[Aim]) -> Aim:
    """Weighted by the inverse squares of the half widths."""
    exact = [aim for aim in found if aim.half <= 0.0]
    weights = [] if exact else [aim.half**-2.0 for aim in found]
    total = sum(weights)
    if len(found) == 1 or total <= 0.0:
        return (exact or found)[0]
    value = sum(w * aim.value for w, aim in zip(weights, found, strict=True)) / total
    said = "; ".join(dict.fromkeys(aim.sentence for aim in found))
    return replace(found[0], value=value, half=total**-0.5, sentence=said)


def _is_contradiction(found: Sequence[AnyAim]) -> bool:
    numbers = [aim for aim in found if isinstance(aim, Aim)]
    if len(numbers) < len(found):
        return bool(numbers) or len({_shown(aim) for aim in found}) > 1
    return _chance(numbers) < ALARMS


def _chance(numbers: Sequence[Aim]) -> float:
    """Of values at least as far apart as these, if all recordings are of one true value.

    Cochran's Q, the weighted sum of squares about the weighted mean, is chi-square with one degree
    of freedom less than there are values (Biometrics 10, 1954, 101-129). Where some are exact, it
    is taken about them, and nothing is estimated.
    """
    exact = {aim.value for aim in numbers if aim.half <= 0.0}
    if len(exact) > 1:
        return 0.0
    rough = [aim for aim in numbers if 0.0 < aim.half < math.inf]
    freedom = len(rough) - (not exact)
    if freedom < 1:
        return 1.0
    center = exact.pop() if exact else _mean(rough).value
    q = sum((HALF * (aim.value - center) / aim.half) ** 2 for aim in rough)
    return float(special.chdtrc(freedom, q))


def _shown(aim: AnyAim) -> str:
    if not isinstance(aim, Aim):
        return aim.text
    return rounded(aim.value / aim.scale, aim.half / aim.scale)
