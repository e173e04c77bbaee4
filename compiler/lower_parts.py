"""Pass 4: what the spec says beside the field, in the program's terms: SI numbers and code."""

import hashlib
from collections.abc import Mapping
from dataclasses import replace

from compiler.declare import Declarations, program_unit
from compiler.findings import Findings
from compiler.quantities import ONE, SECOND, si_limit, si_value, unit_of
from compiler.read_expressions import Expressions
from compiler.read_modes import Way
from runtime.code import Code
from runtime.program import (
    Binding,
    Feasibility,
    Fidelity,
    Guard,
    Origin,
    Output,
    Realization,
    State,
    Unit,
)
from spec_schema.arbiter import ArbiterSpec
from spec_schema.behavior import BehaviorSpec
from spec_schema.dimension import describe
from spec_schema.expressions.printers.postfix import to_postfix
from spec_schema.expressions.tree import Expr
from spec_schema.load import Loaded
from spec_schema.places import Path
from spec_schema.trace_mapping import TraceEntry
from spec_schema.units import Unit as SpecUnit
from spec_schema.units import parse_unit
from spec_schema.wording import number


def code_of(expr: Expr) -> Code:
    """The expression as the machine runs it."""
    return Code(to_postfix(expr))


def lower_states(declared: Declarations, closures: Mapping[str, Expr]) -> tuple[State, ...]:
    """The states with their closures."""
    return tuple(
        replace(state, closure=code_of(closures[state.name])) if state.name in closures else state
        for state in declared.states
    )


def lower_outputs(
    spec: BehaviorSpec | ArbiterSpec, outputs: Mapping[str, Expr], loaded: Loaded
) -> tuple[Output, ...]:
    """The output parameters."""
    return tuple(
        Output(
            name=name,
            unit=program_unit(parse_unit(spec.output[name].unit)),
            code=code_of(expr),
            about=spec.output[name].about or "",
            origin=loaded.origin(("output", name)),
        )
        for name, expr in outputs.items()
    )


def lower_fidelity(
    spec: BehaviorSpec, declared: Declarations, loaded: Loaded, findings: Findings
) -> Fidelity | None:
    """Tolerances, horizon and region in SI."""
    if spec.fidelity is None:
        return None
    base: Path = ("fidelity",)
    tolerance = {
        name: _positive(value, declared.units.get(name), (*base, "tolerance", name), findings)
        for name, value in spec.fidelity.tolerance.items()
    }
    scatter = {
        name: _positive(value, declared.units.get(name), (*base, "scatter", name), findings)
        for name, value in spec.fidelity.scatter.items()
    }
    horizon = _positive(spec.fidelity.horizon, SECOND, (*base, "horizon"), findings)
    region = {}
    variables = {variable.name for variable in declared.variables}
    for name, limits in spec.fidelity.region.items():
        if name not in variables:
            continue  # told with the other references
        path = (*base, "region", name)
        pair = [
            si_limit(v, declared.units.get(name), (*path, i), findings)
            for i, v in enumerate(limits)
        ]
        if pair[0] is not None and pair[1] is not None:
            region[name] = _part_of_domain(name, (pair[0], pair[1]), declared, path, findings)
    coverage = spec.fidelity.coverage
    return Fidelity(tolerance, horizon, region, coverage, loaded.origin(base), scatter)


def _positive(value: float | str, unit: SpecUnit | None, path: Path, findings: Findings) -> float:
    found = si_value(value, unit, path, findings)
    if found is not None and unit is not None and found <= 0.0:
        shown = value if isinstance(value, str) else number(value)
        message = f"the {path[1]}{_of(path)} must be positive (got {shown})"
        suffix = "" if unit.text == "1" else f", in {unit.text}"
        findings.error("S212", path, message, f"write a number above 0{suffix}")
    return found or 1.0


def _of(path: Path) -> str:
    return f" of '{path[2]}'" if len(path) > 2 else ""


def _part_of_domain(
    name: str, limits: tuple[float, float], declared: Declarations, path: Path, findings: Findings
) -> tuple[float, float]:
    low, high = limits
    part = declared.variable(name)
    slack = 1e-9 * (part.high - part.low)
    if not low < high:
        findings.error("S202", path, f"the region of '{name}' has no width", "write [low, high]")
    elif low < part.low - slack or high > part.high + slack:
        shown = f"[{part.low / part.unit.scale:g}, {part.high / part.unit.scale:g}]"
        message = f"the region of '{name}' reaches beyond its domain {shown}"
        findings.error(
            "S203",
            path,
            message,
            "the field is not known there: widen the domain or shrink the region",
        )
    return low, high


def lower_bindings(
    spec: BehaviorSpec | ArbiterSpec, declared: Declarations, loaded: Loaded, findings: Findings
) -> tuple[Binding, ...]:
    """Where each variable and each signal stands in a log."""
    skipped = {*spec.output, *spec.constants}
    return tuple(
        _binding(name, entry, declared, loaded, findings)
        for name, entry in spec.trace.items()
        if name not in skipped
    )


def _binding(
    name: str, entry: TraceEntry, declared: Declarations, loaded: Loaded, findings: Findings
) -> Binding:
    path: Path = ("trace", name)
    own = declared.units.get(name)
    constant = None
    if entry.constant is not None:
        constant = _constant(name, entry.constant, declared, (*path, "constant"), findings)
    return Binding(
        name=name,
        path=entry.path or "",
        unit=_logged_unit(name, entry, own, findings),
        delay=si_value(entry.delay, SECOND, (*path, "delay"), findings) or 0.0,
        scale=entry.scale,
        offset=_offset(entry, own, (*path, "offset"), findings),
        constant=constant,
        values=_values(name, entry, declared),
        noise=_noise(entry, own, (*path, "noise"), findings),
        origin=loaded.origin(path),
    )


def _noise(
    entry: TraceEntry, unit: SpecUnit | None, path: Path, findings: Findings
) -> float | None:
    if entry.noise is None:
        return None
    found = si_value(entry.noise, unit, path, findings)
    if found is not None and found <= 0.0:
        message = f"the noise of '{path[1]}' must be positive (got {entry.noise})"
        findings.error("S212", path, message, "leave it out to have it estimated")
    return found


def _constant(
    name: str, value: float | str, declared: Declarations, path: Path, findings: Findings
) -> float | None:
    values = declared.values.get(name)
    if values is None:
        found = si_value(value, declared.units.get(name), path, findings)
        return _in_domain(name, found, declared, path, findings)
    if value in values:
        return float(values.index(str(value)))
    findings.error(
        "S210", path, f"'{name}' has no value '{value}'", f"its values: {', '.join(values)}"
    )
    return None


def _in_domain(
    name: str, value: float | None, declared: Declarations, path: Path, findings: Findings
) -> float | None:
    """The value, with a finding where it lies outside the domain of its variable."""
    named = [variable for variable in declared.variables if variable.name == name]
    for variable in named:
        if value is not None and not variable.low <= value <= variable.high:
            scale = variable.unit.scale
            limits = f"[{variable.low / scale:g}, {variable.high / scale:g}]"
            message = f"{value / scale:g} is outside the domain {limits}"
            findings.error("S203", path, message, "move one of them")
    return value


def _offset(entry: TraceEntry, own: SpecUnit | None, path: Path, findings: Findings) -> float:
    """The offset in SI: in the variable's unit, of a signal in the unit of its entry."""
    if entry.offset == 0.0:
        return 0.0
    unit = own or (ONE if entry.unit is None else unit_of(entry.unit, path, findings))
    return si_value(entry.offset, unit, path, findings) or 0.0


def _logged_unit(name: str, entry: TraceEntry, own: SpecUnit | None, findings: Findings) -> Unit:
    """The unit of the logged number: as given, else SI in messages, else the variable's own.

    Messages follow REP-103 (SI); the columns of a CSV file are the user's own.
    """
    given = unit_of(entry.unit, ("trace", name, "unit"), findings)
    if given is None:
        if own is None:
            return Unit("1", 1.0)
        in_message = (entry.path or "").startswith("/")
        return Unit(describe(own.dimension), 1.0) if in_message else program_unit(own)
    if own is not None and given.dimension != own.dimension:
        findings.error(
            "S213",
            ("trace", name, "unit"),
            f"'{name}' is in {own.text}, and {given.text} can't be turned into it",
            f"write a unit of the same kind as {own.text}",
        )
    return program_unit(given)


def _values(name: str, entry: TraceEntry, declared: Declarations) -> tuple[tuple[str, int], ...]:
    """Each text that may stand in the log, and the index of the value that it means.

    A value may have several texts: an arbiter's two ways to turn left may be one here.
    """
    meant = declared.values.get(name) or tuple(dict.fromkeys((entry.values or {}).values()))
    if entry.values is None:
        return tuple((value, index) for index, value in enumerate(meant))
    known = [(text, value) for text, value in entry.values.items() if value in meant]
    return tuple((text, meant.index(value)) for text, value in known)


def lower_guards(ways: tuple[Way, ...], loaded: Loaded) -> tuple[Guard, ...]:
    """The ways as the machine takes them."""
    return tuple(
        Guard(
            way.mode,
            way.target,
            code_of(way.condition),
            tuple((name, code_of(expr)) for name, expr in way.resets.items()),
            loaded.origin(way.path),
        )
        for way in ways
    )


def lower_judge_when(expressions: Expressions) -> Code | None:
    """When the robot is judged."""
    return None if expressions.judge_when is None else code_of(expressions.judge_when)


def lower_realizes(spec: BehaviorSpec, loaded: Loaded) -> tuple[Realization, ...]:
    """The channels that the behavior acts on."""
    return tuple(
        Realization(
            name, channel.name, channel.mode, loaded.origin(("realizes", name)), channel.sign
        )
        for name, channel in spec.realizes.items()
    )


def lower_feasibility(spec: BehaviorSpec) -> Feasibility | None:
    """What is known of whether a robot can do this."""
    if spec.feasibility is None:
        return None
    return Feasibility(spec.feasibility.level, spec.feasibility.evidence or "")


def origin_of(loaded: Loaded) -> Origin:
    """The spec's text, and the hash by which recordings know it."""
    text = loaded.source.text
    return Origin(loaded.source.name, text, hashlib.sha256(text.encode()).hexdigest())
