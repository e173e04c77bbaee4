"""Running one behavior alone: by names, in SI, many starts at once."""

import difflib
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final, TypeAlias, assert_never, final

import numpy as np

from runtime.arrays import Array, frozen
from runtime.flow import Flow, Source, flow_of
from runtime.integrators import Trajectories, adaptive, fixed_steps
from runtime.kernels.switching import MOST_SWITCHES
from runtime.machine import evaluate
from runtime.program import Control, Kind, Program, State
from runtime.restless import restless
from runtime.rollout import Ending, Rollout, Switches

SAMPLES: Final = 1000
"""Intervals between samples where the caller names none."""
MOST_SAMPLES: Final = 50_000_000
"""Numbers in one rollout; more is a mistake in the units."""


@final
@dataclass(frozen=True, slots=True)
class Adaptive:
    """Steps as long as the tolerance allows; `rtol` is relative to the state.

    `atol` is in widths of each state's domain.
    """

    rtol: float = 1e-9
    atol: float = 1e-12


@final
@dataclass(frozen=True, slots=True)
class FixedSteps:
    """The classical Runge-Kutta method with steps of at most `step` seconds."""

    step: float


Integrator: TypeAlias = Adaptive | FixedSteps


def simulate(
    program: Program,
    start: Mapping[str, float | Array],
    duration: float,
    controls: Mapping[str, float | Array] | None = None,
    every: float | None = None,
    *,
    method: Integrator = Adaptive(),  # frozen
    source: Source = Source.TABLES,
    seed: int = 0,
) -> Rollout:
    """Let a behavior run for `duration` seconds, with a sample `every` so many seconds.

    start, controls: numbers or arrays that broadcast to one batch of trajectories. States that
    `start` does not name begin at their `hold`; controls have their defaults. A step map steps on
    its own clock, whatever `method` says. The last sample is at `duration`. seed: of all chance,
    where the program has noise.

    Raises:
        ValueError: a name is unknown, a value is outside its domain, or a time makes no sense.
    """
    flow = flow_of(program, source)
    x0 = _values(program.states, start, "state")
    u = _values(program.controls, controls or {}, "control")
    shape = np.broadcast_shapes(x0.shape[:-1], u.shape[:-1])
    runs = math.prod(shape)
    x0, u = (np.broadcast_to(v, (*shape, v.shape[-1])).reshape(runs, v.shape[-1]) for v in (x0, u))
    times = _sample_times(program, duration, every)
    if times.size * x0.size > MOST_SAMPLES:
        raise ValueError(
            f"{x0.shape[0]} runs with {times.size} samples each are too many; sample less often"
        )
    ran = _run_with_noise(flow, x0, u, times, method, seed)
    register = _with_constants(flow, ran.states, u)
    outputs = evaluate([output.code for output in program.outputs], program.register, register)
    # Code that reads no state has a value even after the end; a rollout has none there.
    outputs[np.isnan(ran.states).any(axis=-1)] = np.nan
    return Rollout(
        program=program.name,
        times=frozen(times),
        states=frozen(ran.states.reshape(*shape, *ran.states.shape[1:])),
        controls=frozen(u.reshape(*shape, u.shape[-1])),
        outputs=frozen(outputs.reshape(*shape, *outputs.shape[1:])),
        endings=tuple(ran.ending(b) for b in range(len(x0))),
        details=tuple(_detail(program, ran, b) for b in range(len(x0))),
        ended_at=frozen(ran.ended_at.reshape(shape)),
        ended_in=frozen(ran.ended_in.reshape(*shape, -1)),
        switches=ran.switches,
    )


def _run_with_noise(
    flow: Flow, x0: Array, u: Array, times: Array, method: Integrator, seed: int
) -> Trajectories:
    if not flow.program.noise:
        return _run(flow, x0, u, times, method)

    def move(x: Array, held: Array, span: Array) -> Trajectories:
        return _run(flow, x, held, span, method)

    return restless(flow, x0, u, times, seed, move)


def _run(flow: Flow, x0: Array, u: Array, times: Array, method: Integrator) -> Trajectories:
    n, p = len(flow.program.states), len(flow.program.controls)
    columns = np.arange(n, n + p)
    held = u[:, np.newaxis, :]
    if flow.is_map:
        return fixed_steps(flow, x0, times, held, columns)
    match method:
        case Adaptive(rtol, atol):
            widths = np.array([state.high - state.low for state in flow.program.states])
            return adaptive(flow, x0, u, times, rtol, atol * widths)
        case FixedSteps() if flow.switches:
            raise ValueError(
                f"'{flow.program.name}' has modes that switch, which fixed steps do not look for; "
                "use adaptive steps"
            )
        case FixedSteps(step):
            fine, stride = _divided(times, step)
            ran = fixed_steps(flow, x0, fine, held, columns)
            return Trajectories(
                np.ascontiguousarray(ran.states[:, ::stride]),
                ran.endings,
                ran.variables,
                ran.sides,
                ran.ended_at,
                ran.ended_in,
                ran.switches,
            )
    assert_never(method)


def _divided(times: Array, step: float) -> tuple[Array, int]:
    """The times with equal parts of at most `step` between them, and how many parts."""
    if not step > 0.0:
        raise ValueError(f"the step must be positive (got {step!r} s)")
    stride = max(1, math.ceil(np.max(np.diff(times)) / step * (1.0 - 1e-12)))
    if stride * len(times) > MOST_SAMPLES:
        raise ValueError(f"steps of {step!r} s are too many for {times[-1]!r} s")
    fine = np.interp(
        np.arange(stride * (len(times) - 1) + 1) / stride, np.arange(len(times)), times
    )
    return fine, stride


def _sample_times(program: Program, duration: float, every: float | None) -> Array:
    if not (duration > 0.0 and math.isfinite(duration)):
        raise ValueError(f"the duration must be positive (got {duration!r} s)")
    if program.field.is_map:
        clock = program.field.every
        if every is not None and not math.isclose(every, clock, rel_tol=1e-9):
            raise ValueError(f"'{program.name}' steps every {clock!r} s (got every {every!r} s)")
        steps = math.floor(duration / clock * (1.0 + 1e-12))
        _require_few(steps, duration)
        return np.arange(steps + 1, dtype=np.float64) * clock
    interval = duration / SAMPLES if every is None else every
    if not interval > 0.0:
        raise ValueError(f"the time between samples must be positive (got {interval!r} s)")
    _require_few(duration / interval, duration)
    count = math.floor(duration / interval * (1.0 + 1e-12))
    times = np.arange(count + 1, dtype=np.float64) * interval
    if math.isclose(times[-1], duration, rel_tol=1e-9):
        times[-1] = duration
        return times
    return np.append(times, duration)


def _require_few(count: float, duration: float) -> None:
    if count > MOST_SAMPLES:
        raise ValueError(f"{count:.3g} samples in {duration!r} s are too many; sample less often")


def _values(
    variables: Sequence[State | Control], given: Mapping[str, float | Array], role: str
) -> Array:
    """The values (..., number of variables), checked."""
    names = [variable.name for variable in variables]
    for name in given:
        if name not in names:
            near = difflib.get_close_matches(name, names, n=1)
            hint = f"did you mean '{near[0]}'?" if near else f"there are: {', '.join(names) or '-'}"
            raise ValueError(f"no {role} is named '{name}'; {hint}")
    columns = [_value(variable, given) for variable in variables]
    return np.stack(np.broadcast_arrays(*columns), axis=-1) if columns else np.zeros(0)


def _value(variable: State | Control, given: Mapping[str, float | Array]) -> Array:
    default = variable.hold if isinstance(variable, State) else variable.default
    value = np.asarray(given.get(variable.name, default), dtype=np.float64)
    if isinstance(variable, State) and variable.kind is Kind.DISCRETE:
        if not np.isin(value, np.arange(len(variable.values))).all():
            raise ValueError(
                f"'{variable.name}' is discrete: 0 .. {len(variable.values) - 1} for "
                f"{', '.join(variable.values)} (got {_first(value)!r})"
            )
        return value
    periodic = isinstance(variable, State) and variable.kind is Kind.PERIODIC
    good = np.isfinite(value) if periodic else (variable.low <= value) & (value <= variable.high)
    if not good.all():
        raise ValueError(
            f"{variable.name} = {_shown(variable, _first(value[~good]))} is outside its domain "
            f"{_domain(variable)}"
        )
    return value


def _with_constants(flow: Flow, states: Array, u: Array) -> Array:
    constants = flow.defaults[len(flow.program.states) + len(flow.program.controls) :]
    batch, samples, _ = states.shape
    return np.concatenate(
        [
            states,
            np.broadcast_to(u[:, np.newaxis], (batch, samples, u.shape[-1])),
            np.broadcast_to(constants, (batch, samples, constants.size)),
        ],
        axis=-1,
    )


def _detail(program: Program, ran: Trajectories, b: int) -> str:
    """What happened, with names and numbers in the spec's own units."""
    when = f"at t = {ran.ended_at[b]:.6g} s"
    match ran.ending(b):
        case Ending.COMPLETED:
            return ""
        case Ending.LEFT_DOMAIN:
            variables: list[State | Control] = [*program.states, *program.controls]
            variable = variables[ran.variables[b]]
            edge = variable.high if ran.sides[b] > 0 else variable.low
            side = "above" if ran.sides[b] > 0 else "below"
            return f"{variable.name} went {side} {_shown(variable, edge)} {when}"
        case Ending.DIVERGED:
            return f"the rates are not finite {when}, {_state_text(program, ran.ended_in[b])}"
        case Ending.TOO_MANY_STEPS:
            return f"the step limit was reached {when}, {_state_text(program, ran.ended_in[b])}"
        case Ending.CHATTERING:
            return f"switches without end {when}, {_modes_text(program, ran.switches.of(b))}"


def _modes_text(program: Program, switches: Switches) -> str:
    """Between which modes it switched to and fro at the end."""
    mode = next(state for state in program.states if state.name == program.field.mode)
    last = np.unique([switches.left[-MOST_SWITCHES:], switches.entered[-MOST_SWITCHES:]])
    names = " and ".join(mode.values[index] for index in last)
    return f"between {names}" if len(last) > 1 else f"from {names} to itself"


def _state_text(program: Program, x: Array) -> str:
    pairs = zip(program.states, x, strict=True)
    return "in " + ", ".join(f"{state.name} = {_shown(state, value)}" for state, value in pairs)


def _shown(variable: State | Control, value: float) -> str:
    """A value in the unit that the spec's author chose."""
    unit = "" if variable.unit.text == "1" else f" {variable.unit.text}"
    return f"{value / variable.unit.scale:.6g}{unit}"


def _domain(variable: State | Control) -> str:
    low, high = _shown(variable, variable.low), _shown(variable, variable.high)
    return f"({low} to {high})"


def _first(values: Array) -> float:
    return float(np.ravel(values)[0])
