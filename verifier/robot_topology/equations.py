"""The normal equations of a multiple-shooting fit of a corrected field.

The errors at all samples of a window are linear in its start state and in the coefficients c, by
the variational equation S' = J S + dr/dc along the window's path. The starts are eliminated window
by window (Schur's complement), so each window brings a P x P matrix, whatever its length.

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
START: Final = 0.1
"""A start is within this share of the domain of where it is sought."""
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
    """Per window: information (W, P, P) and score (W, P), with the starts eliminated.

    The best start for a change dc of the coefficients is off by `move - response @ dc`: (W, D),
    (W, D, P). paths (W, S + 1, D).
    """

    information: Array
    score: Array
    move: Array
    response: Array
    paths: Array

    @property
    def is_finite(self) -> Booleans:
        """(W,) whether the path stayed in the domain."""
        return np.asarray(np.all(np.isfinite(self.paths), axis=(1, 2)))

    def part(self, good: Booleans) -> "Equations":
        """Some of the windows."""
        return Equations(
            self.information[good],
            self.score[good],
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
    basis = basis_on(_visited(study, measured, chosen, columns), turns, length)
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
    rows = residual.shape[1] * residual.shape[2]
    design = (rooted[..., None] * sensitive).reshape(len(start), rows, -1)
    right = (rooted * np.nan_to_num(residual)).reshape(len(start), rows, 1)
    crossed = np.swapaxes(design, 1, 2)
    return _eliminated(job, crossed @ design, (crossed @ right)[..., 0], paths)


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


def _eliminated(job: Job, whole: Array, right: Array, paths: Array) -> Equations:
    """The normal equations (W, D + P, ...) without the start states."""
    axes = len(job.widths)
    of_start = whole[:, :axes, :axes] + np.diag((START * job.widths) ** -2.0)
    mixed = whole[:, :axes, axes:]
    inverse: Array = np.linalg.inv(of_start).astype(np.float64)
    response = inverse @ mixed
    move = (inverse @ right[:, :axes, None])[..., 0]
    information = whole[:, axes:, axes:] - np.swapaxes(mixed, 1, 2) @ response
    score = right[:, axes:] - np.einsum("wdp,wd->wp", mixed, move)
    return Equations(information, score, move, response, paths)
