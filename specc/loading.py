"""Specs into programs: compiled from YAML, or read from an artifact."""

from pathlib import Path
from typing import Final

from compiler.architecture.compile import CompiledArchitecture, compile_architecture
from compiler.compile import Compiled, compile_file
from compiler.lower_field import Progress
from compiler.world.scenario import CompiledScenario, compile_scenario
from runtime import architecture_artifact
from runtime.architecture import Architecture
from runtime.artifact import ArtifactError, to_bytes
from runtime.artifact import read as read_artifact
from runtime.program import Program
from runtime.world.model import Body
from spec_schema.load import examine
from specc.faults import fault
from specc.files import write_atomically
from specc.sketch_judge import faults_of

LOGS: Final = frozenset({".mcap", ".bag", ".db3", ".ulg", ".csv"})
"""What files are called that are no specs."""


def _in_silence(_what: str, _done: int, _of: int) -> None:
    """Nobody watches."""


def compile_spec(path: Path | str, progress: Progress = _in_silence) -> Compiled:
    """Compile a behavior spec; `progress(what, done, of)` is called on the way.

    Raises:
        SpecError: with everything that is wrong with it.
    """
    refuse_log(Path(path))
    return compile_file(Path(path), progress, faults_of)


def kind_of(path: Path | str) -> str:
    """What a spec describes, or seems to: `behavior`, `architecture`, `scenario`...

    Raises:
        SpecError: the file can't be read.
    """
    refuse_log(Path(path))
    loaded = examine(Path(path)).loaded
    return "behavior" if loaded is None else loaded.spec.kind


def compile_architecture_spec(
    path: Path | str, progress: Progress = _in_silence
) -> CompiledArchitecture:
    """Compile an architecture and all that it names.

    Raises:
        SpecError: with everything that is wrong with it.
    """
    refuse_log(Path(path))
    return compile_architecture(Path(path), progress, faults_of)


def compile_scenario_spec(
    path: Path | str, progress: Progress = _in_silence, seed: int | None = None
) -> CompiledScenario:
    """Compile a scenario and all that it names; `seed` in the place of its own.

    Raises:
        SpecError: with everything that is wrong with it.
    """
    refuse_log(Path(path))
    return compile_scenario(Path(path), progress, seed, faults_of)


def load_architecture(path: Path | str) -> tuple[Architecture, Body]:
    """An architecture and its body: a .yaml is compiled, a .specc read.

    Raises:
        SpecError: the spec is wrong, or the artifact is damaged.
    """
    path = Path(path)
    if path.suffix != ".specc":
        compiled = compile_architecture_spec(path)
        return compiled.architecture, compiled.body
    try:
        return architecture_artifact.from_bytes(path.read_bytes())
    except OSError as error:
        why = str(error.strerror or error).lower()
        raise fault("V335", path, f"this artifact can't be read: {why}") from error
    except ArtifactError as error:
        message = f"this artifact can't be used: {error}"
        raise fault("V335", path, message, "compile the spec again") from error


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


def load_program(path: Path | str) -> Program:
    """The program of a spec: a .yaml is compiled, a .specc read.

    Raises:
        SpecError: the spec is wrong, or the artifact is damaged.
    """
    path = Path(path)
    if path.suffix != ".specc":
        return compile_spec(path).program
    try:
        return read_artifact(path)
    except OSError as error:
        why = str(error.strerror or error).lower()
        raise fault("V335", path, f"this artifact can't be read: {why}") from error
    except ArtifactError as error:
        message = f"this artifact can't be used: {error}"
        raise fault("V335", path, message, "compile the spec again") from error
