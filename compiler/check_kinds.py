"""What can be told of bodies, arbiters, architectures, worlds and scenarios without running any."""

from compiler.architecture.arbiters import lower_arbiter
from compiler.architecture.bodies import lower_body
from compiler.architecture.library import Library
from compiler.architecture.passes import compile_parts
from compiler.findings import Findings
from compiler.world.scenario_passes import compile_parts_of_scenario
from compiler.world.world import lower_world
from spec_schema.arbiter import ArbiterSpec
from spec_schema.architecture import ArchitectureSpec
from spec_schema.body import BodySpec
from spec_schema.diagnostics import Diagnostic
from spec_schema.load import Loaded
from spec_schema.scenario import ScenarioSpec
from spec_schema.world import WorldSpec


def check_kind(loaded: Loaded) -> tuple[Diagnostic, ...]:
    """Every mistake in a spec that is no behavior, and in the files that it names."""
    findings, library = Findings(loaded), Library()
    match loaded.spec:
        case BodySpec() as spec:
            lower_body(spec, loaded, findings)
        case ArbiterSpec() as spec:
            lower_arbiter(spec, loaded, library, findings)
        case ArchitectureSpec() as spec:
            compile_parts(spec, loaded, library, findings)
        case WorldSpec() as spec:
            lower_world(spec, loaded, findings)
        case ScenarioSpec() as spec:
            compile_parts_of_scenario(spec, loaded, library, findings)
    return (*findings.diagnostics, *library.mistakes)
