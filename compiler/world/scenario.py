"""From the file of a scenario to what the runtime runs."""

from pathlib import Path as FilePath

from compiler.architecture.compile import tabulating
from compiler.compile import Judge
from compiler.findings import Findings
from compiler.world.scenario_passes import CompiledScenario, compile_parts_of_scenario
from runtime.progress import Progress
from spec_schema.diagnostics import Diagnostic, Severity, SpecError
from spec_schema.load import Loaded, examine
from spec_schema.scenario import ScenarioSpec
from spec_schema.wording import with_article

__all__ = ["CompiledScenario", "compile_scenario"]


def compile_scenario(
    path: FilePath | str,
    progress: Progress,
    seed: int | None = None,
    judge: Judge | None = None,
    *,
    allow_code: bool = False,
) -> CompiledScenario:
    """Compile the scenario at `path` and everything that it names, each file once.

    seed: in the place of the one in the file. judge, allow_code: as of `compile_loaded`.

    Raises:
        SpecError: with everything that is wrong with it, and with what it names.
    """
    library = tabulating(progress, judge, allow_code=allow_code)
    examined = examine(FilePath(path), "scenario")
    loaded = examined.loaded
    if loaded is None or not isinstance(loaded.spec, ScenarioSpec):
        raise SpecError(examined.mistakes or [_no_scenario(loaded)])
    findings = Findings(loaded)
    found = compile_parts_of_scenario(loaded.spec, loaded, library, findings, seed)
    mistakes = (*examined.mistakes, *findings.diagnostics, *library.mistakes)
    if found is None or any(one.severity is Severity.ERROR for one in mistakes):
        raise SpecError(mistakes)
    return found


def _no_scenario(loaded: Loaded | None) -> Diagnostic:
    assert loaded is not None, "what could not be read has mistakes"
    message = f"{with_article(loaded.spec.kind)} is no scenario"
    return loaded.error("S200", ("kind",), message, "name a scenario spec")
