"""The spec's field, refitted to a trace by multiple shooting.

The rate of each axis i becomes f_i (1 + a_i) + g_i(x): a gain and a smooth correction (see
`basis`), on windows of one horizon whose start states are free. Gauss-Newton: the errors at all
samples of a window are linear in its start and in the coefficients c, by the variational equation
S' = J S + dr/dc along the path; the starts are eliminated window by window (the normal equations'
Schur complement), so windows stay cheap. The size s of the corrections is the one with the largest
marginal likelihood (MacKay 1992), but never less than what the tolerance would let pass over one
horizon: a field is not called known because it is called close.

Errors of neighbouring samples and windows are related (process noise, coloured noise). So the
information is divided by the factor by which the scores of blocks of windows spread more than
independent ones would (a design effect). Resampling the blocks themselves has no rank here: there
are fewer blocks than coefficients.

Letters: W windows, S steps, n states, D axes, K functions, P = D (K + 1) coefficients.
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Integers
from runtime.flow import jacobian, rates
from verifier.fidelity.shooting.plan import Plan
from verifier.fidelity.shooting.samples import turned
from verifier.fidelity.shooting.study import Study
from verifier.robot_topology.basis import Basis, basis_on, functions, slopes

MOST_WINDOWS: Final = 300
MOST_STEPS: Final = 30_000
"""Windows times steps: bounds time and memory."""
FEWEST_WINDOWS: Final = 8
ROUNDS: Final = 3
GAIN: Final = 0.2
"""The prior deviation of a rate's gain."""
SIZES: Final = 2.0 ** np.arange(0, 9)
"""Of the corrections, in tolerances per horizon."""
BLOCK: Final = 2
"""Windows in a block: two horizons."""
FLOOR: Final = 1e-6
"""Noise is at least this share of the domain."""
START: Final = 0.1
"""A start is within this share of the domain of where the spec's fit has it."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Refit:
    """The refitted field: coefficients (P,), axis by axis, functions first, then the gain.

    root (P, P): coefficients + root @ z, z standard normal, are draws of what they may be.
    points (W, S + 1, D): the paths of the windows.
    """

    plan: Plan
    basis: Basis
    columns: Integers
    coefficients: Array
    root: Array
    points: Array

    def draws(self, count: int, rng: np.random.Generator) -> Array:
        """Coefficients (count + 1, P): the estimate, then draws."""
        noise = rng.standard_normal((count, len(self.coefficients)))
        return np.concatenate(
            [self.coefficients[None], self.coefficients + noise @ self.root.T]
        )


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Job:
    """What is fitted: knots (W, S + 1), measured (W, S + 1, D) with NaN, times, inputs.

    weight (D,): 1 / noise^2. widths (D,): of the domains.
    """

    plan: Plan
    basis: Basis
    columns: Integers
    knots: Integers
    measured: Array
    weight: Array
    widths: Array
    turns: Array


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Normal:
    """Normal equations per window: information (W, P, P) and score (W, P), starts eliminated."""

    information: Array
    score: Array
    step: Array
    response: Array
    paths: Array


def refit(study: Study, tolerance: Array, turns: Array) -> Refit | None:
    """The refitted field, None where there are too few windows. tolerance, turns: (D,)."""
    plan = study.plan
    if plan.model.flow.is_map or plan.model.flow.switches:
        return None
    chosen = _chosen(plan)
    if len(chosen) < FEWEST_WINDOWS:
        return None
    job = _job(study, chosen, turns)
    start = np.array(study.shots.start[chosen])
    count = len(job.columns) * (job.basis.count + 1)
    found = np.zeros(count)
    size = tolerance / plan.windows.horizon
    root, paths = np.eye(count), np.empty(0)
    for _ in range(ROUNDS):
        normal = _normal(job, start, found)
        good = np.all(np.isfinite(normal.paths), axis=(1, 2))
        if good.sum() < FEWEST_WINDOWS:
            return None
        normal = _only(normal, good)
        job, start = _kept(job, good), start[good]
        step, root = _solved(normal, found, size, job)
        found = found + step
        columns = list(job.columns)
        start[:, columns] += normal.step - normal.response @ step
        paths = normal.paths
    return Refit(plan, job.basis, job.columns, found, root, paths)


def field(refitted: Refit, x: Array, u: Array, coefficients: Array) -> Array:
    """Rates (..., n) at states x (..., n) and controls u; coefficients (..., P)."""
    found = rates(refitted.plan.model.flow, _wrapped(refitted.plan, x), u)
    return _corrected(refitted.basis, refitted.columns, x, found, coefficients)


def field_slopes(refitted: Refit, x: Array, u: Array, coefficients: Array) -> Array:
    """Derivatives (..., D, D) of the rates of the axes by the axes."""
    return _slopes(refitted.plan, refitted.basis, refitted.columns, x, u, coefficients)


def _chosen(plan: Plan) -> Integers:
    """Windows that do not overlap, evenly thinned to a bounded number; all if there are few."""
    times, horizon = plan.windows.times, plan.windows.horizon
    kept: list[int] = []
    last = -np.inf
    for i, time in enumerate(times):
        if time >= last + horizon * (1.0 - 1e-6):
            kept.append(i)
            last = time
    if len(kept) < FEWEST_WINDOWS:
        kept = list(range(len(times)))
    steps = int(np.max(plan.windows.last - plan.windows.first, initial=1))
    most = max(FEWEST_WINDOWS, min(MOST_WINDOWS, MOST_STEPS // steps))
    stride = -(-len(kept) // most)
    return np.array(kept[::stride], dtype=np.int64)


def _job(study: Study, chosen: Integers, turns: Array) -> _Job:
    plan = study.plan
    first, last = plan.windows.first[chosen], plan.windows.last[chosen]
    steps = np.arange(int(np.max(last - first)) + 1)
    knots = first[:, None] + steps
    past = knots > last[:, None]
    knots = np.minimum(knots, last[:, None])
    measured = np.full((*knots.shape, len(plan.samples)), np.nan)
    for j, each in enumerate(plan.samples):
        known = np.full(len(plan.model.grid.times), np.nan)
        known[each.knots] = each.values
        measured[..., j] = np.where(past, np.nan, known[knots])
    columns = np.array([each.column for each in plan.samples])
    widths = np.array([each.state.high - each.state.low for each in plan.samples])
    sigma = np.maximum([noise.sigma for noise in study.noise], FLOOR * widths)
    visited = study.shots.start[chosen][:, columns]
    everywhere = measured.reshape(-1, len(columns))
    known = everywhere[np.all(np.isfinite(everywhere), axis=1)]
    points = known[:: max(1, len(known) // 2000)] if len(known) else visited
    return _Job(
        plan, basis_on(points, turns), columns, knots, measured, sigma**-2.0, widths, turns
    )


def _kept(job: _Job, good: Array) -> _Job:
    return _Job(
        job.plan,
        job.basis,
        job.columns,
        job.knots[good],
        job.measured[good],
        job.weight,
        job.widths,
        job.turns,
    )


def _only(normal: _Normal, good: Array) -> _Normal:
    return _Normal(
        normal.information[good],
        normal.score[good],
        normal.step[good],
        normal.response[good],
        normal.paths[good],
    )


def _inputs(plan: Plan, knots: Integers) -> tuple[Array, Array, Integers]:
    """Controls (..., p) at the knots, the sensed states' values (..., k), and their columns."""
    grid, flow = plan.model.grid, plan.model.flow
    count = plan.model.states
    controls = np.broadcast_to(
        flow.defaults[count : count + len(flow.program.controls)],
        (*knots.shape, len(flow.program.controls)),
    ).copy()
    is_state = grid.columns < count
    controls[..., grid.columns[~is_state] - count] = grid.inputs[knots][..., ~is_state]
    return controls, grid.inputs[knots][..., is_state], grid.columns[is_state]


def _wrapped(plan: Plan, x: Array) -> Array:
    """States with angles inside their domains."""
    moved = np.array(x)
    for each in plan.samples:
        if each.turn > 0.0:
            low = each.state.low
            moved[..., each.column] = low + np.mod(x[..., each.column] - low, each.turn)
    return moved


def _split(coefficients: Array, axes: int) -> tuple[Array, Array]:
    """Coefficients (..., P) as those of functions (..., D, K) and gains (..., D)."""
    table = coefficients.reshape(*coefficients.shape[:-1], axes, -1)
    return table[..., :-1], table[..., -1]


def _corrected(
    basis: Basis, columns: Integers, x: Array, found: Array, coefficients: Array
) -> Array:
    weights, gains = _split(coefficients, len(columns))
    phi = functions(basis, x[..., columns])
    moved = np.array(found)
    moved[..., columns] = found[..., columns] * (1.0 + gains) + np.einsum(
        "...k,...dk->...d", phi, weights
    )
    return moved


def _slopes(
    plan: Plan, basis: Basis, columns: Integers, x: Array, u: Array, coefficients: Array
) -> Array:
    weights, gains = _split(coefficients, len(columns))
    own = jacobian(plan.model.flow, _wrapped(plan, x), u)[..., columns, :][..., columns]
    bent = np.einsum("...kj,...dk->...dj", slopes(basis, x[..., columns]), weights)
    return np.asarray(own * (1.0 + gains)[..., None] + bent)


def _paths(job: _Job, start: Array, coefficients: Array) -> Array:
    """The states (W, S + 1, n) from `start`, by the classical Runge-Kutta method."""
    plan = job.plan
    times = plan.model.grid.times[job.knots]
    controls, sensed, where = _inputs(plan, job.knots)
    x = np.array(start)
    found = [x]
    flow = plan.model.flow
    for s in range(job.knots.shape[1] - 1):
        x = np.array(x)
        x[:, where] = sensed[:, s]
        u, step = controls[:, s], (times[:, s + 1] - times[:, s])[:, None]

        def rate(at: Array, u: Array = u) -> Array:
            own = rates(flow, _wrapped(plan, at), u)
            return _corrected(job.basis, job.columns, at, own, coefficients)

        k1 = rate(x)
        k2 = rate(x + 0.5 * step * k1)
        k3 = rate(x + 0.5 * step * k2)
        k4 = rate(x + step * k3)
        x = x + step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        found.append(x)
    return np.stack(found, axis=1)


def _normal(job: _Job, start: Array, coefficients: Array) -> _Normal:
    """The normal equations around the paths from `start` with `coefficients`."""
    plan, columns = job.plan, job.columns
    axes = len(columns)
    states = _paths(job, start, coefficients)
    paths = states[..., columns]
    safe = np.nan_to_num(states)
    controls, _, _ = _inputs(plan, job.knots)
    jacobians = np.nan_to_num(
        _slopes(plan, job.basis, columns, safe, controls, coefficients)
    )
    own = np.nan_to_num(rates(plan.model.flow, _wrapped(plan, safe), controls)[..., columns])
    phi = functions(job.basis, safe[..., columns])
    residual = np.stack(
        [turned(job.measured[..., j] - paths[..., j], float(job.turns[j])) for j in range(axes)],
        axis=-1,
    )
    weight = np.where(np.isfinite(residual), job.weight, 0.0)
    residual = np.nan_to_num(residual)
    sensed = _sensitivities(job, jacobians, own, phi)
    rooted = np.sqrt(weight)
    count, steps = residual.shape[:2]
    design = (rooted[..., None] * sensed).reshape(count, steps * axes, -1)
    right = (rooted * residual).reshape(count, steps * axes, 1)
    crossed = np.swapaxes(design, 1, 2)
    return _eliminated(job, crossed @ design, (crossed @ right)[..., 0], paths)


def _eliminated(job: _Job, whole: Array, right: Array, paths: Array) -> _Normal:
    """The normal equations (W, D + P, ...) without the start states."""
    axes = len(job.columns)
    of_start = whole[:, :axes, :axes] + np.diag((START * job.widths) ** -2.0)
    mixed = whole[:, :axes, axes:]
    response = np.linalg.solve(of_start, mixed)
    step = np.linalg.solve(of_start, right[:, :axes, None])[..., 0]
    information = whole[:, axes:, axes:] - np.swapaxes(mixed, 1, 2) @ response
    score = right[:, axes:] - np.einsum("wdp,wd->wp", mixed, step)
    return _Normal(information, score, step, response, paths)


def _sensitivities(job: _Job, jacobians: Array, own: Array, phi: Array) -> Array:
    """d path / d (start, c): (W, S + 1, D, D + P), by the trapezoidal rule along the path."""
    count, knots, axes = own.shape
    each = phi.shape[-1] + 1
    driven = np.zeros((count, knots, axes, axes * each))
    for d in range(axes):
        driven[:, :, d, d * each : (d + 1) * each - 1] = phi
        driven[:, :, d, (d + 1) * each - 1] = own[..., d]
    times = job.plan.model.grid.times[job.knots]
    found = np.zeros((count, knots, axes, axes + axes * each))
    found[:, 0, :, :axes] = np.eye(axes)
    for s in range(knots - 1):
        step = (times[:, s + 1] - times[:, s])[:, None, None]
        middle = 0.5 * step * (jacobians[:, s] + jacobians[:, s + 1])
        carried = np.eye(axes) + middle + 0.5 * middle @ middle
        found[:, s + 1] = carried @ found[:, s]
        pushed = carried @ driven[:, s] + driven[:, s + 1]
        found[:, s + 1, :, axes:] += 0.5 * step * pushed
    return found


def _solved(normal: _Normal, found: Array, size: Array, job: _Job) -> tuple[Array, Array]:
    """The step of the coefficients, and a root of their covariance."""
    information = np.sum(normal.information, axis=0)
    right = np.sum(normal.score, axis=0) + information @ found
    effect = 1.0
    for _ in range(2):
        scale = max(
            SIZES, key=lambda s: _evidence(information / effect, right / effect, _prior(size * s, job))
        )
        prior = _prior(size * scale, job)
        precision = information / effect + np.diag(1.0 / prior)
        value = np.linalg.solve(precision, right / effect)
        effect = max(1.0, _design_effect(normal, value - found, precision * effect))
    precision = information / effect + np.diag(1.0 / prior)
    value = np.linalg.solve(precision, right / effect)
    root = np.linalg.cholesky(np.linalg.inv(precision))
    return value - found, root


def _prior(size: Array, job: _Job) -> Array:
    """Prior variances (P,)."""
    each = job.basis.count + 1
    variances = np.repeat(size**2, each)
    variances[each - 1 :: each] = GAIN**2
    return variances


def _evidence(information: Array, right: Array, prior: Array) -> float:
    """The logarithm of the marginal likelihood, but for a constant."""
    root = np.sqrt(prior)
    matrix = np.eye(len(root)) + root[:, None] * information * root
    lower = np.linalg.cholesky(matrix)
    projected = np.linalg.solve(lower, root * right)
    return float(0.5 * projected @ projected - np.sum(np.log(np.diag(lower))))


def _design_effect(normal: _Normal, step: Array, precision: Array) -> float:
    """By how much more the scores of blocks spread than information says, on the average."""
    scores = normal.score - normal.information @ step
    count = len(scores) // BLOCK
    which = np.arange(len(scores)) * count // len(scores)
    summed = np.zeros((count, scores.shape[1]))
    np.add.at(summed, which, scores)
    expected = np.sum(normal.information, axis=0)
    spread = np.sum(summed * np.linalg.solve(precision, summed.T).T)
    return float(spread / max(np.trace(np.linalg.solve(precision, expected)), 1e-300))
