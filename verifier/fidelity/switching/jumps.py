"""The state just after each change of mode against what the spec makes of the one just before.

Both are fitted, each to its own side. States that the guard does not reset go on from where they
were; that tells the instant of the change within the doubt that the stamps of the mode leave.

K: changes; D: predicted states.
"""

from dataclasses import dataclass
from typing import final

import numpy as np

from runtime.arrays import Array, Booleans, Integers
from runtime.flow import rates
from verifier.fidelity.shooting.jumps import register_under, reset_by
from verifier.fidelity.shooting.samples import turned
from verifier.fidelity.switching.fits import Fit, fan, fitted, knots_between
from verifier.fidelity.switching.setting import Setting, inputs_at, knot_at
from verifier.fidelity.switching.stays import Stay

INSTANT = 1e-4
"""A little while, as a share of the time to which states are fitted."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Jumps:
    """The changes (K,), as far as `is_good` (K,) says; errors are measured minus predicted.

    before: what is known of the states just before them, fitted to their own side only.
    error, variance, is_reset (K, D). shift (K,): by how much the change came after the middle of
    its doubt, and `shift_variance` (K,) of that. slope (K, D): by how much the state after the
    change were elsewhere, had it come a second later.
    """

    before: "Before"
    is_good: Booleans
    error: Array
    variance: Array
    is_reset: Booleans
    shift: Array
    shift_variance: Array
    slope: Array


@final
@dataclass(frozen=True, eq=False, slots=True)
class Before:
    """The states (1 + D, K, n) at the knots `at` (K,): as fitted, and from nudged starts.

    nudge (K, D), covariance (K, D, D): of the starts.
    """

    states: Array
    nudge: Array
    covariance: Array
    at: Integers


def jumps_of(setting: Setting, stays: tuple[Stay, ...], guards: Integers) -> Jumps:
    """The jumps at all changes, by the guards (K,) that they took, -1 for none."""
    changes, grid = setting.changes, setting.model.grid
    ends, begins = _sides(setting, stays)
    at = knot_at(grid, changes.times)
    left, entered = (modes.astype(np.float64) for modes in (changes.left, changes.entered))
    before = fitted(setting, knot_at(grid, ends[:, 0]), ends, ends[:, 1], left)
    after = fitted(setting, at, begins, begins[:, 0], entered)
    fitted_before, nudge = _at_change(setting, before, at)
    predicted = _after_jump(setting, fitted_before, before.modes, (at, guards))
    columns = setting.columns
    turns = np.array([each.turn for each in setting.samples])
    error = after.start[:, columns] - predicted[0][:, columns]
    for j, turn in enumerate(turns):
        error[:, j] = turned(error[:, j], float(turn))
    slopes = (predicted[1:, :, columns] - predicted[:1, :, columns]) / nudge.T[:, :, None]
    covariance = after.covariance + np.einsum("iku,kij,jkv->kuv", slopes, before.covariance, slopes)
    slope = _slope(setting, (fitted_before[0], predicted[0], after.start), (at, guards))
    is_reset = _reset(setting, guards)
    good = before.is_good & after.is_good & (guards >= 0) & np.all(np.isfinite(error), axis=1)
    shift, doubt = _shifts(changes.doubt, (error, covariance, slope), is_reset)
    return Jumps(
        before=Before(fitted_before, nudge, before.covariance, at),
        is_good=good,
        error=error + slope * shift[:, None],
        variance=np.einsum("kii->ki", covariance) + slope**2 * doubt[:, None],
        is_reset=is_reset,
        shift=np.where(good, shift, 0.0),
        shift_variance=np.where(good, doubt, changes.doubt**2 / 12.0),
        slope=slope,
    )


def _sides(setting: Setting, stays: tuple[Stay, ...]) -> tuple[Array, Array]:
    """The spans (K, 2) just before and just after the changes; empty beside an exclusion."""
    since, until = setting.changes.since, setting.changes.until
    ends = np.column_stack([since, since - 1.0])
    begins = np.column_stack([until, until - 1.0])
    firsts = {stay.begin: stay for stay in stays}
    for stay in stays:
        if stay.change >= 0:
            ends[stay.change] = max(stay.begin, stay.end - setting.lead), stay.end
            following = firsts.get(float(until[stay.change]))
            if following is not None:
                span = min(following.end, following.begin + setting.lead)
                begins[stay.change] = following.begin, span
    return ends, begins


def _at_change(setting: Setting, before: Fit, at: Integers) -> tuple[Array, Array]:
    """States (1 + D, K, n) at the changes, from the fitted start and nudged ones; nudges."""
    paths, nudge = fan(setting, before, knots_between(before.first, at))
    step = np.clip(at - before.first, 0, paths.shape[2] - 1)
    return paths[:, np.arange(len(at)), step], nudge


def _after_jump(
    setting: Setting, states: Array, modes: Array, where: tuple[Integers, Integers]
) -> Array:
    """The states (c, K, n) after the jump of the guards; where: knots and guards (K,)."""
    at, guards = where
    inputs = inputs_at(setting, np.maximum(at - 1, 0)[:, None], modes)[:, 0]
    after = np.array(states)
    for index in np.unique(guards[guards >= 0]):
        here = guards == index
        for copy in range(len(states)):
            part = states[copy][here]
            columns = setting.model.grid.columns
            register = register_under(setting.flow, part, inputs[here], columns)
            guard = setting.guards[index]
            after[copy][here] = reset_by(setting.program, [guard], register, part)
    return after


def _slope(
    setting: Setting, states: tuple[Array, Array, Array], where: tuple[Integers, Integers]
) -> Array:
    """How fast the error grows (K, D) with the time of the change: what a saltation tells.

    states: fitted before the change, predicted from that, and fitted after it, all (K, n).
    """
    before, predicted, after = states
    at, left = where[0], setting.changes.left.astype(np.float64)
    inputs = inputs_at(setting, np.maximum(at - 1, 0)[:, None], left)[:, 0]
    little = INSTANT * setting.lead
    later = before + little * rates_at(setting, before, inputs)
    carried = (_after_jump(setting, later[None], left, where)[0] - predicted) / little
    entered = inputs_at(setting, at[:, None], setting.changes.entered.astype(np.float64))[:, 0]
    return np.asarray((rates_at(setting, after, entered) - carried)[:, setting.columns])


def rates_at(setting: Setting, states: Array, inputs: Array) -> Array:
    """The rates (K, n) in states (K, n) under inputs (K, k)."""
    program = setting.program
    register = register_under(setting.flow, states, inputs, setting.model.grid.columns)
    n, p = len(program.states), len(program.controls)
    return rates(setting.flow, register[:, :n], register[:, n : n + p])


def _reset(setting: Setting, guards: Integers) -> Booleans:
    """Which states (K, D) the guards reset."""
    named = [{name for name, _ in guard.resets} for guard in setting.guards]
    return np.array(
        [[g >= 0 and s.state.name in named[g] for s in setting.samples] for g in guards], dtype=bool
    ).reshape(len(guards), len(setting.samples))


def _shifts(
    doubt: Array, found: tuple[Array, Array, Array], is_reset: Booleans
) -> tuple[Array, Array]:
    """When each change came after the middle of its `doubt` (K,), and the variance of that.

    found: errors (K, D), their covariances and slopes. Least squares over the states that go on,
    not held within the doubt, which would pull a mean that is taken over many. Where they tell
    less than the stamps do, the stamps count.
    """
    error, covariance, slope = found
    shift, variance = np.zeros(len(doubt)), doubt**2 / 12.0
    for k in np.flatnonzero(doubt > 0.0):
        on = ~is_reset[k] & np.isfinite(error[k]) & np.isfinite(slope[k])
        weighed = np.linalg.solve(covariance[k][np.ix_(on, on)], slope[k][on])
        told = float(weighed @ slope[k][on])
        if told * variance[k] > 1.0:
            variance[k] = 1.0 / told
            shift[k] = np.clip(-float(weighed @ error[k][on]) / told, -doubt[k], doubt[k])
    return shift, variance
