"""What several recordings say together: weighted means, and where they contradict one another."""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from scipy import special

from specc.fitting.aims import Aim, Aims, AnyAim
from specc.fitting.rounding import rounded
from verifier.fidelity.judging.departure import CONFIDENCE
from verifier.report.wording import listed

ALARMS: Final = 0.01
"""Share of all numbers on which the recordings agree that are taken for a contradiction."""

HALF: Final = float(special.ndtri(0.5 + 0.5 * CONFIDENCE))
"""Half the width of an interval, in standard deviations."""


def pooled(told: Sequence[Aims]) -> Aims:
    """What all of them say, each sentence once."""
    witnesses = [aim for each in told for aim in each.witnesses]
    aims, contradictions = pooled_aims([each.aims for each in told], witnesses)
    choices = [*contradictions, *(sentence for each in told for sentence in each.choices)]
    beyond = dict.fromkeys(sentence for each in told for sentence in each.beyond)
    left = dict.fromkeys(sentence for each in told for sentence in each.left)
    by_hand = dict.fromkeys(sentence for each in told for sentence in each.by_hand)
    return Aims(
        aims,
        tuple(beyond),
        tuple(left),
        tuple(dict.fromkeys(choices)),
        tuple(by_hand),
        contradicts=bool(contradictions),
    )


def pooled_aims(
    told: Sequence[tuple[AnyAim, ...]], witnesses: Sequence[Aim] = ()
) -> tuple[tuple[AnyAim, ...], tuple[str, ...]]:
    """One aim for each place, and sentences on contradictions.

    A recording that says nothing of a place has no say in it; one that tells the number there, and
    agrees with the spec, may contradict the others, and moves nothing. Contradictions about the
    robot come before those about its logs.
    """
    aims: list[AnyAim] = []
    found_apart: list[tuple[bool, str]] = []
    for path in dict.fromkeys(aim.path for each in told for aim in each):
        found = [aim for each in told for aim in each if aim.path == path]
        numbers = [aim for aim in found if isinstance(aim, Aim)]
        aims.append(_mean(numbers) if len(numbers) == len(found) else found[0])
        heard = [*found, *(aim for aim in witnesses if aim.path == path)]
        if _is_contradiction(heard):
            found_apart.append((path[0] == "trace", _contradiction(heard)))
    found_apart.sort(key=lambda each: each[0])
    return tuple(aims), tuple(said for _, said in found_apart)


def _mean(found: Sequence[Aim]) -> Aim:
    """Weighted by the inverse squares of the half widths."""
    exact = [aim for aim in found if aim.half <= 0.0]
    weights = [] if exact else [aim.half**-2.0 for aim in found]
    total = sum(weights)
    if len(found) == 1 or total <= 0.0:
        return (exact or found)[0]
    value = sum(w * aim.value for w, aim in zip(weights, found, strict=True)) / total
    said = "; ".join(dict.fromkeys(aim.sentence for aim in found))
    if all(aim.source for aim in found):
        values = ", ".join(f"{_shown(aim)} in {aim.source}" for aim in found)
        said = f"{found[0].name}, as {len(found)} recordings tell: {values}"
    return replace(found[0], value=value, half=total**-0.5, sentence=said)


def _is_contradiction(found: Sequence[AnyAim]) -> bool:
    numbers = [aim for aim in found if isinstance(aim, Aim)]
    if len(numbers) < len(found):
        return bool(numbers) or len({_shown(aim) for aim in found}) > 1
    return _chance(numbers) < ALARMS


def _contradiction(found: Sequence[AnyAim]) -> str:
    """Which recordings agree with which: groups that one number would do for."""
    said = f"{found[0].name}: the recordings contradict one another"
    numbers = sorted((aim for aim in found if isinstance(aim, Aim)), key=lambda aim: aim.value)
    if len(numbers) < len(found) or not any(aim.source for aim in found):
        return f"{said}: {' and '.join(_shown(aim) for aim in found)}"
    groups: list[list[Aim]] = []
    for aim in numbers:
        if groups and _chance([*groups[-1], aim]) >= ALARMS:
            groups[-1].append(aim)
        else:
            groups.append([aim])
    told = "; ".join(
        f"{_shown(_mean(group))} in {listed([aim.source for aim in group])}" for group in groups
    )
    return f"{said}, and fall into {len(groups)} groups ({told}); fit each group by itself"


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
