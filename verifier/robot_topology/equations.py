"""The normal equations of a multiple-shooting fit of a corrected field.

The errors at all samples of a window are linear in its start state and in the coefficients c, by
the variational equation S' = J S + dr/dc along the window's path. The starts are eliminated window
by window: what they can explain is projected out of the errors and of their derivatives by c.

Letters: W windows, S steps, n states, D axes, K functions, P coefficients.
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Booleans, Integers
from verifier.fidelity.shooting.samples import turned
from verifier.fidelity.shooting.study import Study
from verifier.robot_topology.basis import basis_on, functions
from verifier.robot_topology.corrected import Corrected, corrected_slopes, spec_rates, step

FLOOR: Final = 1e-6
"""Noise is at least this share of the domain."""
LEAST: Final = 0.01
"""Of a domain: the visited region is taken to be at least so wide."""
START: Final = 0.1
"""A start is within this share of the domain of where it is sought."""
LARGEST: Final = 1e12
"""An error that changes by so many deviations with a coefficient is none to build on."""
SHAPED_BY: Final = 1000
"""Samples that the visited region is told from."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Job:
    """What is fitted: times (W, S + 1), controls (W, S + 1, p), sensed states (W, S + 1, k).

    where (k,): columns of the sensed states. measured (W, S + 1, D): NaN where there is no sample.
    weight (D,): 1 / noise^2. widths (D,): of the domains.
    """

    field: Corrected
    times: Array
    controls: Array
    sensed: Array
    where: Integers
    measured: Array
    weight: Array
    widths: Array

    def part(self, good: Booleans) -> "Job":
        """Some of the windows."""
        times, measured = self.times[good], self.measured[good]
        controls, sensed = self.controls[good], self.sensed[good]
        return Job(
            self.field, times, controls, sensed, self.where, measured, self.weight, self.widths
        )


@final
@dataclass(frozen=True, eq=False, slots=True)
class Equations:
    """The errors as linear in the coefficients, the starts eliminated: R rows a window.

    residual (W, R) and design (W, R, P), in deviations of the noise. The best start for a change
    dc of the coefficients is off by `move - response @ dc`: (W, D), (W, D, P). paths (W, S + 1, D).
    """

    residual: Array
    design: Array
    move: Array
    response: Array
    paths: Array

    @property
    def is_finite(self) -> Booleans:
        """(W,) whether the path stayed in the domain, and nothing grew beyond bounds."""
        inside = np.all(np.isfinite(self.paths), axis=(1, 2))
        return np.asarray(inside & np.all(np.abs(self.design) < LARGEST, axis=(1, 2)))

    def part(self, good: Booleans) -> "Equations":
        """Some of the windows."""
        return Equations(
            self.residual[good],
            self.design[good],
            self.move[good],
            self.response[good],
            self.paths[good],
        )


def job_of(study: Study, chosen: Integers, length: float) -> Job | None:
    """The job of the windows `chosen`; None where the kernel's `length` is too short for it."""
    plan = study.plan
    grid, flow = plan.model.grid, plan.model.flow
    first, last = plan.windows.first[chosen], plan.windows.last[chosen]
    knots = first[:, None] + np.arange(int(np.max(last - first)) + 1)
    past = knots > last[:, None]
    knots = np.minimum(knots, last[:, None])
    columns = np.array([each.column for each in plan.samples])
    widths = np.array([each.state.high - each.state.low for each in plan.samples])
    turns = np.array([each.turn for each in plan.samples])
    measured = _measured(study, knots, past)
    is_state = grid.columns < plan.model.states
    basis = basis_on(_visited(study, measured, chosen, columns), turns, length, LEAST * widths)
    if basis is None:
        return None
    field = Corrected(
        flow=flow,
        basis=basis,
        columns=columns,
        lows=np.array([each.state.low for each in plan.samples]),
        turns=turns,
    )
    return Job(
        field=field,
        times=grid.times[knots],
        controls=_controls(study, knots, is_state),
        sensed=grid.inputs[knots][..., is_state],
        where=grid.columns[is_state],
        measured=measured,
        weight=np.maximum([noise.sigma for noise in study.noise], FLOOR * widths) ** -2.0,
        widths=widths,
    )


def equations(job: Job, start: Array, coefficients: Array) -> Equations:
    """The normal equations around the paths from `start` (W, n) with `coefficients` (P,)."""
    field = job.field
    states = _paths(job, start, coefficients)
    paths = states[..., field.columns]
    residual = np.stack(
        [
            turned(job.measured[..., j] - paths[..., j], float(turn))
            for j, turn in enumerate(field.turns)
        ],
        axis=-1,
    )
    rooted = np.sqrt(np.where(np.isfinite(residual), job.weight, 0.0))
    sensitive = _sensitivities(job, np.nan_to_num(states), coefficients)
    count, rows = len(start), residual.shape[1] * residual.shape[2]
    design = (rooted[..., None] * sensitive).reshape(count, rows, -1)
    right = (rooted * np.nan_to_num(residual)).reshape(count, rows)
    return _eliminated(job, design, right, paths)


def _measured(study: Study, knots: Integers, past: Booleans) -> Array:
    found = np.full((*knots.shape, len(study.plan.samples)), np.nan)
    for j, each in enumerate(study.plan.samples):
        known = np.full(len(study.plan.model.grid.times), np.nan)
        known[each.knots] = each.values
        found[..., j] = np.where(past, np.nan, known[knots])
    return found


def _visited(study: Study, measured: Array, chosen: Integers, columns: Integers) -> Array:
    """Places (N, D) that stand for the visited region."""
    every = measured.reshape(-1, measured.shape[-1])
    known = every[np.all(np.isfinite(every), axis=1)]
    if len(known) < len(chosen):
        return study.shots.start[chosen][:, columns]
    return np.asarray(known[:: max(1, len(known) // SHAPED_BY)])


def _controls(study: Study, knots: Integers, is_state: Booleans) -> Array:
    """Controls (W, S + 1, p) as held from each knot on."""
    grid, flow = study.plan.model.grid, study.plan.model.flow
    count, width = study.plan.model.states, len(flow.program.controls)
    assumed = flow.defaults[count : count + width]
    found = np.array(np.broadcast_to(assumed, (*knots.shape, width)))
    found[..., grid.columns[~is_state] - count] = grid.inputs[knots][..., ~is_state]
    return found


def _paths(job: Job, start: Array, coefficients: Array) -> Array:
    """The states (W, S + 1, n) from `start`."""
    x = np.array(start)
    found = []
    for s in range(job.times.shape[1]):
        x = np.array(x)
        x[:, job.where] = job.sensed[:, s]
        found.append(x)
        if s + 1 < job.times.shape[1]:
            seconds = (job.times[:, s + 1] - job.times[:, s])[:, None]
            x = step(job.field, x, job.controls[:, s], seconds, coefficients)
    return np.stack(found, axis=1)


def _sensitivities(job: Job, states: Array, coefficients: Array) -> Array:
    """D path / d (start, c): (W, S + 1, D, D + P), by the trapezoidal rule along the path."""
    field = job.field
    axes, each = len(field.columns), field.basis.count + 1
    slope = np.nan_to_num(corrected_slopes(field, states, job.controls, coefficients))
    own = np.nan_to_num(spec_rates(field, states, job.controls)[..., field.columns])
    phi = functions(field.basis, states[..., field.columns])
    count, knots = phi.shape[:2]
    driven = np.zeros((count, knots, axes, axes * each))
    for d in range(axes):
        driven[:, :, d, d * each : (d + 1) * each - 1] = phi
        driven[:, :, d, (d + 1) * each - 1] = own[..., d]
    found = np.zeros((count, knots, axes, axes + axes * each))
    found[:, 0, :, :axes] = np.eye(axes)
    for s in range(knots - 1):
        seconds = (job.times[:, s + 1] - job.times[:, s])[:, None, None]
        middle = 0.5 * seconds * (slope[:, s] + slope[:, s + 1])
        carried = np.eye(axes) + middle + 0.5 * middle @ middle
        found[:, s + 1] = carried @ found[:, s]
        found[:, s + 1, :, axes:] += 0.5 * seconds * (carried @ driven[:, s] + driven[:, s + 1])
    return found


def _eliminated(job: Job, design: Array, right: Array, paths: Array) -> Equations:
    """Rows (W, R, D + P) without what the start states can explain."""
    axes = len(job.widths)
    of_start, rest = design[..., :axes], design[..., axes:]
    # What is known of the start beforehand stands as D further rows.
    known = np.broadcast_to(np.diag(1.0 / (START * job.widths)), (len(design), axes, axes))
    of_start = np.concatenate([of_start, known], axis=1)
    nothing = np.zeros((len(design), axes, rest.shape[-1]))
    rest = np.concatenate([rest, nothing], axis=1)
    right = np.concatenate([right, np.zeros((len(design), axes))], axis=1)
    normal = np.einsum("wri,wrj->wij", of_start, of_start)
    inverse: Array = np.linalg.inv(normal).astype(np.float64)
    response = np.einsum("wij,wrj,wrp->wip", inverse, of_start, rest, optimize=True)
    move = np.einsum("wij,wrj,wr->wi", inverse, of_start, right, optimize=True)
    for i in range(axes):
        rest = rest - of_start[..., i, None] * response[:, None, i]
    right = right - np.einsum("wri,wi->wr", of_start, move)
    return Equations(right, rest, move, response, paths)
