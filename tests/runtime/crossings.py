"""First crossings of a section, and first passages through a guard: what return maps are made of.

Sizes: B trajectories, n states. Both end a trajectory where its event is, located on the dense
output of the adaptive integrator to the spacing of doubles; times are those since the start.
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array
from runtime.code import Code
from runtime.flow import Flow
from runtime.gates import no_gates, packed_gates
from runtime.integrators import MOST_STEPS, Trajectories, adaptive_with
from runtime.kernels.blocks import ARRIVED
from runtime.kernels.events import Gates

RTOL: Final = 1e-10
ATOL: Final = 1e-13
"""In widths of each state's domain."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Crossings:
    """When trajectories came to their event, and where: times (B,), states (B, n).

    Both are NaN where a trajectory did not come there within the time, or left its domain first.
    """

    times: Array
    states: Array


@final
@dataclass(frozen=True, slots=True)
class Accuracy:
    """Tolerances, `atol` in widths of each state's domain, and how many steps may be tried."""

    rtol: float = RTOL
    atol: float = ATOL
    most_steps: int = MOST_STEPS


def first_crossing(
    flow: Flow,
    x0: Array,
    u: Array,
    section: Code,
    longest: float,
    *,
    rising: bool = True,
    after: float = 0.0,
    accuracy: Accuracy = Accuracy(),  # frozen
) -> Crossings:
    """Where trajectories from x0 (B, n) first cross `section`, within `longest` seconds.

    u: controls (B, p) or (p,). section: code over the register; it is crossed where its value
    turns from negative to zero or more along the way travelled, or the other way round where it is
    not `rising`. A trajectory that starts on the section, or beyond, has to come back before it;
    one that starts on it only up to rounding is helped by `after`: crossings up to then do not
    count. Where `longest` (and with it `after`) is negative, it runs backwards in time, and modes
    stay. Forwards, modes switch on the way; a section that coincides with a guard is crossed
    before the switch.

    Raises:
        ValueError: the section cannot be run.
    """
    assert abs(after) < abs(longest), "the longest time comes after the first"
    code = section if rising else Code(f"{section.text} neg")
    guards = flow.program.field.guards if flow.switches and longest > 0.0 else ()
    gates = packed_gates(flow.program, guards, (code,), 0)
    if after == 0.0:
        return _arrivals(_run(gates, flow, x0, u, longest, accuracy))
    before = flow.gates if longest > 0.0 else no_gates()
    begun = _run(before, flow, x0, u, after, accuracy)
    found = _arrivals(_run(gates, flow, begun.states[:, -1], u, longest - after, accuracy))
    return Crossings(found.times + after, found.states)


def first_passage(
    flow: Flow,
    x0: Array,
    u: Array,
    guard: int,
    longest: float,
    accuracy: Accuracy = Accuracy(),  # frozen
) -> Crossings:
    """Where trajectories first take the guard with this index, within `longest` seconds.

    The states are those after its jump, in the mode that it leads to.
    """
    assert longest > 0.0, "modes switch forwards in time"
    gates = packed_gates(flow.program, flow.program.field.guards, (), guard)
    return _arrivals(_run(gates, flow, x0, u, longest, accuracy))


def _run(
    gates: Gates, flow: Flow, x0: Array, u: Array, longest: float, accuracy: Accuracy
) -> Trajectories:
    widths = np.array([state.high - state.low for state in flow.program.states])
    # A discrete state of one value has no width, and no error either.
    atol = accuracy.atol * np.where(widths > 0.0, widths, 1.0)
    times = np.array([0.0, longest])
    return adaptive_with(gates, flow, x0, u, times, accuracy.rtol, atol, accuracy.most_steps)


def _arrivals(ran: Trajectories) -> Crossings:
    arrived = ran.endings == int(ARRIVED)
    return Crossings(
        np.where(arrived, ran.ended_at, np.nan),
        np.where(arrived[:, np.newaxis], ran.ended_in, np.nan),
    )
