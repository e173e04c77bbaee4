"""Which spec a trace is judged by: the one named, else the one attached, else the project's."""

import glob
import hashlib
import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path, PurePath
from typing import Generic, TypeVar, final

from runtime.artifact import ArtifactError, from_bytes
from runtime.program import Program
from spec_schema.arbiter import ArbiterSpec
from spec_schema.behavior import BehaviorSpec
from spec_schema.diagnostics import SpecError
from spec_schema.load import load
from spec_schema.project import ProjectSpec
from specc.faults import fault
from verifier.traces.files.open_log import attached_program

PROJECT = "specc.yaml"
SPECS = frozenset({".yaml", ".yml", ".specc"})


T_co = TypeVar("T_co", covariant=True)


@final
@dataclass(frozen=True, eq=False, slots=True)
class Found(Generic[T_co]):
    """What a trace is judged by, and how it was found, as a sentence."""

    program: T_co
    how: str


def find_spec(
    trace: Path, named: Path | None, program_of: Callable[[Path], T_co]
) -> Found[T_co | Program]:
    """The spec for `trace`; `program_of` loads one from a path, and an attached one is a program.

    Raises:
        SpecError: there is none, or the attached one is not the project's of the same name.
    """
    found = claimed_spec(trace, named, program_of)
    if found is None:
        project = _project_of(trace)
        raise _no_project(trace) if project is None else _unclaimed(project, trace)
    return found


def claimed_spec(
    trace: Path, named: Path | None, program_of: Callable[[Path], T_co]
) -> Found[T_co | Program] | None:
    """What `find_spec` finds; None where nothing says which spec the trace is of.

    Raises:
        SpecError: the attached spec is not the project's of the same name.
    """
    if named is not None:
        return Found(program_of(named), f"{named}, as named by --spec")
    _refuse_no_log(trace)
    attached = _attached(trace)
    project = _project_of(trace)
    if attached is not None:
        name, program = attached
        if project is not None:
            _refuse_other_text(trace, program, project)
        return Found(program, f"{name}, attached to the trace (spec text sha256 {_short(program)})")
    claim = None if project is None else _spec_of(project, trace)
    if project is None or claim is None:
        return None
    path, why = claim
    return Found(program_of(path), f"{path}, {why} {project.path}")


def project_text(trace: Path, specs: Sequence[str], judged_by: str) -> str:
    """A whole project file that says what a trace is judged by, to be written where one works."""
    return "\n".join(
        (
            "specc: 1",
            "kind: project",
            "name: mine",
            f"specs: [{', '.join(specs)}]",
            "traces:",
            f"  {_claim(_shown(trace.resolve()), judged_by)}",
        )
    )


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Project:
    path: Path
    spec: ProjectSpec


def _refuse_no_log(trace: Path) -> None:
    """Nobody looks for a spec only to be told that there is nothing to judge by it."""
    if trace.suffix in SPECS:
        raise fault("V302", trace, "this is a spec, not a log", f"specc verify LOG --spec {trace}")
    is_empty = not any(trace.iterdir()) if trace.is_dir() else _size(trace) == 0
    if is_empty:
        what = "folder" if trace.is_dir() else "file"
        raise fault("V302", trace, f"the {what} is empty")


def _size(trace: Path) -> int | None:
    """Of a file; None where it can't be asked, which is told when it is opened."""
    try:
        return trace.stat().st_size
    except OSError:
        return None


def _attached(trace: Path) -> tuple[str, Program] | None:
    found = attached_program(trace)
    if found is None:
        return None
    name, data = found
    try:
        return name, from_bytes(data)
    except ArtifactError as error:
        message = f"the attached {name} can't be used: {error}"
        raise fault("V332", trace, message, "name a spec with --spec") from error


def _project_of(trace: Path) -> _Project | None:
    """The nearest project file above the working directory, else above the trace."""
    for start in (Path.cwd(), trace.resolve().parent):
        for folder in (start, *start.parents):
            path = folder / PROJECT
            if path.is_file():
                spec = load(_shown(path)).spec
                if isinstance(spec, ProjectSpec):
                    return _Project(_shown(path), spec)
    return None


def _shown(path: Path) -> Path:
    """The path as the user would write it from here."""
    here = Path.cwd()
    return path.relative_to(here) if path.is_relative_to(here) else path


def _refuse_other_text(trace: Path, program: Program, project: _Project) -> None:
    """The attached spec and the project's of the same name must be the same text."""
    for entry in dict.fromkeys((*project.spec.specs, *project.spec.traces.values())):
        path = project.path.parent / entry
        if not path.is_file() or path.suffix == ".specc":
            continue
        loaded = load(path)
        if loaded.spec.name != program.name:
            continue
        digest = hashlib.sha256(loaded.source.text.encode()).hexdigest()
        if digest != program.source.sha256:
            raise fault(
                "V333",
                trace,
                f"the trace carries spec '{program.name}' with sha256 {_short(program)}, the "
                f"project's {path} has {digest[:12]}: the robot was recorded under another spec",
                f"name the one to judge by: --spec {path}, or the .specc of the attached one",
            )


def _spec_of(project: _Project, trace: Path) -> tuple[Path, str] | None:
    """The spec that the project names for a trace, and why; None where it names none."""
    folder = project.path.parent
    for pattern, entry in project.spec.traces.items():
        # Path.glob refuses patterns that are absolute, which a user may well write.
        matching = glob.iglob(pattern, root_dir=folder, recursive=True)  # noqa: PTH207
        if any(trace.resolve() == (folder / path).resolve() for path in matching):
            return folder / entry, f"since '{pattern}' names it in"
    if len(project.spec.specs) == 1:
        return folder / project.spec.specs[0], "the only spec of"
    return None


def _no_project(trace: Path) -> SpecError:
    here = Path.cwd()
    files = sorted(path for path in (*here.glob("*.yaml"), *here.glob("specs/*.yaml")))
    specs = [str(path.relative_to(here)) for path in files if _judges(path)] or ["NAME.yaml"]
    return fault(
        "V331",
        trace,
        f"no spec is attached to the trace, and no {PROJECT} is in this folder or above it",
        f"name one with --spec, or write a {PROJECT} in this folder:\n"
        f"{project_text(trace, specs, _likely(trace, specs))}",
    )


def _judges(path: Path) -> bool:
    """Whether a file is a spec that a log may be judged by."""
    try:
        return isinstance(load(path).spec, BehaviorSpec | ArbiterSpec)
    except SpecError:
        return False


def _unclaimed(project: _Project, trace: Path) -> SpecError:
    folder, specs = project.path.parent.resolve(), project.spec.specs
    resolved = trace.resolve()
    place = resolved.relative_to(folder) if resolved.is_relative_to(folder) else resolved
    claim = _claim(place, _likely(trace, specs))
    entry = f"add this line under its `traces:`:\n  {claim}"
    if not project.spec.traces:
        entry = f"add these lines to it:\ntraces:\n  {claim}"
    if not specs:
        entry = entry.replace("add", "add `specs: [NAME.yaml]`, and", 1)
    return fault(
        "V334",
        trace,
        f"{project.path} names {len(specs)} specs, and none of its `traces:` patterns fits this"
        " trace",
        f"name one with --spec, or {entry}",
    )


def _claim(place: Path, spec: str) -> str:
    """The line of a project file that says by which spec a trace is judged."""
    return f"{json.dumps(place.as_posix(), ensure_ascii=False)}: {spec}"


def _likely(trace: Path, specs: Sequence[str]) -> str:
    """The spec whose name is in that of the trace; else the first."""
    alike = [each for each in specs if PurePath(each).stem in trace.stem]
    return max(alike, key=len, default=next(iter(specs), "NAME.yaml"))


def _short(program: Program) -> str:
    return program.source.sha256[:12]
