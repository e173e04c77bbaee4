"""Which explanations are as good as one that was taken, now that all the others are in, too.

Where two causes act together, each is tried first with the other one left out, and many a wrong one
does as well then. Here each rival takes the place of what was taken, beside all the rest.
"""

from dataclasses import replace
from typing import Final

import numpy as np

from runtime.arrays import Array
from verifier.diagnosis.fitting import Fit, correlation_time, fit
from verifier.diagnosis.heldout import Scored, scored
from verifier.diagnosis.scene import Scene
from verifier.diagnosis.selection import CLOSE, Selection, Step, Tried

MOST: Final = 8
"""So many rivals of one step are tried again, the best first."""


def still_alike(scene: Scene, selection: Selection) -> Selection:
    """With those rivals left out that do worse beside the rest of what was taken."""
    final = selection.final
    if len(final.effects) < 2:
        return selection
    held_out, thinning = scored(scene, final), correlation_time(scene, final.left.residual)
    taken = {id(step) for step in selection.taken}
    steps = tuple(
        _without_beaten(scene, final, held_out, thinning, step) if id(step) in taken else step
        for step in selection.steps
    )
    return replace(selection, steps=steps)


def _without_beaten(
    scene: Scene, final: Fit, held_out: Scored, thinning: Array, step: Step
) -> Step:
    labels = [each.label for each in final.effects]
    place = labels.index(step.tried[0].effect.label)
    alike = []
    for rival in step.alike[:MOST]:
        if rival.effect.label in labels:
            continue
        other = scored(scene, _in_place(scene, final, place, rival))
        lead = np.sum((held_out.likelihood - other.likelihood) / thinning)
        numbers = len(final.effects[place].numbers) - len(rival.effect.numbers)
        if float(lead) - numbers < CLOSE:
            alike.append(rival)
    return replace(step, alike=tuple(alike))


def _in_place(scene: Scene, final: Fit, place: int, rival: Tried) -> Fit:
    """The last fit with a rival in the place of one effect, all numbers fitted again."""
    first = sum(len(each.numbers) for each in final.effects[:place])
    last = first + len(final.effects[place].numbers)
    own = rival.fitted.values[len(rival.fitted.values) - len(rival.effect.numbers) :]
    effects = (*final.effects[:place], rival.effect, *final.effects[place + 1 :])
    values = (*final.values[:first], *own, *final.values[last:])
    return fit(scene, effects, values, final.starts, final.sigma)
