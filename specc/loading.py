"""Specs into programs: compiled from YAML, or read from an artifact."""

from pathlib import Path

from compiler.compile import Compiled, compile_file
from compiler.lower_field import Progress
from runtime.artifact import ArtifactError, to_bytes
from runtime.artifact import read as read_artifact
from runtime.program import Program
from specc.faults import fault
from specc.files import write_atomically
from specc.sketch_judge import faults_of


def _in_silence(_what: str, _done: int, _of: int) -> None:
    """Nobody watches."""


def compile_spec(path: Path | str, progress: Progress = _in_silence) -> Compiled:
    """Compile a behavior spec; `progress(what, done, of)` is called on the way.

    Raises:
        SpecError: with everything that is wrong with it.
    """
    return compile_file(Path(path), progress, faults_of)


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
