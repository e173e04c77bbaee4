"""Pass 1: what is declared. Units, domains, defaults and names, as numbers in SI."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import final

from compiler.findings import Findings
from compiler.quantities import si_limit, si_value, unit_of
from runtime.program import Constant, Control, Kind, Role, State
from runtime.program import Unit as ProgramUnit
from spec_schema.behavior import BehaviorSpec
from spec_schema.load import Loaded
from spec_schema.places import Path
from spec_schema.units import Unit
from spec_schema.variables import ConstantSpec, ControlSpec, StateSpec

NO_UNIT = ProgramUnit("1", 1.0)


@final
@dataclass(frozen=True, slots=True)
class Declarations:
    """The declared parts, and what the later passes ask about names.

    units: of every name whose unit could be read (discrete states have none).
    values: the values of every discrete state.
    """

    states: tuple[State, ...]
    controls: tuple[Control, ...]
    constants: tuple[Constant, ...]
    units: Mapping[str, Unit]
    values: Mapping[str, tuple[str, ...]]

    @property
    def register(self) -> tuple[str, ...]:
        """Every name that code may read, in the order of the register."""
        constants = [constant.name for constant in self.constants]
        return (*(variable.name for variable in self.variables), *constants)

    @property
    def variables(self) -> tuple[State | Control, ...]:
        """States and controls: everything that an axis of a table may stand for."""
        return (*self.states, *self.controls)

    def variable(self, name: str) -> State | Control:
        """The state or control of that name."""
        return next(variable for variable in self.variables if variable.name == name)

    @property
    def driven(self) -> tuple[State, ...]:
        """The states that the field gives a rate; the one whose values are its modes has none."""
        return tuple(s for s in self.states if s.is_driven and s.kind is not Kind.DISCRETE)

    @property
    def continuous(self) -> frozenset[str]:
        """The names of the states that are not discrete."""
        return frozenset(s.name for s in self.states if s.kind is not Kind.DISCRETE)


def declare(spec: BehaviorSpec, loaded: Loaded, findings: Findings) -> Declarations:
    """Every declaration that can be read, and a finding for each that can't."""
    _refuse_repeated_names(spec, findings)
    units = _units(spec, findings)
    states = tuple(
        _state(name, state, units.get(name), loaded, findings) for name, state in spec.state.items()
    )
    controls = tuple(
        control_of(name, control, units.get(name), loaded, findings)
        for name, control in spec.control.items()
    )
    constants = tuple(
        constant_of(name, constant, units.get(name), loaded, findings)
        for name, constant in spec.constants.items()
    )
    values = {name: state.values for name, state in spec.state.items() if state.values}
    return Declarations(states, controls, constants, units, values)


def program_unit(unit: Unit | None) -> ProgramUnit:
    """The unit as a program carries it."""
    return NO_UNIT if unit is None else ProgramUnit(unit.text, unit.scale)


def _refuse_repeated_names(spec: BehaviorSpec, findings: Findings) -> None:
    seen: dict[str, str] = {}
    sections: tuple[tuple[str, Mapping[str, object]], ...] = (
        ("state", spec.state),
        ("control", spec.control),
        ("constants", spec.constants),
        ("output", spec.output),
    )
    for section, names in sections:
        for name in names:
            if name in seen:
                message = f"'{name}' is declared twice: here and under '{seen[name]}'"
                findings.error("S201", (section, name), message, "rename one of them", key=True)
            seen.setdefault(name, section)


def _units(spec: BehaviorSpec, findings: Findings) -> dict[str, Unit]:
    found: dict[str, Unit | None] = {}
    for name, state in spec.state.items():
        found[name] = unit_of(state.unit, ("state", name, "unit"), findings)
    for name, control in spec.control.items():
        found[name] = unit_of(control.unit, ("control", name, "unit"), findings)
    for name, constant in spec.constants.items():
        found[name] = unit_of(constant.unit, ("constants", name, "unit"), findings)
    return {name: unit for name, unit in found.items() if unit is not None}


def limits_of(
    domain: tuple[float | str, float | str] | None,
    unit: Unit | None,
    path: Path,
    findings: Findings,
) -> tuple[float, float]:
    """Both limits in SI; [0, 1] where they can't be told, so that the passes may go on."""
    if domain is None:
        return 0.0, 1.0
    low, high = (si_limit(v, unit, (*path, i), findings) for i, v in enumerate(domain))
    if low is None or high is None:
        return 0.0, 1.0
    if not (math.isfinite(low) and math.isfinite(high)):
        findings.error("S202", path, "a domain has finite limits", "write two numbers: [-2, 2]")
        return 0.0, 1.0
    if not low < high:
        message = f"the lower limit {domain[0]} is not below the upper limit {domain[1]}"
        findings.error("S202", path, message, f"write [{domain[1]}, {domain[0]}]")
        return 0.0, 1.0
    return low, high


def _state(
    name: str, spec: StateSpec, unit: Unit | None, loaded: Loaded, findings: Findings
) -> State:
    path: Path = ("state", name)
    if spec.kind == "discrete":
        values = spec.values or ()
        low, high = 0.0, float(max(len(values) - 1, 0))
        hold = float(values.index(spec.hold)) if spec.hold in values else 0.0
    else:
        low, high = limits_of(spec.domain, unit, (*path, "domain"), findings)
        hold = inside(spec.hold, (low, high), unit, (*path, "hold"), findings)
    return State(
        name=name,
        unit=program_unit(unit),
        low=low,
        high=high,
        role=Role(spec.role),
        kind=Kind(spec.kind),
        hold=hold,
        closure=None,
        values=spec.values or (),
        relates=(spec.relates.agent, spec.relates.environment),
        about=spec.about or "",
        origin=loaded.origin(path),
    )


def inside(
    value: float | str | None,
    limits: tuple[float, float],
    unit: Unit | None,
    path: Path,
    findings: Findings,
) -> float:
    """A value in SI that must lie in its domain; the middle of it where none is given."""
    low, high = limits
    middle = (low + high) / 2
    if value is None:
        return middle
    found = si_value(value, unit, path, findings)
    if found is None:
        return middle
    if not low <= found <= high:
        shown = f"[{_in(low, unit)}, {_in(high, unit)}]"
        message = f"{value} is outside the domain {shown}"
        findings.error("S203", path, message, "move one of them")
        return middle
    return found


def _in(value: float, unit: Unit | None) -> str:
    return f"{value / unit.scale:g} {unit.text}" if unit else f"{value:g}"


def control_of(
    name: str, control: ControlSpec, unit: Unit | None, loaded: Loaded, findings: Findings
) -> Control:
    """A control parameter in SI."""
    path: Path = ("control", name)
    low, high = limits_of(control.domain, unit, (*path, "domain"), findings)
    default = inside(control.default, (low, high), unit, (*path, "default"), findings)
    about = control.about or ""
    return Control(name, program_unit(unit), low, high, default, about, loaded.origin(path))


def constant_of(
    name: str, constant: ConstantSpec, unit: Unit | None, loaded: Loaded, findings: Findings
) -> Constant:
    """A constant in SI."""
    path: Path = ("constants", name)
    value = si_value(constant.value, unit, (*path, "value"), findings)
    about = constant.about or ""
    return Constant(name, program_unit(unit), value or 0.0, about, loaded.origin(path))
