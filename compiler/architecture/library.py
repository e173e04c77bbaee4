"""The specs that other specs name: found, read and compiled, each file once."""

import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import TypeAlias, TypeVar, final

from compiler.assemble import assembled
from compiler.check_behavior import check_behavior
from compiler.compile import compile_loaded
from compiler.findings import Findings
from runtime.arbiter import Arbiter
from runtime.program import Program
from runtime.progress import in_silence
from spec_schema.behavior import BehaviorSpec
from spec_schema.diagnostics import Diagnostic, Severity, SpecError
from spec_schema.field_forms import Arrows, Form
from spec_schema.kinds import MODELS, AnySpec
from spec_schema.load import Examined, Loaded, examine
from spec_schema.places import Path
from spec_schema.suggest import nearest
from spec_schema.wording import quoted, with_article

WIDEST = 8
"""How many files of a folder a message names at most."""

QUICK = 2
"""Over how many variables arrows are filled while a spec is checked: in 0.2 s in the library."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Behavior:
    """A behavior that an architecture names: its program, and what was doubted on the way."""

    program: Program
    warnings: tuple[Diagnostic, ...]


Lowered = TypeVar("Lowered")
Spec = TypeVar("Spec", bound=AnySpec)

Compiler: TypeAlias = Callable[[Loaded, BehaviorSpec], Behavior]
"""From a behavior spec to its program; raises SpecError."""


def checked_only(loaded: Loaded, spec: BehaviorSpec) -> Behavior:
    """A behavior that is checked: nothing of its author's is run.

    It gets tables only where nothing else tells its rates and they are made in no time.

    Raises:
        SpecError: with everything that is wrong with it.
    """
    if _is_quickly_filled(spec.field.form):
        filled = compile_loaded(loaded, in_silence)
        return Behavior(filled.program, filled.warnings)
    checked = check_behavior(loaded, spec)
    if checked.findings.has_errors:
        raise SpecError(checked.findings.diagnostics)
    return Behavior(assembled(checked), checked.findings.diagnostics)


def _is_quickly_filled(form: Form) -> bool:
    """Whether the tables of a field take a fraction of a second, as in a plane they do."""
    return isinstance(form, Arrows) and len(form.over) <= QUICK


@final
class Library:
    """All files that were named so far, and everything that is wrong in them.

    Attributes:
        arbiters: by file those that were compiled, None where one can't be used.
    """

    def __init__(self, compiler: Compiler = checked_only) -> None:
        self._compiler = compiler
        self._examined: dict[FilePath, Examined | None] = {}
        self._behaviors: dict[FilePath, Behavior | None] = {}
        self._wrong: dict[FilePath, tuple[Diagnostic, ...]] = {}
        self._doubtful: dict[FilePath, tuple[Diagnostic, ...]] = {}
        self.arbiters: dict[str, Arbiter | None] = {}

    @property
    def mistakes(self) -> tuple[Diagnostic, ...]:
        """Every error in the files that were named, in the order in which they were found."""
        return tuple(found for many in self._wrong.values() for found in many)

    @property
    def doubts(self) -> tuple[Diagnostic, ...]:
        """Every warning on bodies, worlds, arbiters and architectures that were named."""
        return tuple(found for many in self._doubtful.values() for found in many)

    def behavior(
        self, loaded: Loaded, path: Path, text: str, findings: Findings
    ) -> Behavior | None:
        """The behavior in the file that is named at `path`; None where it can't be used."""
        found = self.spec(loaded, path, text, "behavior", findings)
        if found is None or not isinstance(found.spec, BehaviorSpec):
            return None
        file = FilePath(found.source.name)
        if file not in self._behaviors:
            self._behaviors[file] = self._compiled(file, found, found.spec)
        return self._behaviors[file]

    def spec(
        self, loaded: Loaded, path: Path, text: str, kind: str, findings: Findings
    ) -> Loaded | None:
        """The sound spec of that kind in the file that is named at `path`, or None."""
        file = FilePath(os.path.normpath(FilePath(loaded.source.name).parent / text))
        if not file.is_file():
            self._tell_missing(file, text, path, findings)
            return None
        examined = self._read(file, kind)
        if examined is None:
            return None
        if examined.loaded is None:
            self._refuse(file, examined.mistakes)
            return None
        if examined.loaded.spec.kind != kind:
            is_ = with_article(examined.loaded.spec.kind)
            message = f"{quoted(text)} is {is_}, and {with_article(kind)} belongs here"
            findings.error("S321", path, message, f"name the file of {with_article(kind)}")
            return None
        self._refuse(file, examined.mistakes)
        return None if examined.mistakes else examined.loaded

    def lowered(
        self,
        loaded: Loaded,
        path: Path,
        text: str,
        model: type[Spec],
        lower: Callable[[Spec, Loaded, Findings], Lowered],
        findings: Findings,
    ) -> Lowered | None:
        """What `lower` makes of the spec in the file named at `path`; None where it can't be used.

        What is wrong in that file is kept with it.
        """
        kind = next(kind for kind, known in MODELS.items() if known is model)
        found = self.spec(loaded, path, text, kind, findings)
        if found is None or not isinstance(found.spec, model):
            return None
        own = Findings(found)
        made = lower(found.spec, found, own)
        self.keep(found, own.diagnostics)
        return None if own.has_errors else made

    def keep(self, loaded: Loaded, found: tuple[Diagnostic, ...]) -> None:
        """Keep what is wrong or doubtful in a spec that was named."""
        file = FilePath(loaded.source.name)
        self._refuse(file, found)
        self._doubtful[file] = tuple(d for d in found if d.severity is Severity.WARNING)

    def _refuse(self, file: FilePath, found: tuple[Diagnostic, ...]) -> None:
        errors = tuple(d for d in found if d.severity is Severity.ERROR)
        if errors:
            self._wrong[file] = errors

    def _compiled(self, file: FilePath, loaded: Loaded, spec: BehaviorSpec) -> Behavior | None:
        try:
            return self._compiler(loaded, spec)
        except SpecError as error:
            self._refuse(file, error.diagnostics)
            return None

    def _read(self, file: FilePath, kind: str) -> Examined | None:
        if file not in self._examined:
            try:
                self._examined[file] = examine(file, kind)
            except SpecError as error:
                self._examined[file] = None
                self._refuse(file, error.diagnostics)
        return self._examined[file]

    def _tell_missing(self, file: FilePath, text: str, path: Path, findings: Findings) -> None:
        if file.is_dir():
            message, remedy = f"{quoted(text)} is a folder", "name a file in it"
        else:
            message, remedy = f"there is no file {quoted(text)}", _near(file, text)
        findings.error("S320", path, message, remedy)


def _near(file: FilePath, text: str) -> str:
    """What may have been meant: a file of the same folder."""
    if not file.parent.is_dir():
        return f"there is no folder {quoted(str(FilePath(text).parent))} either"
    beside = sorted(p.name for p in file.parent.glob("*.y*ml"))
    meant = nearest(file.name, beside)
    if meant is not None:
        return f"did you mean '{FilePath(text).with_name(meant)}'?"
    if not 0 < len(beside) <= WIDEST:
        return "paths are relative to the file that they stand in"
    return f"beside it: {', '.join(beside)}"
