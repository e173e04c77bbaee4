"""What can be told of bodies, arbiters, architectures, worlds and scenarios without running any."""

from typing import TypeAlias

from compiler.architecture.arbiters import CompiledArbiter, lower_arbiter
from compiler.architecture.bodies import lower_body
from compiler.architecture.library import Library
from compiler.architecture.passes import CompiledArchitecture, compile_parts
from compiler.findings import Findings
from compiler.world.scenario_passes import CompiledScenario, compile_parts_of_scenario
from compiler.world.world import lower_world
from spec_schema.arbiter import ArbiterSpec
from spec_schema.architecture import ArchitectureSpec
from spec_schema.body import BodySpec
from spec_schema.diagnostics import Diagnostic
from spec_schema.load import Loaded
from spec_schema.scenario import ScenarioSpec
from spec_schema.world import WorldSpec

Wired: TypeAlias = CompiledArchitecture | CompiledScenario | CompiledArbiter
"""What is known of an architecture, scenario or arbiter without tables; it can't be run."""


def check_kind(loaded: Loaded) -> tuple[tuple[Diagnostic, ...], Wired | None]:
    """Every mistake in a spec that is no behavior, and in the files that it names.

    And of an architecture, scenario or arbiter what it is, where all of it is sound.
    """
    findings, library = Findings(loaded), Library()
    made: Wired | None = None
    match loaded.spec:
        case BodySpec() as spec:
            lower_body(spec, loaded, findings)
        case ArbiterSpec() as spec:
            made = CompiledArbiter(lower_arbiter(spec, loaded, library, findings), ())
        case ArchitectureSpec() as spec:
            made = compile_parts(spec, loaded, library, findings)
        case WorldSpec() as spec:
            lower_world(spec, loaded, findings)
        case ScenarioSpec() as spec:
            made = compile_parts_of_scenario(spec, loaded, library, findings)
    found = (*findings.diagnostics, *library.mistakes, *library.doubts)
    return found, made if not library.mistakes else None
