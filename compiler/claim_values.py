"""The conditions of a claim as numbers in SI, and as code of controls and constants."""

import re
from typing import Final, final

from compiler.declare import Declarations
from compiler.findings import Findings
from compiler.lower_parts import code_of
from compiler.quantities import SECOND, si_limit, si_value
from compiler.scope import Scope, checked, scope_of
from runtime.claim import Place, Reach, Span
from runtime.code import Code
from runtime.program import Control, Kind, State
from spec_schema.behavior import BehaviorSpec
from spec_schema.expect import ALL, ClaimOptions
from spec_schema.expressions.evaluate import evaluate
from spec_schema.expressions.parse import parse
from spec_schema.expressions.rewrite import names_in
from spec_schema.expressions.tree import Expr, Number
from spec_schema.faults import ExpressionError, UnitFault
from spec_schema.places import Path
from spec_schema.suggest import did_you_mean, there_are
from spec_schema.units import Unit, quantity_in

PLACE_WITHIN: Final = 0.01
"""The share of a state's domain that a place may be off where the claim does not say."""

PERIOD: Final = "period"
"""The key of a `within` that speaks of the period."""

_PERCENT: Final = re.compile(r"\s*(\d{1,3}(?:\.\d{1,12})?)\s*%\s*")
_HELP: Final = "write a share, `within: 2 %`, or one for each name: `within: {x: 0.01 m}`"


@final
class ClaimReader:
    """Reads the conditions of one claim; what can't be read becomes a finding."""

    def __init__(
        self, spec: BehaviorSpec, declared: Declarations, findings: Findings, path: Path
    ) -> None:
        self._declared = declared
        self._findings = findings
        self._path = path
        self._states = {state.name: state for state in declared.states}
        self._controls = {control.name: control for control in declared.controls}
        self._moving = [
            state.name
            for state in declared.states
            if state.kind is not Kind.DISCRETE
            and (state.is_driven or spec.state[state.name].closure is not None)
        ]
        everything = scope_of(declared)
        given = {n: d for n, d in everything.dimensions.items() if n not in self._states}
        self._scope = Scope(given, {})

    def places(self, options: ClaimOptions) -> tuple[Place, ...]:
        """Where the features are."""
        found = []
        for name, value in options.at.items():
            path: Path = (*self._path, "at", name)
            state = self._axis(name, path, options)
            if state is None:
                continue
            code = self._value(value, self._unit(name), path, f"the place of '{name}'")
            if code is not None:
                self._check_inside(state, code, path)
                found.append(Place(name, code, self._room(state, options)))
        self._check_within(options)
        return tuple(found)

    def reaches(self, options: ClaimOptions) -> tuple[Reach, ...]:
        """How far the cycles swing."""
        found = []
        for name, limits in options.reaches.items():
            path: Path = (*self._path, "reaches", name)
            state = self._axis(name, path, options)
            if state is None:
                continue
            low, high = (
                self._value(value, self._unit(name), (*path, i), f"the reach of '{name}'")
                for i, value in enumerate(limits)
            )
            if low is not None and high is not None:
                found.append(Reach(name, low, high, self._room(state, options)))
        return tuple(found)

    def period(self, options: ClaimOptions) -> Code | None:
        """How long the cycles take."""
        if options.period is None:
            return None
        return self._value(options.period, SECOND, (*self._path, "period"), "the period")

    def period_within(self, options: ClaimOptions, default: float) -> float:
        """The share that the period may be off."""
        given = options.within.root if options.within else {}
        key = PERIOD if PERIOD in given else ALL
        if options.period is None or key not in given:
            return default
        return self._share(given[key], self._within_path(key)) or default

    def over(self, options: ClaimOptions) -> tuple[Span, ...]:
        """The controls that take all values."""
        found = []
        for name, limits in (options.over.root if options.over else {}).items():
            path: Path = (*self._path, "over", name)
            control = self._controls.get(name)
            if control is None:
                self._unknown(name, path, list(self._controls), "control")
                continue
            if limits is None:
                found.append(Span(name, control.low, control.high))
                continue
            unit = self._unit(name)
            ends = [si_limit(v, unit, (*path, i), self._findings) for i, v in enumerate(limits)]
            if ends[0] is not None and ends[1] is not None:
                found.append(self._span(control, ends[0], ends[1], path))
        return tuple(found)

    def settings(self, options: ClaimOptions) -> tuple[tuple[str, float], ...]:
        """The controls and states that are held at a value."""
        found = []
        for name, value in options.where.items():
            path: Path = (*self._path, "where", name)
            part = self._controls.get(name) or self._states.get(name)
            if part is None:
                self._unknown(name, path, [*self._controls, *self._states], "control or state")
                continue
            if options.over is not None and name in options.over.root:
                message = f"'{name}' takes all values by 'over', and one by 'where'"
                self._findings.error("S273", path, message, "remove one of them", key=True)
            held = self._held(part, value, path)
            if held is not None:
                found.append((name, held))
        return tuple(found)

    def _held(self, part: State | Control, value: float | str, path: Path) -> float | None:
        if isinstance(part, State) and part.kind is Kind.DISCRETE:
            if value in part.values:
                return float(part.values.index(str(value)))
            message = f"'{part.name}' has no value '{value}'"
            remedy = did_you_mean(str(value), part.values) or f"one of {', '.join(part.values)}"
            self._findings.error("S275", path, message, remedy)
            return None
        held = si_value(value, self._unit(part.name), path, self._findings)
        if held is not None and not part.low <= held <= part.high:
            self._outside(part, f"{value}", path)
            return None
        return held

    def _span(self, control: Control, low: float, high: float, path: Path) -> Span:
        slack = 1e-9 * (control.high - control.low)
        if not low < high:
            message = f"the interval of '{control.name}' has no width"
            self._findings.error("S275", path, message, "write [low, high]")
        elif low < control.low - slack or high > control.high + slack:
            self._outside(control, "the interval", path)
        return Span(control.name, max(low, control.low), min(high, control.high))

    def _outside(self, part: State | Control, what: str, path: Path) -> None:
        scale, text = part.unit.scale, part.unit.text
        domain = f"[{part.low / scale:g}, {part.high / scale:g}] {text}"
        message = f"{what} is outside the domain of '{part.name}', {domain}"
        self._findings.error("S275", path, message, "move one of them")

    def _check_inside(self, state: State, code: Code, path: Path) -> None:
        """A place that is known already must be one that the field is known at."""
        tokens = code.tokens
        if len(tokens) > 1 or tokens[0] in self._scope.dimensions or state.kind is Kind.PERIODIC:
            return
        if not state.low <= float(tokens[0]) <= state.high:
            self._outside(state, "this place", path)

    def _axis(self, name: str, path: Path, options: ClaimOptions) -> State | None:
        """The state that a feature has a place in; None, and a finding, where there is none."""
        if name in self._moving and name not in options.where:
            return self._states[name]
        if name in self._states:
            why = "is held" if name in options.where else "does not move by itself"
            message = f"'{name}' {why}, so nothing has a place along it"
            self._findings.error("S275", path, message, "remove it", key=True)
            return None
        self._unknown(name, path, self._moving, "state")
        return None

    def _unknown(self, name: str, path: Path, known: list[str], what: str) -> None:
        remedy = did_you_mean(name, known) or (
            there_are(known) if known else f"this behavior has no {what}"
        )
        if what == "control" and name in self._states:
            remedy = f"'{name}' is a state: a claim ranges over controls"
        self._findings.error("S275", path, f"no {what} is named '{name}'", remedy, key=True)

    def _unit(self, name: str) -> Unit | None:
        return self._declared.units.get(name)

    def _value(self, value: float | str, unit: Unit | None, path: Path, what: str) -> Code | None:
        """A number in `unit`, a quantity, or an expression of controls and constants."""
        if unit is None:
            return None  # its unit could not be read, and was told
        if not isinstance(value, str):
            return code_of(Number(value * unit.scale))
        expr = _parsed(value)
        if expr is None:
            return self._quantity(value, unit, path)
        if not names_in(expr):
            return code_of(Number(evaluate(expr, {}) * unit.scale))
        moved = sorted(names_in(expr) & self._states.keys())
        if moved:
            message = f"{what} can't depend on '{moved[0]}', which is a state"
            remedy = "write it with controls and constants"
            self._findings.error("S276", path, message, remedy)
            return None
        wanted = None if unit is SECOND and self._is_plain() else unit
        found = checked(value, path, self._scope, wanted, what, self._findings)
        return None if found is None else code_of(found)

    def _quantity(self, value: str, unit: Unit, path: Path) -> Code | None:
        """What is no expression is a quantity, or else whatever it looks more like is explained."""
        try:
            return code_of(Number(quantity_in(value, unit)))
        except UnitFault as error:
            if value.strip()[:1].isdigit():
                self._findings.fault(path, error.fault)
            else:
                checked(value, path, self._scope, None, "", self._findings)
            return None

    def _is_plain(self) -> bool:
        """Whether all states are plain numbers, so that no unit of time is asked for."""
        units = (self._unit(name) for name in self._declared.continuous)
        return all(unit is None or unit.text == "1" for unit in units)

    def _room(self, state: State, options: ClaimOptions) -> float:
        """How far a place may be off in this state, SI."""
        width = state.high - state.low
        given = options.within.root if options.within else {}
        key = state.name if state.name in given else ALL
        if key not in given:
            return PLACE_WITHIN * width
        path, value = self._within_path(key), given[key]
        if key == ALL or (isinstance(value, str) and _PERCENT.fullmatch(value)):
            return (self._share(value, path) or PLACE_WITHIN) * width
        room = si_value(value, self._unit(state.name), path, self._findings)
        if room is not None and room <= 0.0:
            self._findings.error("S277", path, f"'within' must be positive (got {value})", _HELP)
        return room or PLACE_WITHIN * width

    def _within_path(self, key: str) -> Path:
        return (*self._path, "within", *([key] if key != ALL else []))

    def _share(self, value: float | str, path: Path) -> float | None:
        found = _PERCENT.fullmatch(value) if isinstance(value, str) else None
        if found is None:
            message = f"expected a share in %, got {value}"
        elif not 0.0 < float(found[1]) <= 100.0:
            message = f"a share is above 0 and at most 100 % (got {value})"
        else:
            return float(found[1]) / 100.0
        self._findings.error("S277", path, message, _HELP)
        return None

    def _check_within(self, options: ClaimOptions) -> None:
        known = [*options.at, *options.reaches, *([PERIOD] if options.period is not None else [])]
        for name in options.within.root if options.within else ():
            if name != ALL and name not in known and known:
                remedy = did_you_mean(name, known) or there_are(known)
                message = f"this claim gives no value for '{name}'"
                path: Path = (*self._path, "within", name)
                self._findings.error("S277", path, message, remedy, key=True)


def _parsed(text: str) -> Expr | None:
    try:
        return parse(text)
    except ExpressionError:
        return None
