"""Where in the domain a number of the spec would show."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from runtime.arrays import Array, frozen
from runtime.flow import Flow, flow_of, next_states, rates
from runtime.program import Control, Kind, Program, State
from verifier.diagnosis.parameters import Parameter
from verifier.report.diagnosis import ParameterKind
from verifier.report.wording import listed, quantity, shown, span

POINTS: Final = 2048
SEED: Final = 11
BEST: Final = 0.05
"""The share of all points at which a number shows most."""
NARROW: Final = 0.6
"""A variable is worth naming whose values there span less than this share of its domain."""
HALF: Final = 0.5
FEW: Final = 0.15
"""Or of which so few are in the middle half of it."""
STEP: Final = 0.02
"""The change of a number, in its sizes, whose effect on the rates is looked at."""


def where_it_shows(program: Program, members: list[Parameter], weights: Array) -> str:
    """A suggestion where to record so that a change along `weights` shows; empty without one."""
    flow = flow_of(program)
    points = _points(flow)
    effect = _effect(flow, points, members, weights)
    if not np.any(effect > 0.0):
        return ""
    best = points[np.argsort(-effect, kind="stable")[: int(BEST * POINTS)]]
    n = len(program.states)
    places = _places(program.states, best[:, :n]) or [
        place
        for control, place in _named(program.controls, best[:, n:])
        if control.name not in {each.name for each in members}
    ]
    return f"record at {listed(places)}: there it shows most" if places else ""


def _places(parts: tuple[State, ...], best: Array) -> list[str]:
    return [place for _, place in _named(parts, best)]


def _named(parts: Sequence[State | Control], best: Array) -> list[tuple[State | Control, str]]:
    """The variables that have to be somewhere, and where: of the points `best` (B, columns)."""
    found: list[tuple[State | Control, str]] = []
    for column, part in enumerate(parts):
        if not _is_name(part):
            share = (best[:, column] - part.low) / (part.high - part.low)
            low, high = np.quantile(share, [0.1, 0.9])
            if high - low < NARROW:
                ends = part.low + np.array([low, high]) * (part.high - part.low)
                found.append((part, f"{part.name} from {span(ends[0], ends[1], part.unit)}"))
            elif np.mean(np.abs(share - 0.5) < HALF / 2.0) < FEW:
                found.append((part, f"{part.name} near {_either(part)}"))
    return found


def _either(part: State | Control) -> str:
    return f"{shown(part.low, part.unit)} or {quantity(part.high, part.unit)}"


def _is_name(part: State | Control) -> bool:
    return isinstance(part, State) and part.kind is Kind.DISCRETE


def _points(flow: Flow) -> Array:
    """Points (P, n + p) spread over the domain of the states and controls."""
    parts: tuple[State | Control, ...] = (*flow.program.states, *flow.program.controls)
    share = np.random.default_rng(SEED).random((POINTS, len(parts)))
    columns = [
        np.floor(share[:, i] * len(part.values))
        if isinstance(part, State) and part.kind is Kind.DISCRETE
        else part.low + share[:, i] * (part.high - part.low)
        for i, part in enumerate(parts)
    ]
    return np.stack(columns, axis=-1)


def _effect(flow: Flow, points: Array, members: list[Parameter], weights: Array) -> Array:
    """How much (P,) the rates change, in widths of the domain, the largest of all states."""
    widths = np.array([s.high - s.low if s.high > s.low else 1.0 for s in flow.program.states])
    sides = [_rates(flow, points, members, side * STEP * weights) for side in (1.0, -1.0)]
    change = np.abs(sides[0] - sides[1]) / widths
    return np.asarray(np.max(np.nan_to_num(change), axis=-1, initial=0.0))


def _rates(flow: Flow, points: Array, members: list[Parameter], moves: Array) -> Array:
    """The rates (P, n), of a step map the next states, with each member moved by so many sizes."""
    names = list(flow.program.register)
    moved, defaults = np.array(points), np.array(flow.defaults)
    gain, offset = np.ones((2, len(flow.program.states)))
    offset -= 1.0
    for member, move in zip(members, moves * [each.size for each in members], strict=True):
        column = names.index(member.name) if member.name in names else -1
        match member.kind:
            case ParameterKind.CONTROL | ParameterKind.INPUT_OFFSET:
                moved[:, column] += move
            case ParameterKind.INPUT_GAIN:
                moved[:, column] *= 1.0 + move
            case ParameterKind.CONSTANT:
                defaults[column] += move
            case ParameterKind.RATE_GAIN:
                gain[column] += move
            case ParameterKind.RATE_OFFSET:
                offset[column] += move
            case _:
                raise AssertionError(f"{member.kind} is not looked at")
    n = len(flow.program.states)
    moved = np.clip(moved, flow.domain[0, : moved.shape[1]], flow.domain[1, : moved.shape[1]])
    act = next_states if flow.is_map else rates
    plain = act(replace(flow, defaults=frozen(defaults)), moved[:, :n], moved[:, n:])
    return np.asarray(plain * gain + offset)
