"""What can be told of a spec without tabulating it and without running anything of the author's."""

from dataclasses import dataclass
from pathlib import Path
from typing import final

from compiler.declare import Declarations, declare
from compiler.findings import Findings
from compiler.lower_parts import (
    lower_bindings,
    lower_fidelity,
)
from compiler.read_expressions import Expressions, read_expressions
from compiler.references import check_references
from runtime.program import Binding, Fidelity
from spec_schema.behavior import BehaviorSpec
from spec_schema.diagnostics import Diagnostic, SpecError
from spec_schema.load import Loaded, load


@final
@dataclass(frozen=True, slots=True)
class Checked:
    """A behavior that has been through the static passes; `findings` may hold errors."""

    loaded: Loaded
    spec: BehaviorSpec
    declared: Declarations
    expressions: Expressions
    fidelity: Fidelity | None
    bindings: tuple[Binding, ...]
    findings: Findings


def check(path: Path) -> tuple[Diagnostic, ...]:
    """Every mistake in the spec at `path`, and every doubt."""
    try:
        loaded = load(path)
    except SpecError as error:
        return error.diagnostics
    if not isinstance(loaded.spec, BehaviorSpec):
        return ()
    return check_behavior(loaded, loaded.spec).findings.diagnostics


def check_behavior(loaded: Loaded, spec: BehaviorSpec) -> Checked:
    """The static passes, in order; each adds to the findings and lets the next go on."""
    findings = Findings(loaded)
    declared = declare(spec, loaded, findings)
    expressions = read_expressions(spec, declared, findings)
    fidelity = lower_fidelity(spec, declared, loaded, findings)
    bindings = lower_bindings(spec, declared, loaded, findings)
    check_references(spec, declared, expressions, findings)
    return Checked(loaded, spec, declared, expressions, fidelity, bindings, findings)
