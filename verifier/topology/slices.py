"""A slice of a behavior: one to four states move, everything else is held at named values.

m: number of axes; n: of states; p: of controls. Points are (..., m), SI.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import final

import numpy as np

from runtime.arrays import Array, frozen
from runtime.flow import Flow, Source, flow_of, jacobian, next_states, rates
from runtime.program import Control, Field, Kind, Program, Role, State, Term
from spec_schema.suggest import nearest
from verifier.topology.features import AxisRange, Held


@final
class SliceError(Exception):
    """A portrait that can't be made as asked; the message says why in a sentence."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Slice:
    """A behavior, reduced to the rates of its axes.

    program: only the axes move in it, and a mode stays; whole: only what the spec holds is held.
    formula: the slice by the spec's own expressions, None where there are none beside tables.
    accuracy: (m,) the tables' measured error of each axis' rate; resolution: (m, m) what that
    may do to entry (i, j) of the Jacobian.
    """

    program: Program
    flow: Flow
    whole: Flow
    formula: Flow | None
    axes: tuple[AxisRange, ...]
    columns: tuple[int, ...]
    held: tuple[Held, ...]
    x: Array
    u: Array
    accuracy: Array
    resolution: Array

    @property
    def is_map(self) -> bool:
        """Whether points jump by steps instead of flowing."""
        return self.program.field.is_map

    @property
    def low(self) -> Array:
        """The lower corner of the slice, (m,)."""
        return np.array([axis.low for axis in self.axes])

    @property
    def width(self) -> Array:
        """The widths of the slice, (m,)."""
        return np.array([axis.width for axis in self.axes])

    @property
    def periodic(self) -> tuple[bool, ...]:
        """Which axes wrap around."""
        return tuple(axis.periodic for axis in self.axes)


def cut(program: Program, axes: tuple[str, ...] | None, held: Mapping[str, float]) -> Slice:
    """The slice of `program` over `axes`, with the rest at `held` (SI) or at its default.

    Without `axes`: the first two variables that move by themselves, or the only one.

    Raises:
        SliceError: an unknown name, a value outside its domain, an axis that can't be one.
    """
    chosen = _default_axes(program) if axes is None else axes
    columns = _columns(program, chosen)
    _check_held(program, chosen, held)
    reduced = _hold_the_rest(program, chosen, held)
    x = frozen([state.hold for state in reduced.states])
    u = frozen([held.get(control.name, control.default) for control in program.controls])
    ranges = tuple(_axis(program.states[i]) for i in columns)
    accuracy = _accuracy(program, chosen)
    return Slice(
        program=reduced,
        flow=flow_of(reduced),
        whole=flow_of(program),
        formula=_formula(reduced),
        axes=ranges,
        columns=columns,
        held=_held(reduced, chosen, u),
        x=x,
        u=u,
        accuracy=accuracy,
        resolution=_resolution(program, ranges, accuracy),
    )


def states_at(view: Slice, points: Array) -> Array:
    """Whole states (..., n) at `points`, periodic axes wrapped into their domains."""
    x = np.broadcast_to(view.x, (*points.shape[:-1], view.x.size)).copy()
    x[..., view.columns] = wrapped(view, points)
    return x


def wrapped(view: Slice, points: Array) -> Array:
    """`points` with their periodic coordinates in [low, high)."""
    inside = np.array(points, dtype=np.float64)
    for j, axis in enumerate(view.axes):
        if axis.periodic:
            inside[..., j] = axis.low + np.mod(inside[..., j] - axis.low, axis.width)
    return inside


def shortest(view: Slice, differences: Array) -> Array:
    """`differences` of points (..., m) with periodic coordinates taken the short way round."""
    short = np.array(differences, dtype=np.float64)
    for j, axis in enumerate(view.axes):
        if axis.periodic:
            short[..., j] = _shortest(short[..., j], axis.width)
    return short


def rates_at(view: Slice, points: Array, flow: Flow | None = None) -> Array:
    """Rates of the axes (..., m) at `points`; for a map the displacement of one step."""
    return _changes(view, flow or view.flow, points)[..., view.columns]


def jacobians_at(view: Slice, points: Array, flow: Flow | None = None) -> Array:
    """Derivatives (..., m, m) of the rates of the axes; for a map of the next point."""
    x = states_at(view, points)
    everything = jacobian(flow or view.flow, x, view.u)
    columns = list(view.columns)
    on_axes: Array = everything[..., columns, :][..., :, columns]
    return on_axes


def drifts_at(view: Slice, points: Array) -> Array:
    """Rates (..., n) of all states of the whole behavior at `points`; for a map displacements."""
    return _changes(view, view.whole, points)


def _changes(view: Slice, flow: Flow, points: Array) -> Array:
    return _of_all(view, flow, states_at(view, points))


def all_rates_at(view: Slice, x: Array) -> Array:
    """Rates (..., n) of all states of the whole behavior at whole states `x`; displacements."""
    return _of_all(view, view.whole, x)


def _of_all(view: Slice, flow: Flow, x: Array) -> Array:
    """Rates (..., n) of all states, or how far one step moves them, the short way round."""
    if not view.is_map:
        return rates(flow, x, view.u)
    change = next_states(flow, x, view.u) - x
    for j, state in enumerate(view.program.states):
        if state.kind is Kind.PERIODIC:
            change[..., j] = _shortest(change[..., j], state.high - state.low)
    return change


def _shortest(difference: Array, period: float) -> Array:
    return difference - period * np.round(difference / period)


def _default_axes(program: Program) -> tuple[str, ...]:
    driven = [s.name for s in program.states if s.is_driven and s.kind is not Kind.DISCRETE]
    assumed = [s.name for s in program.states if not s.is_driven and s.closure is not None]
    return tuple((driven + assumed)[:2])


def _columns(program: Program, axes: tuple[str, ...]) -> tuple[int, ...]:
    twice = next((name for i, name in enumerate(axes) if name in axes[:i]), None)
    if twice is not None:
        raise SliceError(f"'{twice}' stands twice among the axes")
    if len(axes) not in {1, 2, 3, 4}:
        raise SliceError(f"a slice has one to four axes (got {', '.join(axes) or 'none'})")
    states = {state.name: i for i, state in enumerate(program.states)}
    for name in axes:
        if name not in states:
            raise SliceError(_unknown("state variable", name, tuple(states)))
        if program.states[states[name]].kind is Kind.DISCRETE:
            raise SliceError(f"'{name}' is discrete and can't be an axis: hold it at a value")
    return tuple(states[name] for name in axes)


def _check_held(program: Program, axes: tuple[str, ...], held: Mapping[str, float]) -> None:
    named: list[State | Control] = [*program.states, *program.controls]
    parts = {part.name: part for part in named}
    for name, value in held.items():
        if name not in parts:
            raise SliceError(_unknown("state or control", name, tuple(parts)))
        if name in axes:
            raise SliceError(f"'{name}' is an axis and can't be held as well")
        part = parts[name]
        if not part.low <= value <= part.high:
            scale, unit = part.unit.scale, part.unit.text
            raise SliceError(
                f"'{name}' must be in {part.low / scale:g}..{part.high / scale:g} {unit}"
                f" (got {value / scale:g})"
            )


def _unknown(what: str, name: str, known: tuple[str, ...]) -> str:
    guess = nearest(name, known)
    hint = f"did you mean '{guess}'?" if guess else f"there are: {', '.join(known)}"
    return f"no {what} is named '{name}'; {hint}"


def _hold_the_rest(program: Program, axes: tuple[str, ...], held: Mapping[str, float]) -> Program:
    """The same behavior in which only `axes` move: the other states become held ones."""
    states = tuple(
        s
        if s.name in axes
        else replace(s, role=Role.SENSED, closure=None, hold=held.get(s.name, s.hold))
        for s in program.states
    )
    return replace(program, states=states, field=_kept(program.field, axes), outputs=())


def _kept(field: Field, axes: tuple[str, ...]) -> Field:
    kept = [i for i, name in enumerate(field.driven) if name in axes]
    terms = tuple(_renumbered(t, kept) for t in field.terms if t.component in kept)
    return replace(
        field,
        driven=tuple(field.driven[i] for i in kept),
        terms=terms,
        bounds=tuple(field.bounds[i] for i in kept) if field.bounds else (),
        formula=None if field.formula is None else tuple(field.formula[i] for i in kept),
        mode="",
        guards=(),
    )


def _renumbered(term: Term, kept: list[int]) -> Term:
    return replace(term, component=kept.index(term.component))


def _formula(program: Program) -> Flow | None:
    field = program.field
    if field.formula is None or not field.tables:
        return None
    return flow_of(program, Source.FORMULA)


def _axis(state: State) -> AxisRange:
    periodic = state.kind is Kind.PERIODIC
    return AxisRange(state.name, state.unit, state.low, state.high, periodic)


def _held(program: Program, axes: tuple[str, ...], u: Array) -> tuple[Held, ...]:
    rest = [s for s in program.states if s.name not in axes]
    states = tuple(Held(s.name, s.unit, s.hold, _label(s)) for s in rest)
    controls = tuple(
        Held(c.name, c.unit, float(value), "") for c, value in zip(program.controls, u, strict=True)
    )
    return states + controls


def _label(state: State) -> str:
    return state.values[int(state.hold)] if state.kind is Kind.DISCRETE else ""


def _accuracy(program: Program, axes: tuple[str, ...]) -> Array:
    field = program.field
    if not field.tables or not field.bounds:
        return frozen(np.zeros(len(axes)))
    bound = {name: b.measured for name, b in zip(field.driven, field.bounds, strict=True)}
    return frozen([bound.get(name, 0.0) for name in axes])


def _resolution(program: Program, axes: tuple[AxisRange, ...], accuracy: Array) -> Array:
    """What errors of size `accuracy` between nodes one step apart do to derivatives."""
    steps = [
        min(
            (a.step for t in program.field.tables for a in t.axes if a.name == axis.name),
            default=np.inf,
        )
        for axis in axes
    ]
    # A spline's derivative is off by a few times its error per node distance (de Boor, 1978).
    return frozen(4.0 * accuracy[:, None] / np.array(steps)[None, :])
