"""From the file of an architecture to what the runtime runs."""

from dataclasses import replace
from pathlib import Path as FilePath

from compiler.architecture.library import Behavior, Library, checked_only
from compiler.architecture.passes import CompiledArchitecture, compile_parts
from compiler.compile import Judge, compile_loaded
from compiler.findings import Findings
from runtime.progress import Progress
from spec_schema.architecture import ArchitectureSpec
from spec_schema.behavior import BehaviorSpec
from spec_schema.diagnostics import Diagnostic, Severity, SpecError
from spec_schema.load import Loaded, examine
from spec_schema.wording import with_article

__all__ = ["CompiledArchitecture", "compile_architecture", "tabulating", "wire_architecture"]


def compile_architecture(
    path: FilePath | str,
    progress: Progress,
    judge: Judge | None = None,
    *,
    allow_code: bool = False,
) -> CompiledArchitecture:
    """Compile the architecture spec at `path`, and everything that it names, each file once.

    judge, allow_code: as of `compile_loaded`, for the behaviors.

    Raises:
        SpecError: with everything that is wrong with it, and with what it names.
    """
    return _compiled(FilePath(path), tabulating(progress, judge, allow_code=allow_code))


def wire_architecture(path: FilePath | str) -> CompiledArchitecture:
    """The same without tables: how it is wired is known, and it can't be run.

    Nothing that an author of its specs wrote is run.

    Raises:
        SpecError: with everything that is wrong with it, and with what it names.
    """
    return _compiled(FilePath(path), Library(checked_only))


def _compiled(path: FilePath, library: Library) -> CompiledArchitecture:
    examined = examine(path, "architecture")
    loaded = examined.loaded
    if loaded is None or not isinstance(loaded.spec, ArchitectureSpec):
        raise SpecError(examined.mistakes or [_no_architecture(loaded)])
    findings = Findings(loaded)
    found = compile_parts(loaded.spec, loaded, library, findings)
    mistakes = (*examined.mistakes, *findings.diagnostics, *library.mistakes)
    if found is None or any(one.severity is Severity.ERROR for one in mistakes):
        raise SpecError(mistakes)
    return replace(found, warnings=(*found.warnings, *library.doubts))


def tabulating(progress: Progress, judge: Judge | None, *, allow_code: bool) -> Library:
    """A library that compiles behaviors to their tables."""

    def compiler(loaded: Loaded, _spec: BehaviorSpec) -> Behavior:
        compiled = compile_loaded(loaded, progress, judge, allow_code=allow_code)
        return Behavior(compiled.program, compiled.warnings)

    return Library(compiler)


def _no_architecture(loaded: Loaded | None) -> Diagnostic:
    """That a spec is of another kind."""
    assert loaded is not None, "what could not be read has mistakes"
    message = f"{with_article(loaded.spec.kind)} is no architecture"
    return loaded.error("S200", ("kind",), message, "name an architecture spec")
