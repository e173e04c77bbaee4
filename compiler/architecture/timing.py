"""Time: what is too slow for the field that it serves."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final, final

import numpy as np

from compiler.architecture.ages import Age, Readings, age_of
from compiler.architecture.parts import Part, Parts, is_read
from compiler.architecture.times import check_common_step, seconds
from compiler.findings import Findings
from runtime.architecture import Choice, Input, Signal
from runtime.arrays import Array
from runtime.flow import Source, flow_of, in_one_mode, jacobian
from runtime.program import Kind, Program

MOST: Final = 0.5
"""Of lag * rate. Late feedback x' = -k x(t - lag) overshoots from k * lag = 1/e = 0.37 on and is
unstable from pi/2 = 1.57 on; with a period and a response time the lag is between response_time
and period + response_time, in the mean half a period less (Michiels, Niculescu 2014, chapter 1)."""

SLACK: Final = 1e-6
"""Relative: what differences miss of a Jacobian."""
ROUND: Final = (1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0)
"""What is proposed, times a power of ten: from 10 ms on all are multiples of 5 ms."""
POINTS: Final = 600
SEED: Final = 20261122


@final
@dataclass(frozen=True, slots=True)
class Fastest:
    """The fastest rate (1/s) at which what a behavior senses answers what it drives."""

    rate: float
    where: dict[str, float]


def check_timing(
    inputs: Mapping[str, tuple[Input, ...]],
    signals: Sequence[Signal],
    choices: Mapping[str, tuple[Choice, ...]],
    parts: Parts,
    findings: Findings,
) -> None:
    """Findings for nodes that are too slow, and for times that no common step divides."""
    readings = Readings(inputs, signals, parts)
    for part in parts.nodes.values():
        program = _field_of(part)
        if program is None or part.period == 0.0:
            continue
        if program.field.is_map:
            _check_map(part, program, findings)
        elif not _is_known(program):
            _tell_unchecked(part, program, findings)
        else:
            unset = {
                control.name: (control.default, control.default) for control in program.controls
            }
            reach = reach_of(part, inputs, choices, parts)
            fastest = fastest_of(program, unset | reach if part.arbiter else reach)
            _check_lag(_Answer(part, program, readings), fastest, findings)
    check_common_step(parts, findings)


def _field_of(part: Part) -> Program | None:
    """What has a field in a node: a behavior, or the plan of an arbiter, which is one, too."""
    return part.program if part.arbiter is None else part.arbiter.plan


def _check_map(part: Part, program: Program, findings: Findings) -> None:
    every = program.field.every
    if not math.isclose(every, part.period, rel_tol=1e-9):
        message = f"{program.name} is a map that makes a step every {seconds(every)}"
        remedy = f"write 'period: {seconds(every)}'"
        findings.error("S351", (*part.path, "period"), message, remedy)


def _tell_unchecked(part: Part, program: Program, findings: Findings) -> None:
    """A warning where the rates of the field that feeds back are not known yet."""
    if _fed_back(program):
        form = program.field.form
        message = (
            f"whether {part.name} answers in time is not checked here: {program.name} gives its "
            f"field by `{form}`, whose rates are known only once it is compiled"
        )
        allowed = " --allow-code" if program.field.form == "module" else ""
        remedy = f"run `specc compile{allowed}` on this architecture: it tells"
        findings.warning("S354", (*part.path, "period"), message, remedy)


def _is_known(program: Program) -> bool:
    """Whether the field is there: as tables, or as a formula."""
    return bool(program.field.terms) or program.field.formula is not None


def _fed_back(program: Program) -> list[int]:
    """The states that are sensed as well as driven, by place."""
    return [
        i
        for i, state in enumerate(program.states)
        if is_read(state, program) and state.is_driven and state.kind is not Kind.DISCRETE
    ]


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Answer:
    """A node with a field that feeds back, and what that reads."""

    part: Part
    program: Program
    readings: Readings

    def age(self, period: float) -> Age:
        """Of the oldest reading that the field feeds back, were this the node's period."""
        names = [self.program.states[place].name for place in _fed_back(self.program)]
        return age_of(self.part.name, names, period, self.readings)

    def fits(self, period: float, response: float, allowed: float) -> bool:
        """Whether it would answer within the time that is allowed."""
        return period + response + self.age(period).seconds <= allowed * (1.0 + SLACK)


def _check_lag(answer: _Answer, fastest: Fastest, findings: Findings) -> None:
    """A finding where a node acts on what is too old for its field when its act ends."""
    part, age = answer.part, answer.age(answer.part.period)
    lag = part.lag + age.seconds
    if fastest.rate * lag <= MOST * (1.0 + SLACK):
        return
    units = {variable.name: variable.unit for variable in answer.program.states}
    where = ", ".join(
        f"{name} = {value / units[name].scale:.3g} {units[name].text}".removesuffix(" 1")
        for name, value in fastest.where.items()
    )
    through = f" (through {' and '.join(age.through)})" if age.through else ""
    old = f", {seconds(age.seconds)} of it since {age.sensor} sampled{through}"
    message = (
        f"{part.name} answers up to {seconds(lag)} late{old if age.seconds else ''}, and its field "
        f"changes at up to {fastest.rate:.3g} per second (at {where})"
    )
    at, remedy = _remedy(answer, MOST / fastest.rate)
    findings.error("S353", (*part.path, at), message, f"{remedy}, or lower its gains")


def _remedy(answer: _Answer, allowed: float) -> tuple[str, str]:
    """What to write, and in which place, to be within the time that is allowed."""
    part, age = answer.part, answer.age(answer.part.period)
    spare, response = allowed - age.seconds, part.response_time
    if spare < 0.2 * allowed:
        late = " and ".join((f"the sensor {age.sensor}", *age.through))
        times = "`latency` or `every`"
        return "period", f"let {late} say sooner ({times} in its body)"
    if response < 0.8 * spare:
        period = _rounded(spare - response)
        if answer.fits(period, response, allowed):
            return "period", f"write 'period: {seconds(period)}' or less"
    if part.period < 0.8 * spare:
        later = seconds(_rounded(spare - part.period))
        return "response_time", f"write 'response_time: {later}' or less"
    half = _rounded(spare / 2)
    while not answer.fits(half, half, allowed) and half > 0.05 * allowed:
        half = _rounded(half / 2)
    return "period", f"write 'period: {seconds(half)}' and 'response_time: {seconds(half)}' or less"


def fastest_of(program: Program, reach: Mapping[str, tuple[float, float]]) -> Fastest:
    """The largest eigenvalue of the field where it feeds back, over its domain.

    Over the states that are sensed as well as driven; controls where they may `reach` (in
    the architecture). Sampled at points that do not depend on anything but the program.
    """
    back = _fed_back(program)
    if not back:
        return Fastest(0.0, {})
    flow = flow_of(program) if program.field.terms else flow_of(program, Source.FORMULA)
    x, u = _points(program, reach)
    with np.errstate(all="ignore"):
        slopes = jacobian(in_one_mode(flow), x, u)[:, back][:, :, back]
    known = np.all(np.isfinite(slopes), axis=(1, 2))
    if not known.any():
        return Fastest(0.0, {})
    rates = np.max(np.abs(np.linalg.eigvals(slopes[known])), axis=1)
    place = int(np.argmax(rates))
    names = [program.states[i].name for i in back]
    where = x[known][place][back]
    found = dict(zip(names, map(float, where), strict=True))
    return Fastest(float(rates[place]), found)


def _points(program: Program, reach: Mapping[str, tuple[float, float]]) -> tuple[Array, Array]:
    """States (N, n) and controls (N, p) all over their domains, corners of the controls too."""
    random = np.random.Generator(np.random.Philox(SEED))
    states = np.column_stack(
        [
            random.integers(0, len(s.values), POINTS).astype(np.float64)
            if s.kind is Kind.DISCRETE
            else random.uniform(s.low, s.high, POINTS)
            for s in program.states
        ]
    )
    columns = []
    for control in program.controls:
        low, high = reach.get(control.name, (control.low, control.high))
        columns.append(random.uniform(low, high, POINTS) if low < high else np.full(POINTS, low))
    controls = np.column_stack(columns) if columns else np.empty((POINTS, 0))
    return states, controls


def reach_of(
    part: Part,
    inputs: Mapping[str, tuple[Input, ...]],
    choices: Mapping[str, tuple[Choice, ...]],
    parts: Parts,
) -> dict[str, tuple[float, float]]:
    """For each control of a node where its values lie: set once, by a choice, or by a signal."""
    sets = [
        (one.entry, one.value)
        for many in choices.values()
        for choice in many
        for one in choice.sets
        if one.node == parts.index(part.name)
    ]
    entries = {entry.name: entry for entry in part.controls}
    found = {}
    for wire in inputs[part.name]:
        entry = entries.get(wire.entry)
        if entry is not None and wire.signal < 0:
            values = [wire.value, *(value for name, value in sets if name == wire.entry)]
            found[wire.entry] = (min(values), max(values))
        elif entry is not None:
            found[wire.entry] = (entry.low, entry.high)
    return found


def _rounded(value: float) -> float:
    """A time that is easy to write and to share a step with, rounded down."""
    power = 10.0 ** math.floor(math.log10(value) + 1e-9)
    return max(n for n in ROUND if n <= value / power + 1e-9) * power
