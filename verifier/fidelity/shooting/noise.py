"""Measurement noise, from the trace itself.

Two estimates, and the lower one counts, because each can only be too high:

* pseudo-residuals of the one-step prediction errors r_k = y_{k+1} - model(y_k): their second
  difference, weighted for uneven sampling (Gasser, Sroka, Jennen-Steinmetz 1986), removes what the
  model explains and any slowly varying error of the model; noise of the other variables leaks in;
* third divided differences of the samples: no model, nothing leaks in, but what curves within four
  samples counts as noise.

Outliers are clipped at four robust deviations. A quantised sensor has at least the noise of its
rounding, quantum / sqrt(12).

Successive values of the noise need not be independent. Second differences see the correlation p of
an AR(1) process: they have variance sigma^2 (6 - 8p + 2p^2) and lag-one correlation
(-4 + 7p - 4p^2 + p^3) / (6 - 8p + 2p^2), which rises from -2/3 for white noise to -1/2 for p = 1.
Where p is clearly negative (jitter of stamps makes it so), sigma is less than white noise would
have to be, and averages are calmer still; both are taken into account. Where p is positive, noise
and slow drift look alike, and only the white part is called noise. So the noise that is removed
from a departure is rather too little than too much: the verdict gets stricter, never laxer.
"""

import math
from dataclasses import replace

import numpy as np

from runtime.arrays import Array, Booleans
from runtime.program import Binding
from verifier.fidelity.shooting.prediction import Model, predict
from verifier.fidelity.shooting.samples import Samples, measured_states, turned
from verifier.fidelity.stretches.spans import contains
from verifier.report.report import Noise

MOST = 20_000
"""So many successive samples are enough."""
CLIP = 4.0
LATTICE = 0.05
"""How far from a multiple of the quantum, as a share of it, a quantised value may be."""
FEW = 12
"""With fewer residuals no noise is estimated."""
CLEAR = 4.4
"""Two standard errors of the correlation are this over the square root of the samples."""
LONGEST = 3.0
"""Samples further apart than so many median distances are not successive."""


def noise_of(model: Model, samples: tuple[Samples, ...], spans: Array) -> tuple[Noise, ...]:
    """The noise of every predicted state inside the judged `spans`."""
    declared = {each.name: each for each in model.flow.program.bindings}
    return tuple(
        as_declared(_predicted_noise(model, samples, j, spans), declared.get(each.state.name))
        for j, each in enumerate(samples)
    )


def as_declared(noise: Noise, binding: Binding | None) -> Noise:
    """The noise, or what the spec says of the sensor."""
    if binding is None or binding.noise is None:
        return noise
    return replace(noise, sigma=binding.noise, method=f"declared at {binding.origin}")


def plain_noise(times: Array, values: Array, turn: float) -> Noise:
    """The noise of a series that no model predicts, from its differences alone."""
    together = np.ones(max(len(times) - 1, 0), dtype=bool)
    return _noise(times, values, turn, together, np.full(len(together), np.nan))


def _predicted_noise(model: Model, samples: tuple[Samples, ...], j: int, spans: Array) -> Noise:
    each = samples[j]
    kept = slice(0, MOST)
    times, values, knots = each.times[kept], each.values[kept], each.knots[kept]
    steps = np.diff(times)
    inside = contains(spans, times)
    together = inside[1:] & inside[:-1] & (steps <= LONGEST * each.distance)
    errors = np.full(len(steps), np.nan)
    first, last = knots[:-1][together], knots[1:][together]
    if len(first):
        start = measured_states(model, samples, first)
        start[:, each.column] = values[:-1][together]
        paths = predict(model, start, first, last)[np.arange(len(first)), last - first]
        errors[together] = values[1:][together] - paths[:, each.column]
    return _noise(times, values, each.turn, together, turned(errors, each.turn))


def _noise(times: Array, values: Array, turn: float, together: Booleans, errors: Array) -> Noise:
    """From samples, whether each is followed directly (T - 1,), and one-step errors (T - 1,)."""
    residuals = _pseudo_residuals(times, errors)
    smooth = _third_differences(times, _unwound(values, turn), together)
    quantum = quantum_of(values)
    candidates = {
        "second differences of the one-step prediction errors": residuals,
        "third differences of the samples": smooth,
    }
    found = {method: _deviation(each) for method, each in candidates.items() if len(each) >= FEW}
    method = min(found, key=lambda name: found[name]) if found else "too few samples to tell"
    sigma = found.get(method, 0.0)
    if quantum / np.sqrt(12.0) > sigma:
        sigma, method = quantum / np.sqrt(12.0), "the step of the quantised sensor"
    count = max(len(residuals), len(smooth))
    correlation = _correlation(residuals)
    sigma *= float(np.sqrt(6.0 / _second_difference(_negative(correlation, count))))
    return Noise(sigma, count, correlation, quantum, method)


def averaged(noise: Noise, count: Array) -> Array:
    """The variance of the mean of `count` successive samples.

    For AR(1) noise sigma^2 / m (1 + 2 sum_k (1 - k / m) p^k), with p as far as clearly negative.
    """
    m = np.maximum(count, 1.0)
    p = _negative(noise.correlation, noise.samples)
    series = p / (1.0 - p) - p * (1.0 - p**m) / (m * (1.0 - p) ** 2)
    return np.asarray(noise.sigma**2 / m * (1.0 + 2.0 * series))


def _negative(correlation: float, count: int) -> float:
    return min(0.0, correlation + CLEAR / math.sqrt(max(count, 1)))


def _second_difference(p: float) -> float:
    """The variance of second differences of AR(1) noise of variance 1."""
    return 6.0 - 8.0 * p + 2.0 * p**2


def _unwound(values: Array, turn: float) -> Array:
    return np.unwrap(values, period=turn) if turn > 0.0 else values


def _pseudo_residuals(times: Array, errors: Array) -> Array:
    """Scaled to the variance of the noise; only where two errors follow one another."""
    steps = np.diff(times)
    before, after = steps[:-1], steps[1:]
    a, b = before / (before + after), after / (before + after)
    residuals = (a * errors[1:] - b * errors[:-1]) / np.sqrt(1.0 + a**2 + b**2)
    return residuals[np.isfinite(residuals)]


def _third_differences(times: Array, values: Array, together: Booleans) -> Array:
    """Third divided differences, scaled to the variance of the noise."""
    if len(times) < 4:
        return np.empty(0)
    t = np.lib.stride_tricks.sliding_window_view(times, 4)
    y = np.lib.stride_tricks.sliding_window_view(values, 4)
    apart = t[:, :, None] - t[:, None, :] + np.eye(4) * np.median(np.diff(times))
    weights = 1.0 / np.prod(apart, axis=2)
    scaled = np.sum(weights * y, axis=1) / np.sqrt(np.sum(weights**2, axis=1))
    follows = np.lib.stride_tricks.sliding_window_view(together, 3).all(axis=1)
    return np.asarray(scaled[follows])


def _deviation(residuals: Array) -> float:
    """The standard deviation about zero, outliers clipped."""
    robust = 1.4826 * float(np.median(np.abs(residuals)))
    limit = CLIP * (robust if robust > 0.0 else float(np.sqrt(np.mean(residuals**2))))
    return float(np.sqrt(np.mean(np.minimum(residuals**2, limit**2))))


def quantum_of(values: Array) -> float:
    """The step of a quantised sensor: what all values are multiples of; 0 if there is none.

    >>> quantum_of(np.array([0.1, 0.2, 0.2, 0.4, 0.4, 0.3, 0.2, 0.1]))
    0.1
    """
    levels = np.unique(values)
    steps = np.diff(levels)
    steps = steps[steps > 1e-9 * (levels[-1] - levels[0])]
    if len(steps) == 0 or len(steps) + 1 > len(values) / 2.0:
        return 0.0
    quantum = float(np.min(steps))
    misfit = np.abs(steps / quantum - np.rint(steps / quantum))
    return float(f"{quantum:.9g}") if np.all(misfit < LATTICE) else 0.0


def _correlation(residuals: Array) -> float:
    """Of successive values of the noise, from the lag-one correlation of its second differences."""
    if len(residuals) < FEW or not np.any(residuals):
        return 0.0
    limit = CLIP * _deviation(residuals)
    d = np.clip(residuals, -limit, limit)
    lag_one = float(np.sum(d[1:] * d[:-1]) / np.sum(d * d))
    p = np.linspace(-0.9, 0.99, 190)
    theory = (-4.0 + 7.0 * p - 4.0 * p**2 + p**3) / (6.0 - 8.0 * p + 2.0 * p**2)
    return float(np.interp(lag_one, theory, p))
