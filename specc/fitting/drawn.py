"""A drawn field (`arrows`, an inline `grid`) moved to what the robot does, vector by vector."""

from dataclasses import dataclass, replace
from typing import Final, final

import numpy as np

from compiler.quantities import rate_text
from compiler.shares import Shares, shares_of
from runtime.arrays import Booleans
from runtime.program import Program
from spec_schema.load import Loaded
from spec_schema.places import dotted
from specc.fitting.aims import Aim, Aims
from specc.fitting.cases import Case, Logs, Tell
from specc.fitting.compiling import compiled
from specc.fitting.moves import Move, moved, moves_of
from specc.fitting.pooling import pooled
from verifier.diagnosis.vectors import DrawnField, fitted_vectors
from verifier.report.report import Verdict

SENTENCE: Final = (
    "of all fields that predict the recording as well, this one moves the drawn vectors least"
)
ROUNDS: Final = 3
"""So often the vectors are fitted: each time about the field that the last one left."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Redrawn:
    """Moves of vectors, and what is said of those that stay."""

    moves: tuple[Move, ...]
    stays: tuple[str, ...]


def redrawn(loaded: Loaded, cases: tuple[Case, ...], logs: Logs, tell: Tell) -> Redrawn | None:
    """The vectors as the recordings tell them; None where the field is not drawn inline."""
    shares = shares_of(loaded)
    if shares is None:
        return None
    found: dict[str, Move] = {}
    is_told: Booleans = np.zeros(shares.values.shape, dtype=bool)
    for _ in range(ROUNDS):
        tell("fitting vectors")
        aims, told = _aims(shares, cases)
        is_told |= told
        moves = moves_of(loaded, aims)
        for move in moves:
            first = found.get(move.path, move)
            found[move.path] = replace(move, old=first.old, place=first.place)
        if not moves:
            break
        loaded, program = compiled(moved(loaded.source, moves))
        cases = logs.judged_again(cases, program, tell)
        shares = shares_of(loaded) or shares
        if all(case.report.verdict is Verdict.PASS for case in cases):
            break
    return Redrawn(tuple(found.values()), _stays(is_told))


def _aims(shares: Shares, cases: tuple[Case, ...]) -> tuple[tuple[Aim, ...], Booleans]:
    """Where the vectors shall be, pooled over the recordings, and which are told at all."""
    drawn = DrawnField(shares.over, shares.drives, shares.sample, shares.values)
    is_told: Booleans = np.zeros(shares.values.shape, dtype=bool)
    told = []
    for case in cases:
        _, study = case.judged()
        if study is None:
            continue
        found = fitted_vectors(case.program, study, drawn, case.report.confidence)
        is_told |= found.is_told
        aims = [
            _aim(shares, case.program, place, float(found.values[place]), float(found.half[place]))
            for place in zip(*np.nonzero(np.isfinite(found.half)), strict=True)
        ]
        told.append(Aims(tuple(aims)))
    together = pooled(told).aims
    return tuple(aim for aim in together if isinstance(aim, Aim)), is_told


def _aim(
    shares: Shares, program: Program, place: tuple[int, int], value: float, half: float
) -> Aim:
    vector, column = int(place[0]), int(place[1])
    name = shares.drives[column]
    path = shares.paths[vector][column]
    unit = next(state.unit for state in program.states if state.name == name)
    text = rate_text(unit.text)
    shown = dotted(path).removeprefix("$.field.")
    return Aim(path, shown, value, half, text, unit.scale, SENTENCE)


def _stays(is_told: Booleans) -> tuple[str, ...]:
    untold = int(np.sum(~is_told))
    if not untold:
        return ()
    of = f"{untold} of {is_told.size} numbers of the drawn field"
    return (f"{of} stay as they are: the robot did not come near enough to tell them",)
