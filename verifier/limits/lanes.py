"""How far robots with planted faults would have been from where the robot was.

All copies at once: L lanes, K knots, n states, p controls, D predicted states.
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

    def moved(self, states: Array, controls: Array, k: int) -> Array:
        """Their rates (L, D) (of a step map: their steps) at states (L, n), in step k."""
        states = np.array(states)
        controls = np.tile(controls, (len(states), 1))
        n = states.shape[1]
        for array, first in ((states, 0), (controls, n)):
            here = (self.columns >= first) & (self.columns < first + array.shape[1])
            array[self.delayed[here], self.columns[here] - first] = self.late[here, k]
        plain = _motion(self.flow, states, controls)
        faulty: Array = plain * (1.0 + self.gain) + self.offset
        return faulty[:, self.driven]


def integrated(study: Study, knots: Knots, lanes: tuple[Lane, ...]) -> tuple[Array, Integers]:
    """Deviations (K, L, D), and where lanes began anew: (c, 2), lane and knot."""
    robots = _robots(study, knots, lanes)
    path = np.zeros((len(knots.times), len(lanes), len(robots.driven)))
    cuts = [np.empty((0, 2), dtype=np.int64)]
    real = _real_motion(robots, knots)
    switches = set(switch_knots(robots.flow, knots.grid).tolist())
    for k in range(len(knots.times) - 1):
        if knots.begins[k + 1]:
            continue
        path[k + 1] = _stepped(robots, knots, real, path[k], k)
        if k + 1 in switches:
            path[k + 1] = _jumped(robots, knots, path[k + 1], k + 1)
        lost = np.flatnonzero(_is_lost(study, knots.states[k + 1], path[k + 1]))
        if len(lost):
            path[k + 1, lost] = 0.0
            cuts.append(np.column_stack([lost, np.full(len(lost), k + 1)]))
    return path, np.concatenate(cuts)


def _is_lost(study: Study, states: Array, deviation: Array) -> Booleans:
    """Which lanes (L,) are far from where the robot was, and out of the domain."""
    lost = ~np.all(np.isfinite(deviation), axis=-1)
    for j, state in enumerate(study.plan.needs.driven):
        if state.kind is Kind.CONTINUOUS:
            there = states[study.plan.needs.columns[j]] + deviation[:, j]
            is_out = (there < state.low) | (there > state.high)
            lost |= is_out & (np.abs(deviation[:, j]) > FAR * (state.high - state.low))
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
    """What the spec says where the robot was: (2, K, D), at the knots and halfway to the next."""
    at = [_motion(robots.flow, states, knots.controls) for states in (knots.states, knots.middle)]
    return np.asarray(np.stack(at)[..., robots.driven])


def _stepped(robots: _Robots, knots: Knots, real: Array, deviation: Array, k: int) -> Array:
    """The deviation (L, D) one step later, by the midpoint rule (of a step map, by its step)."""

    def change(place: Array, moved: Array, half: int) -> Array:
        there = robots.moved(_displaced(robots, place, moved), knots.controls[k], k)
        return np.asarray(there - real[half, k])

    first = change(knots.states[k], deviation, 0)
    if knots.is_map:
        return np.asarray(deviation + first)
    step = knots.times[k + 1] - knots.times[k]
    return np.asarray(deviation + step * change(knots.middle[k], deviation + step / 2.0 * first, 1))


def _jumped(robots: _Robots, knots: Knots, deviation: Array, k: int) -> Array:
    """The deviation (L, D) after the switch at knot k: what is reset has none any more."""
    states = _displaced(robots, knots.states[k], deviation)
    both = np.concatenate([knots.states[k : k + 1], states])
    after = jumped(robots.flow, knots.grid, both, np.full(len(both), k))
    return np.asarray((after[1:] - after[:1])[:, robots.driven])


def _displaced(robots: _Robots, place: Array, moved: Array) -> Array:
    """States (L, n): those at `place` (n,), the predicted ones moved by (L, D)."""
    states = np.tile(place, (len(moved), 1))
    states[:, robots.driven] += moved
    return states
