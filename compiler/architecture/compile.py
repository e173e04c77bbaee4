"""From the file of an architecture to what the runtime runs."""

from pathlib import Path as FilePath

from compiler.architecture.library import Behavior, Library
from compiler.architecture.passes import CompiledArchitecture, compile_parts
from compiler.compile import Judge, compile_loaded
from compiler.findings import Findings
from compiler.lower_field import Progress
from spec_schema.architecture import ArchitectureSpec
from spec_schema.behavior import BehaviorSpec
from spec_schema.diagnostics import Diagnostic, Severity, SpecError
from spec_schema.load import Loaded, examine

__all__ = ["CompiledArchitecture", "compile_architecture", "tabulating"]


def compile_architecture(
    path: FilePath | str, progress: Progress, judge: Judge | None = None
) -> CompiledArchitecture:
    """Compile the architecture spec at `path`, and everything that it names, each file once.

    judge: as of `compile_file`, for sketched behaviors.

    Raises:
        SpecError: with everything that is wrong with it, and with what it names.
    """
    library = tabulating(progress, judge)
    examined = examine(FilePath(path))
    loaded = examined.loaded
    if loaded is None or not isinstance(loaded.spec, ArchitectureSpec):
        raise SpecError(examined.mistakes or [_no_architecture(loaded)])
    findings = Findings(loaded)
    found = compile_parts(loaded.spec, loaded, library, findings)
    mistakes = (*examined.mistakes, *findings.diagnostics, *library.mistakes)
    if found is None or any(one.severity is Severity.ERROR for one in mistakes):
        raise SpecError(mistakes)
    return found


def tabulating(progress: Progress, judge: Judge | None) -> Library:
    """A library that compiles behaviors to their tables."""

    def compiler(loaded: Loaded, _spec: BehaviorSpec) -> Behavior:
        compiled = compile_loaded(loaded, progress, judge)
        return Behavior(compiled.program, compiled.warnings)

    return Library(compiler)


def _no_architecture(loaded: Loaded | None) -> Diagnostic:
    """That a spec is of another kind."""
    assert loaded is not None, "what could not be read has mistakes"
    message = f"a {loaded.spec.kind} is no architecture"
    return loaded.error("S200", ("kind",), message, "name an architecture spec")
