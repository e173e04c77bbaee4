"""How far robots with planted faults would have been from where the robot was.

All copies at once: L lanes, K knots, S steps, n states, p controls, D predicted states.
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Booleans, Integers
from runtime.flow import Flow, next_states, rates
from runtime.program import Kind
from verifier.fidelity.shooting.jumps import jumped, switch_knots
from verifier.fidelity.shooting.study import Study
from verifier.fidelity.stretches.needs import Input
from verifier.limits.faults import Planned
from verifier.limits.knots import Knots, mean_input
from verifier.report.limits import Fault

FAR: Final = 0.25
"""A robot that left the domain, and is further away than this share of it, begins anew where the
real one is."""
SHORTEST: Final = 4
LONGEST: Final = 64
"""So many steps are integrated at once, more where that is"""
EASY: Final = 8
"""done in so many rounds,"""
ROUNDS: Final = 66
"""and never in more: rounds of steps that are long beside the field's own time, go on without end.
From there on, each step is solved by itself."""
NEWTON: Final = 8
"""So many of Newton's steps, at most; where a field jumps, they may go to and fro."""
NUDGE: Final = 1e-6
"""Of the domain, for the slopes that Newton's method takes."""
SETTLED: Final = 1e-7
"""The last round changes deviations by no more than this share of the largest; those of a step map
not at all, which takes no more rounds than there are steps."""
ROUNDING: Final = 1e-13
"""Of the largest state; what rounds of late inputs that have not changed yet leave."""


@final
@dataclass(frozen=True, slots=True)
class Lane:
    """One copy: a fault of one size, signed."""

    planned: Planned
    size: float


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Robots:
    """The faulty robots: gain and offset (L, n); late (L_d, K): the inputs of lanes `delayed`.

    columns (L_d,): where in the register those inputs stand. driven (D,): likewise.
    """

    flow: Flow
    gain: Array
    offset: Array
    delayed: Integers
    columns: Integers
    late: Array
    driven: Integers

    def moved(self, states: Array, controls: Array, part: slice) -> Array:
        """Their rates (S, L, D) (of a step map: their steps) at states (S, L, n), in S steps."""
        n = states.shape[-1]
        every = np.empty((*states.shape[:2], n + controls.shape[-1]))
        every[..., :n] = states
        every[..., n:] = controls[:, None]
        every[:, self.delayed, self.columns] = self.late[:, part].T
        plain = _motion(self.flow, every[..., :n], every[..., n:])
        faulty: Array = plain * (1.0 + self.gain) + self.offset
        return faulty[..., self.driven]


def integrated(study: Study, knots: Knots, lanes: tuple[Lane, ...]) -> tuple[Array, Integers]:
    """Deviations (K, L, D), and where lanes began anew: (c, 2), lane and knot."""
    robots = _robots(study, knots, lanes)
    path = np.zeros((len(knots.times), len(lanes), len(robots.driven)))
    cuts = [np.empty((0, 2), dtype=np.int64)]
    real = _real_motion(robots, knots)
    switches = switch_knots(robots.flow, knots.grid)
    ends = np.union1d(np.append(np.flatnonzero(knots.begins), len(knots.times)), switches)
    k, most, is_stiff = 0, SHORTEST, False
    while k < len(knots.times) - 1:
        if knots.begins[k + 1]:
            k += 1
            continue
        end = int(ends[np.searchsorted(ends, k, side="right")])
        last = min(k + most, end if end in switches else end - 1)
        rounds = ROUNDS
        if is_stiff:
            last = k + 1
            path[last] = _step(robots, knots, real, path[k], k)
        else:
            part = slice(k, last)
            path[k : last + 1], rounds, is_settled = _block(robots, knots, real, path[k], part)
            if not is_settled:
                is_stiff, most = most == SHORTEST, max(most // 2, SHORTEST)
                continue
        if last in switches:
            path[last] = _jumped(robots, knots, path[last], last)
        lost = _is_lost(study, knots.states[k + 1 : last + 1], path[k + 1 : last + 1])
        if np.any(lost):
            # What follows in this block is integrated once more, from where a robot begins anew.
            last = k + 1 + int(np.argmax(np.any(lost, axis=1)))
            anew = np.flatnonzero(lost[last - k - 1])
            path[last, anew] = 0.0
            cuts.append(np.column_stack([anew, np.full(len(anew), last)]))
        k = last
        most = min(2 * most, LONGEST) if rounds <= EASY else max(most // 2, SHORTEST)
    return path, np.concatenate(cuts)


def _block(
    robots: _Robots, knots: Knots, real: Array, start: Array, part: slice
) -> tuple[Array, int, bool]:
    """The deviations (S + 1, L, D) over S steps, from `start` (L, D); how many rounds; settled?

    The implicit midpoint rule (of a step map, its steps), for all steps at once: each round puts
    in what the one before it gave (waveform relaxation; it ends, as Picard's iteration does).
    """
    steps = 1.0 if knots.is_map else np.diff(knots.times[part.start : part.stop + 1])[:, None, None]
    places = (knots.states if knots.is_map else knots.middle)[part]
    controls, plain = knots.controls[part], real[part][:, None]
    path = np.tile(start, (len(places) + 1, 1, 1))
    settled = 0.0 if knots.is_map else SETTLED
    least = 0.0 if knots.is_map else ROUNDING * np.max(np.abs(places), initial=0.0)
    rounds, is_settled = 0, False
    while rounds < ROUNDS and not is_settled:
        rounds += 1
        at = path[:-1] if knots.is_map else (path[:-1] + path[1:]) / 2.0
        moved = robots.moved(_displaced(robots, places, at), controls, part)
        found = np.concatenate([start[None], start + np.cumsum(steps * (moved - plain), axis=0)])
        change = np.max(np.abs(found - path), initial=0.0)
        path = found
        is_settled = not change > max(settled * np.max(np.abs(found), initial=0.0), least)
    return path, rounds, is_settled


def _step(robots: _Robots, knots: Knots, real: Array, start: Array, k: int) -> Array:
    """The deviations (L, D) one step on, by the implicit midpoint rule, solved by Newton's method.

    The slopes are those where the step begins.
    """
    part = slice(k, k + 1)
    length = knots.times[k + 1] - knots.times[k]
    states = robots.flow.program.states
    nudges = NUDGE * np.array([states[i].high - states[i].low for i in robots.driven])

    def rates_at(deviation: Array) -> Array:
        at = _displaced(robots, knots.middle[part], deviation[None])
        found: Array = robots.moved(at, knots.controls[part], part)[0]
        return found

    before = rates_at(start)
    moved = [rates_at(start + nudge) - before for nudge in np.diag(nudges)]
    slopes = np.stack(moved, axis=-1) / nudges
    inverse = np.linalg.inv(np.eye(len(nudges)) - 0.5 * length * slopes)
    after = start
    for _ in range(NEWTON):
        miss = after - start - length * (rates_at((start + after) / 2.0) - real[k])
        change = np.einsum("lij,lj->li", inverse, miss)
        after = after - change
        if not np.max(np.abs(change), initial=0.0) > SETTLED * np.max(np.abs(after), initial=0.0):
            break
    return np.asarray(after)


def _is_lost(study: Study, states: Array, deviation: Array) -> Booleans:
    """Which lanes (S, L) are far from where the robot was (S, n), and out of the domain."""
    lost = ~np.all(np.isfinite(deviation), axis=-1)
    for j, state in enumerate(study.plan.needs.driven):
        if state.kind is Kind.CONTINUOUS:
            there = states[:, study.plan.needs.columns[j], None] + deviation[..., j]
            is_out = (there < state.low) | (there > state.high)
            lost |= is_out & (np.abs(deviation[..., j]) > FAR * (state.high - state.low))
    return np.asarray(lost)


def _robots(study: Study, knots: Knots, lanes: tuple[Lane, ...]) -> _Robots:
    columns = np.array(study.plan.needs.columns)
    gain, offset = np.zeros((2, len(lanes), study.plan.model.states))
    late: dict[int, tuple[int, Array]] = {}
    for i, lane in enumerate(lanes):
        target = lane.planned.target
        match lane.planned.fault:
            case Fault.GAIN:
                gain[i, columns[target]] = lane.size
            case Fault.OFFSET:
                offset[i, columns[target]] = lane.size
            case Fault.DELAY:
                given = study.plan.needs.inputs[target]
                late[i] = given.column, _late(given, knots, lane.size)
            case Fault.SENSOR:
                raise AssertionError("a fault of a sensor does not move the robot")
    return _Robots(
        flow=study.plan.model.flow,
        gain=gain,
        offset=offset,
        delayed=np.array(list(late), dtype=np.int64),
        columns=np.array([column for column, _ in late.values()], dtype=np.int64),
        late=np.array([values for _, values in late.values()]).reshape(len(late), len(knots.times)),
        driven=columns,
    )


def _late(given: Input, knots: Knots, seconds: float) -> Array:
    return mean_input(given, knots.times, seconds, is_map=knots.is_map)


def _motion(flow: Flow, states: Array, controls: Array) -> Array:
    """Rates (..., n), of a step map steps, of states that are brought back into the domain."""
    n = states.shape[-1]
    inside = np.clip(states, flow.domain[0, :n], flow.domain[1, :n])
    p = controls.shape[-1]
    allowed = np.clip(controls, flow.domain[0, n : n + p], flow.domain[1, n : n + p])
    if flow.is_map:
        following: Array = next_states(flow, inside, allowed)
        return following - inside
    return rates(flow, inside, allowed)


def _real_motion(robots: _Robots, knots: Knots) -> Array:
    """What the spec says where the robot was (K, D): halfway to the next knot; of a map, at it."""
    places = knots.states if knots.is_map else knots.middle
    return _motion(robots.flow, places, knots.controls)[:, robots.driven]


def _jumped(robots: _Robots, knots: Knots, deviation: Array, k: int) -> Array:
    """The deviation (L, D) after the switch at knot k: what is reset has none any more."""
    states = _displaced(robots, knots.states[k : k + 1], deviation[None])[0]
    both = np.concatenate([knots.states[k : k + 1], states])
    after = jumped(robots.flow, knots.grid, both, np.full(len(both), k))
    return np.asarray((after[1:] - after[:1])[:, robots.driven])


def _displaced(robots: _Robots, places: Array, moved: Array) -> Array:
    """States (S, L, n): those at `places` (S, n), the predicted ones moved by (S, L, D)."""
    states = np.repeat(places[:, None], moved.shape[1], axis=1)
    states[..., robots.driven] += moved
    return states
