"""Arbiters in SI: what they read, may choose and how they decide, with every mistake told."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path as FilePath
from typing import Final, final

from compiler.architecture.library import Library
from compiler.architecture.paradigms import Decided, decided
from compiler.declare import NO_UNIT, Declarations, constant_of, control_of, limits_of, program_unit
from compiler.findings import Findings
from compiler.lower_parts import code_of, lower_bindings, lower_outputs
from compiler.lower_parts import origin_of as source_of
from compiler.quantities import unit_of
from compiler.read_expressions import read_outputs, with_signals
from compiler.references import check_trace
from compiler.scope import Scope, read, scope_of
from runtime.arbiter import Agreement, Arbiter, Read
from runtime.program import Kind, Role, State
from spec_schema.arbiter import ArbiterSpec, ReadSpec
from spec_schema.diagnostics import Diagnostic, Severity, SpecError
from spec_schema.load import Loaded, examine
from spec_schema.units import Unit
from spec_schema.variables import ConstantSpec, ControlSpec
from spec_schema.wording import with_article

DECLARING: Final = ("reads", "control", "constants", "output")
"""The sections of an arbiter that declare names."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class CompiledArbiter:
    """An arbiter, and the warnings on the way to it."""

    arbiter: Arbiter
    warnings: tuple[Diagnostic, ...]
    notes: tuple[str, ...] = ()


def compile_arbiter(path: FilePath | str, library: Library | None = None) -> CompiledArbiter:
    """Compile the arbiter spec at `path`; its plan by the library's own compiler.

    Raises:
        SpecError: with everything that is wrong with it.
    """
    examined = examine(FilePath(path), "arbiter")
    loaded, library = examined.loaded, library or Library()
    if loaded is None or not isinstance(loaded.spec, ArbiterSpec):
        raise SpecError(examined.mistakes or [_no_arbiter(loaded)])
    findings = Findings(loaded)
    arbiter = lower_arbiter(loaded.spec, loaded, library, findings)
    found = (*examined.mistakes, *findings.diagnostics, *library.mistakes)
    if any(one.severity is Severity.ERROR for one in found):
        raise SpecError(found)
    return CompiledArbiter(arbiter, findings.diagnostics, findings.notes)


def _no_arbiter(loaded: Loaded | None) -> Diagnostic:
    assert loaded is not None, "what could not be read has mistakes"
    message = f"{with_article(loaded.spec.kind)} is no arbiter"
    return loaded.error("S200", ("kind",), message, "name an arbiter spec")


def lower_arbiter(
    spec: ArbiterSpec, loaded: Loaded, library: Library, findings: Findings
) -> Arbiter:
    """The arbiter in SI, with a finding for each mistake."""
    _refuse_repeated_names(spec, findings)
    declared = _declared(spec, loaded, findings)
    scope = scope_of(declared)
    outputs = read_outputs(spec, scope, findings)
    check_trace(spec, declared, findings)
    paradigm = decided(spec, declared, loaded, library, findings)
    agreement = Agreement(spec.agreement.share, loaded.origin(("agreement",)))
    judged = spec.judge_when
    judge_when = None
    if judged is not None:
        judge_when = read(judged, ("judge_when",), _wider(spec, scope, findings), findings)
    return Arbiter(
        name=spec.name,
        about=spec.about or "",
        reads=tuple(_read(name, spec.reads[name], declared, loaded) for name in spec.reads),
        controls=declared.controls,
        constants=declared.constants,
        outputs=lower_outputs(spec, outputs, loaded),
        choices=paradigm.choices,
        paradigm=paradigm.paradigm,
        rules=paradigm.rules,
        weights=paradigm.weights,
        competition=paradigm.competition,
        plan=paradigm.plan,
        module=spec.by.module or "",
        agreement=agreement,
        bindings=lower_bindings(spec, _with_choice(declared, paradigm), loaded, findings),
        judge_when=None if judge_when is None else code_of(judge_when),
        source=source_of(loaded),
        learner=paradigm.learner,
    )


def _refuse_repeated_names(spec: ArbiterSpec, findings: Findings) -> None:
    seen: dict[str, str] = {}
    for section in DECLARING:
        for name in getattr(spec, section):
            if name in seen:
                message = f"'{name}' is declared twice: here and under '{seen[name]}'"
                findings.error("S201", (section, name), message, "rename one of them", key=True)
            seen.setdefault(name, section)


def _declared(spec: ArbiterSpec, loaded: Loaded, findings: Findings) -> Declarations:
    """Reads as sensed states, with controls and constants, as expressions see them."""
    units: dict[str, Unit | None] = {}
    sections: tuple[tuple[str, Mapping[str, ReadSpec | ControlSpec | ConstantSpec]], ...] = (
        ("reads", spec.reads),
        ("control", spec.control),
        ("constants", spec.constants),
    )
    for section, named in sections:
        for name, part in named.items():
            units[name] = unit_of(part.unit, (section, name, "unit"), findings)
    return Declarations(
        tuple(_state(name, one, units[name], loaded, findings) for name, one in spec.reads.items()),
        tuple(
            control_of(name, one, units[name], loaded, findings)
            for name, one in spec.control.items()
        ),
        tuple(
            constant_of(name, one, units[name], loaded, findings)
            for name, one in spec.constants.items()
        ),
        {name: unit for name, unit in units.items() if unit is not None},
        {name: one.values for name, one in spec.reads.items() if one.values},
    )


def _state(
    name: str, spec: ReadSpec, unit: Unit | None, loaded: Loaded, findings: Findings
) -> State:
    path = ("reads", name)
    if spec.values is not None:
        low, high = 0.0, float(len(spec.values) - 1)
    else:
        low, high = limits_of(spec.domain, unit, (*path, "domain"), findings)
    return State(
        name=name,
        unit=NO_UNIT if unit is None else program_unit(unit),
        low=low,
        high=high,
        role=Role.SENSED,
        kind=Kind(spec.kind),
        hold=low,
        closure=None,
        values=spec.values or (),
        relates=("", ""),
        about=spec.about or "",
        origin=loaded.origin(path),
    )


def _read(name: str, spec: ReadSpec, declared: Declarations, loaded: Loaded) -> Read:
    state = declared.variable(name)
    return Read(
        name,
        state.unit,
        state.low,
        state.high,
        Kind(spec.kind),
        spec.values or (),
        spec.about or "",
        loaded.origin(("reads", name)),
    )


def _wider(spec: ArbiterSpec, scope: Scope, findings: Findings) -> Scope:
    return with_signals(spec, scope, findings)


def _with_choice(declared: Declarations, decided: Decided) -> Declarations:
    """With `choice` as a discrete name, so that a log may hold it."""
    return replace(declared, values={**declared.values, "choice": decided.choices})
