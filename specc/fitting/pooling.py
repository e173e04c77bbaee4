"""What several recordings say together: weighted means, and where they contradict one another."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from specc.fitting.aims import Aim, Aims, AnyAim
from specc.fitting.rounding import rounded

APART: Final = 1.5
"""Values further apart than this many joint half widths of their intervals contradict."""


def pooled(told: Sequence[Aims]) -> Aims:
    """One aim for each place; a recording that says nothing of a place has no say in it."""
    places = dict.fromkeys(aim.path for each in told for aim in each.aims)
    aims: list[AnyAim] = []
    choices = [sentence for each in told for sentence in each.choices]
    for path in places:
        found = [aim for each in told for aim in each.aims if aim.path == path]
        numbers = [aim for aim in found if isinstance(aim, Aim)]
        aims.append(_mean(numbers) if len(numbers) == len(found) else found[0])
        if _is_contradiction(found):
            values = " and ".join(_shown(aim) for aim in found)
            choices.append(f"{found[0].name}: the recordings contradict one another: {values}")
    beyond = dict.fromkeys(sentence for each in told for sentence in each.beyond)
    left = dict.fromkeys(sentence for each in told for sentence in each.left)
    return Aims(tuple(aims), tuple(beyond), tuple(left), tuple(dict.fromkeys(choices)))


def _mean(found: Sequence[Aim]) -> Aim:
    """Weighted by the inverse squares of the half widths."""
    exact = [aim for aim in found if aim.half <= 0.0]
    if exact or len(found) == 1:
        return (exact or found)[0]
    weights = [aim.half**-2.0 for aim in found]
    value = sum(w * aim.value for w, aim in zip(weights, found, strict=True)) / sum(weights)
    said = "; ".join(dict.fromkeys(aim.sentence for aim in found))
    return replace(found[0], value=value, half=sum(weights) ** -0.5, sentence=said)


def _is_contradiction(found: Sequence[AnyAim]) -> bool:
    numbers = [aim for aim in found if isinstance(aim, Aim)]
    if len(numbers) < len(found):
        return bool(numbers) or len({_shown(aim) for aim in found}) > 1
    return any(
        abs(one.value - other.value) > APART * (one.half**2 + other.half**2) ** 0.5
        for one in numbers
        for other in numbers
    )


def _shown(aim: AnyAim) -> str:
    if not isinstance(aim, Aim):
        return aim.text
    return rounded(aim.value / aim.scale, aim.half / aim.scale)
