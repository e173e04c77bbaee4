"""Specs into programs: compiled from YAML, or read from an artifact."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Final

from compiler.architecture.compile import CompiledArchitecture, compile_architecture
from compiler.compile import Compiled
from compiler.compile_file import compile_file
from compiler.world.scenario import CompiledScenario, compile_scenario
from runtime import architecture_artifact, scenario_artifact
from runtime.architecture import Architecture
from runtime.artifact import ArtifactError, to_bytes
from runtime.artifact import read as read_artifact
from runtime.program import Program
from runtime.progress import Progress, in_silence
from runtime.scenario import Scenario
from runtime.world.model import Body
from spec_schema.load import examine
from spec_schema.wording import with_article
from specc.faults import fault
from specc.files import write_atomically
from specc.sketch_judge import faults_of

LOGS: Final = frozenset({".mcap", ".bag", ".db3", ".ulg", ".csv"})
"""What files are called that are no specs."""


def compile_spec(
    path: Path | str, progress: Progress = in_silence, *, allow_code: bool = True
) -> Compiled:
    """Compile a behavior spec; `progress(what, done, of)` is called on the way.

    allow_code: whether a field that is Python code may be run; who names such a spec means that.

    Raises:
        SpecError: with everything that is wrong with it, or its code may not be run (V336).
    """
    refuse_log(Path(path))
    return compile_file(Path(path), progress, faults_of, allow_code=allow_code)


def kind_of(path: Path | str) -> str:
    """What a spec, or an artifact, describes, or seems to: `behavior`, `scenario`...

    Raises:
        SpecError: the file can't be read.
    """
    path = Path(path)
    refuse_log(path)
    if path.suffix == ".specc":
        return _kind_of_artifact(path) or "behavior"
    loaded = examine(path).loaded
    return "behavior" if loaded is None else loaded.spec.kind


def compile_architecture_spec(
    path: Path | str, progress: Progress = in_silence, *, allow_code: bool = False
) -> CompiledArchitecture:
    """Compile an architecture and all that it names.

    allow_code: whether fields of behaviors in it that are Python code may be run.

    Raises:
        SpecError: with everything that is wrong with it, or its code may not be run (V336).
    """
    refuse_log(Path(path))
    return compile_architecture(Path(path), progress, faults_of, allow_code=allow_code)


def compile_scenario_spec(
    path: Path | str,
    progress: Progress = in_silence,
    seed: int | None = None,
    *,
    allow_code: bool = False,
) -> CompiledScenario:
    """Compile a scenario and all that it names; `seed` in the place of its own.

    allow_code: as of `compile_architecture_spec`.

    Raises:
        SpecError: with everything that is wrong with it, or its code may not be run (V336).
    """
    refuse_log(Path(path))
    return compile_scenario(Path(path), progress, seed, faults_of, allow_code=allow_code)


def load_architecture(path: Path | str) -> tuple[Architecture, Body]:
    """An architecture and its body: a .yaml is compiled, without running code, a .specc read.

    Raises:
        SpecError: the spec is wrong, or the artifact is damaged.
    """
    path = Path(path)
    if path.suffix != ".specc":
        compiled = compile_architecture_spec(path)
        return compiled.architecture, compiled.body
    with _told(path, "architecture"):
        return architecture_artifact.from_bytes(path.read_bytes())


def load_scenario(
    path: Path | str,
    progress: Progress = in_silence,
    seed: int | None = None,
    *,
    allow_code: bool = False,
) -> CompiledScenario:
    """A scenario: a .yaml is compiled, a .specc read; `seed` in the place of its own.

    Raises:
        SpecError: the spec is wrong, or the artifact is damaged.
    """
    path = Path(path)
    if path.suffix != ".specc":
        return compile_scenario_spec(path, progress, seed, allow_code=allow_code)
    with _told(path, "scenario"):
        found = scenario_artifact.from_bytes(path.read_bytes())
    return CompiledScenario(found if seed is None else replace(found, seed=seed), ())


def beside_artifact(path: Path) -> Path | None:
    """Where code is looked for that an artifact names; None for a .yaml, which is beside its own.

    What an artifact says of its source is somebody's word, and no folder.
    """
    return path.parent if path.suffix == ".specc" else None


@contextmanager
def _told(path: Path, wanted: str) -> Iterator[None]:
    """What keeps an artifact from being used, as a diagnostic: V335."""
    try:
        yield
    except OSError as error:
        why = str(error.strerror or error).lower()
        raise fault("V335", path, f"this artifact can't be read: {why}") from error
    except ArtifactError as error:
        kind = _kind_of_artifact(path)
        if kind not in {wanted, ""}:
            message = (
                f"this is the artifact of {with_article(kind)}, "
                f"and that of {with_article(wanted)} belongs here"
            )
            raise fault("V335", path, message, f"compile {with_article(wanted)}") from error
        message = f"this artifact can't be used: {error}"
        raise fault("V335", path, message, "compile the spec again") from error


def _kind_of_artifact(path: Path) -> str:
    """What a whole artifact holds; nothing of one that is damaged."""
    try:
        data = path.read_bytes()
        if scenario_artifact.is_scenario(data):
            return "scenario"
        return "architecture" if architecture_artifact.is_architecture(data) else "behavior"
    except (OSError, ArtifactError):
        return ""


def write_scenario(scenario: Scenario, path: Path | str) -> bytes:
    """Write the `.specc` artifact of a scenario atomically, and return its bytes."""
    data = scenario_artifact.to_bytes(scenario)
    write_atomically(Path(path), data)
    return data


def write_architecture(compiled: CompiledArchitecture, path: Path | str) -> bytes:
    """Write the `.specc` artifact of an architecture atomically, and return its bytes."""
    data = architecture_artifact.to_bytes(compiled.architecture, compiled.body)
    write_atomically(Path(path), data)
    return data


def refuse_log(path: Path) -> None:
    """Stops before a log is read as a spec, of which every line would be a mistake.

    Raises:
        SpecError: the file's name is that of a log (V331).
    """
    if path.suffix.lower() in LOGS:
        raise fault("V331", path, "this is a log, not a spec", f"specc verify {path} --spec SPEC")


def write_artifact(program: Program, path: Path | str) -> bytes:
    """Write the `.specc` artifact atomically, and return its bytes."""
    data = to_bytes(program)
    write_atomically(Path(path), data)
    return data


def as_program(spec: Program | Path | str) -> Program:
    """The program itself, or that of a spec's file.

    Raises:
        SpecError: the spec is wrong, or the artifact is damaged.
    """
    return spec if isinstance(spec, Program) else load_program(spec)


def load_program(path: Path | str, *, allow_code: bool = True) -> Program:
    """The program of a spec: a .yaml is compiled, as by `compile_spec`, a .specc read.

    Raises:
        SpecError: the spec is wrong, or the artifact is damaged.
    """
    path = Path(path)
    if path.suffix != ".specc":
        return compile_spec(path, allow_code=allow_code).program
    with _told(path, "behavior"):
        return read_artifact(path)
