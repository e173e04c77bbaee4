"""Integration of many trajectories at once: fixed steps, adaptive steps, steps of a map.

Sizes: B trajectories, n states, p controls, T samples, S steps. Numbers of one trajectory depend
neither on the others nor on its place among them. Outside the domain a field says nothing, so a
trajectory ends where it leaves it; its later samples are NaN.
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Integers
from runtime.flow import Flow, registers
from runtime.gates import no_gates
from runtime.kernels.adapt import adapt
from runtime.kernels.events import Gates
from runtime.kernels.march import march
from runtime.rollout import Ending, Switches
from runtime.tape import read_only_integers, read_only_view

MOST_STEPS: Final = 1_000_000
ENDINGS: Final = (
    Ending.COMPLETED,
    Ending.LEFT_DOMAIN,
    Ending.DIVERGED,
    Ending.TOO_MANY_STEPS,
    Ending.CHATTERING,
)
"""By the kernels' codes."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Trajectories:
    """States (B, T, n) at the times asked for, and how each trajectory ended.

    endings: (B,) indices into `ENDINGS`. variables: (B,) the register entry that left its domain,
    or -1; sides: (B,) 1 where it left upwards, -1 downwards. ended_at: (B,). ended_in: (B, n),
    the state there: for `LEFT_DOMAIN` of a flow, the last one within the domain.
    switches: of modes.
    """

    states: Array
    endings: Integers
    variables: Integers
    sides: Integers
    ended_at: Array
    ended_in: Array
    switches: Switches

    def ending(self, trajectory: int) -> Ending:
        """How one trajectory ended."""
        return ENDINGS[int(self.endings[trajectory])]


def rk4(flow: Flow, x0: Array, times: Array, inputs: Array, columns: Integers) -> Array:
    """States (B, S + 1, n) by the classical Runge-Kutta method, one step between two times.

    See `fixed_steps`, which also says how each trajectory ended.
    """
    return fixed_steps(flow, x0, times, inputs, columns).states


def fixed_steps(
    flow: Flow, x0: Array, times: Array, inputs: Array, columns: Integers
) -> Trajectories:
    """Fixed steps from x0 (B, n): of Runge-Kutta (order 4), or of the map for a step map.

    times: (B, S + 1) or (S + 1,), in any direction; a step of length 0 does nothing (padding).
    inputs: (B, S, k), or with 1 in place of B or S: values of the register entries `columns` (k,)
    (controls, or states that are measured), held during each step. Other controls have their
    defaults. A state among the inputs is what the input says, at the beginning of the step.
    """
    times = np.atleast_2d(times)
    steps = times.shape[1] - 1
    assert inputs.ndim == 3, "inputs have the axes trajectory, step, column"
    assert inputs.shape[0] in {1, len(x0)}, "inputs for each trajectory or for all"
    assert inputs.shape[1] in {1, steps}, "inputs for each step or for all"
    assert times.shape[0] in {1, len(x0)}, "times for each trajectory or for all"
    p = len(flow.program.controls)
    n = len(flow.program.states)
    moving = np.flatnonzero(flow.moves & ~np.isin(np.arange(n), columns))
    start = registers(flow, x0, flow.defaults[n : n + p])
    states, ended = _empty(len(x0), steps + 1, n)
    march(
        flow.tape,
        flow.domain,
        read_only_integers(moving),
        read_only_view(start),
        read_only_view(times),
        read_only_view(inputs),
        read_only_integers(columns),
        int(flow.is_map),
        states,
        ended,
    )
    return _trajectories(states, ended, _switches(np.empty((0, 4 + 2 * n)), n))


def adaptive(  # as one writes an initial value problem, then tolerances
    flow: Flow,
    x0: Array,
    u: Array,
    times: Array,
    rtol: float,
    atol: float | Array,
    most_steps: int = MOST_STEPS,
) -> Trajectories:
    """Samples at `times` (T,) from x0 (B, n) with controls u (B, p) or (p,), error under control.

    Dormand and Prince's pair of orders 5 and 4, with dense output; the local error of each state
    stays below `atol + rtol * |x|`, where atol is a number or (n,). times begin at the start and
    run forwards or backwards. Forwards, modes switch where guards open, located on the dense
    output; backwards they stay, since what happened before a switch is not determined.
    """
    gates = flow.gates if times[-1] >= times[0] else no_gates()
    return adaptive_with(gates, flow, x0, u, times, rtol, atol, most_steps)


def adaptive_with(
    gates: Gates,
    flow: Flow,
    x0: Array,
    u: Array,
    times: Array,
    rtol: float,
    atol: float | Array,
    most_steps: int = MOST_STEPS,
) -> Trajectories:
    """`adaptive` with other gates than those of the flow.

    A trajectory that its gates end has the code `ARRIVED` of `runtime.kernels.blocks`.
    """
    assert not flow.is_map, "a step map has no rates"
    n = len(flow.program.states)
    start = registers(flow, x0, u)
    states, ended = _empty(len(x0), len(times), n)
    log = adapt(
        flow.tape,
        gates,
        flow.domain,
        read_only_integers(np.flatnonzero(flow.moves)),
        read_only_view(start),
        read_only_view(times),
        read_only_view(np.broadcast_to(np.asarray(atol, dtype=np.float64), (n,))),
        float(rtol),
        most_steps,
        states,
        ended,
    )
    return _trajectories(states, ended, _switches(log, n))


def _switches(log: Array, n: int) -> Switches:
    """The kernel's log in the order of trajectories; within each it has the order of time."""
    rows = log[np.argsort(log[:, 0], kind="stable")] if len(log) else log
    whole = rows[:, [0, 2, 3]].astype(np.int64)
    before, after = rows[:, 4 : 4 + n], rows[:, 4 + n :]
    return Switches(whole[:, 0], rows[:, 1], whole[:, 1], whole[:, 2], before, after)


def _empty(batch: int, samples: int, n: int) -> tuple[Array, Array]:
    return np.empty((batch, samples, n)), np.empty((batch, 4 + n))


def _trajectories(states: Array, ended: Array, switches: Switches) -> Trajectories:
    endings, variables, sides = ended[:, :3].astype(np.int64).T
    return Trajectories(states, endings, variables, sides, ended[:, 3], ended[:, 4:], switches)
