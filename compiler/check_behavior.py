"""The static passes of a behavior: everything that can be told without tabulating it."""

from dataclasses import dataclass
from typing import Final, final

from compiler.check_ways import check_ways
from compiler.claims import lower_claims
from compiler.declare import Declarations, declare
from compiler.findings import Findings
from compiler.finite import check_finite
from compiler.lower_parts import (
    lower_bindings,
    lower_fidelity,
)
from compiler.read_expressions import Expressions, read_expressions
from compiler.read_modes import check_moved_values
from compiler.references import check_references
from compiler.settings import Settings, settings_of
from compiler.sketch.compose import compose
from compiler.sketch.design import Design
from compiler.sketch.drawing import Drawing
from compiler.sketch.frame import SketchRefusedError
from runtime.claim import Claim
from runtime.program import Binding, Fidelity
from spec_schema.behavior import BehaviorSpec
from spec_schema.field_modes import Modes
from spec_schema.load import Loaded

COUNTING: Final = frozenset({"S267"})
"""What is told of all features of a sketch together."""


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
    claims: tuple[Claim, ...]
    settings: Settings
    findings: Findings
    design: Design | None = None


def check_behavior(loaded: Loaded, spec: BehaviorSpec) -> Checked:
    """The static passes, in order; each adds to the findings and lets the next go on."""
    findings = Findings(loaded)
    declared = declare(spec, loaded, findings)
    expressions = read_expressions(spec, declared, findings)
    fidelity = lower_fidelity(spec, declared, loaded, findings)
    bindings = lower_bindings(spec, declared, loaded, findings)
    claims = lower_claims(spec, declared, loaded, findings)
    settings = settings_of(spec, declared, findings)
    check_references(spec, declared, expressions, claims, findings)
    check_moved_values(spec, findings)
    if isinstance(spec.field.form, Modes) and not findings.has_errors:
        check_ways(spec.field.form, expressions.ways, declared, findings)
    if not findings.has_errors:
        check_finite(spec, declared, expressions.rates, findings)
    design = None
    if expressions.drawing is not None and not findings.has_errors:
        design = designed(expressions.drawing, declared, findings)
    return Checked(
        loaded, spec, declared, expressions, fidelity, bindings, claims, settings, findings, design
    )


def designed(drawing: Drawing, declared: Declarations, findings: Findings) -> Design | None:
    """What is to be built from a drawing; None, and a finding, where nothing can look like it."""
    try:
        return compose(drawing, declared)
    except SketchRefusedError as error:
        if error.code in COUNTING and findings.lacks_items(("field", "sketch")):
            return None  # what was refused may be what is missing
        findings.error(error.code, error.path, error.message, error.remedy)
        return None
