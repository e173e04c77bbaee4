"""Numbers of the spec that a trace cannot tell, or tells only together.

From the information matrix F of a refit. In sizes (a large change of each number) its inverse's
diagonal are the squares of the best standard errors that any refit can have (Cramér and Rao). A
number whose error would be large even if all others were known has no effect that shows; an
eigenvector of what is left, with a small eigenvalue, is a combination that can change unseen:
its members are told only together.
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array
from runtime.program import Program
from verifier.diagnosis.parameters import Parameter
from verifier.diagnosis.sensitivities import Sensitivities
from verifier.fidelity.stretches.needs import names_read
from verifier.limits.telling import where_it_shows
from verifier.report.diagnosis import ParameterKind
from verifier.report.limits import NotTold
from verifier.report.wording import listed

VAGUE: Final = 0.1
"""A number with a larger standard error, as a share of its size, is not told."""
TAKES_PART: Final = 0.3
"""A member of a combination has at least this share of the largest member's weight."""
OWN: Final = (ParameterKind.CONTROL, ParameterKind.CONSTANT)
PAIRS: Final = (
    (ParameterKind.RATE_GAIN, ParameterKind.RATE_OFFSET),
    (ParameterKind.INPUT_GAIN, ParameterKind.INPUT_OFFSET),
)


@final
@dataclass(frozen=True, eq=False, slots=True)
class Flat:
    """Parameters that cannot be told apart from this trace; alone: one without visible effect.

    members: places in the list of parameters; weights: how they move together, in their sizes.
    """

    members: tuple[int, ...]
    weights: Array


def untold_of_numbers(
    program: Program, found: Sensitivities, known: frozenset[str]
) -> list[NotTold]:
    """Numbers of the spec, and gains and offsets, that no refit of this trace could tell.

    known: variables of which that is said already.
    """
    read = names_read(program)
    # What only guards read moves no window: the changes of mode tell it.
    own = [i for i, p in enumerate(found.parameters) if p.kind in OWN and p.name in read]
    groups = [own, *_pairs(found.parameters, known)]
    return [
        _said(program, [found.parameters[i] for i in flat.members], flat.weights)
        for group in groups
        for flat in flat_directions(found, group)
    ]


def flat_directions(found: Sensitivities, group: list[int]) -> list[Flat]:
    """The flat directions among some of the parameters, others held."""
    if not group:
        return []
    sizes = np.array([found.parameters[i].size for i in group])
    scaled = found.information[np.ix_(group, group)] * np.outer(sizes, sizes)
    least = VAGUE**-2.0
    shows = np.diag(scaled) >= least
    alone = [Flat((group[i],), np.ones(1)) for i in np.flatnonzero(~shows)]
    left = np.flatnonzero(shows)
    values, vectors = np.linalg.eigh(scaled[np.ix_(left, left)])
    together = []
    for value, vector in zip(values, vectors.T, strict=True):
        if value < least:
            part = np.flatnonzero(np.abs(vector) >= TAKES_PART * np.max(np.abs(vector)))
            together.append(Flat(tuple(group[left[i]] for i in part), vector[part]))
    return alone + together


def _pairs(parameters: tuple[Parameter, ...], known: frozenset[str]) -> list[list[int]]:
    """The gain and the offset of each rate and of each input."""
    names = dict.fromkeys(each.name for each in parameters if each.name not in known)
    pairs = [
        [i for i, each in enumerate(parameters) if each.name == name and each.kind in kinds]
        for name in names
        for kinds in PAIRS
    ]
    return [pair for pair in pairs if pair]


def _said(program: Program, members: list[Parameter], weights: Array) -> NotTold:
    labels = [_label(each) for each in members]
    where = where_it_shows(program, members, weights)
    if len(members) == 1:
        what = f"the value of {labels[0]}" if members[0].kind in OWN else labels[0]
        why = f"nothing that was measured depends visibly on {labels[0]}"
    else:
        what = f"{listed(labels)} apart from one another: they are told only together"
        why = (
            f"what a change of {labels[0]} does can be undone by one of {listed(labels[1:])}, as"
            " far as this trace shows"
        )
    return NotTold(
        what=what,
        names=tuple(dict.fromkeys(each.name for each in members)),
        why=why,
        suggestion=where or "vary the inputs more, and begin runs at more places",
        origin=members[0].origin,
    )


def _label(parameter: Parameter) -> str:
    return parameter.label if parameter.kind in OWN else f"the {parameter.label}"
