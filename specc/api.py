"""What `import specc` offers, as functions with typed results; the commands call these, too.

Quantities go in as people write them (`"0.4"`, `"40 cm/s"`, 0.4: in the variable's own unit) and
stay SI inside the results; each result names its units.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, TypeAlias, final

from compiler.check import check as check_file
from compiler.compile import Compiled, compile_file
from compiler.dump import dump
from runtime.artifact import ArtifactError, to_bytes
from runtime.artifact import read as read_artifact
from runtime.program import Program
from runtime.rollout import Rollout
from runtime.simulate import simulate as run
from spec_schema.behavior import BehaviorSpec
from spec_schema.diagnostics import Diagnostic, Severity, SpecError
from spec_schema.load import load
from spec_schema.source import Source
from specc.files import write_atomically
from specc.given import seconds, settings_for, si_settings
from specc.spec_finding import Found, find_spec
from verifier.fidelity.verify import verify as judge
from verifier.report.report import Report
from verifier.topology.features import Portrait
from verifier.topology.portrait import portrait as look
from verifier.topology.slices import SliceError
from verifier.traces.read import read_trace

__all__ = [
    "Compiled",
    "Found",
    "Portrait",
    "Program",
    "Report",
    "Rollout",
    "SpecError",
    "Verification",
    "check",
    "compile_spec",
    "dump",
    "load_program",
    "portrait",
    "simulate",
    "verify",
]

Value: TypeAlias = float | str
Progress: TypeAlias = Callable[[str, int, int], None]
Clock: TypeAlias = Literal["auto", "sensor", "log"]


@final
@dataclass(frozen=True, eq=False, slots=True)
class Verification:
    """A verdict, and the spec that it was given under."""

    found: Found
    report: Report


def check(path: Path | str) -> tuple[Diagnostic, ...]:
    """Every mistake in a spec and every doubt; runs nothing that its author wrote."""
    return check_file(Path(path))


def compile_spec(path: Path | str, progress: Progress = lambda _what, _done, _of: None) -> Compiled:
    """Compile a behavior spec.

    Raises:
        SpecError: with everything that is wrong with it.
    """
    return compile_file(Path(path), progress)


def write_artifact(program: Program, path: Path | str) -> bytes:
    """Write the `.specc` artifact atomically, and return its bytes."""
    data = to_bytes(program)
    write_atomically(Path(path), data)
    return data


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
    except ArtifactError as error:
        raise _fault(
            "V335", path, f"this artifact can't be used: {error}", "compile the spec again"
        ) from error


def simulate(
    program: Program,
    start: Mapping[str, Value] | None = None,
    duration: Value = "20 s",
    controls: Mapping[str, Value] | None = None,
    every: Value | None = None,
) -> Rollout:
    """Run a behavior alone; sensed-only variables follow their closure or are held.

    Raises:
        SpecError: a name that it does not have, or a value outside its domain.
    """
    begin = settings_for(program.states, start or {}, "state")
    held = settings_for(program.controls, controls or {}, "control")
    step = None if every is None else seconds(every)
    try:
        return run(program, begin, seconds(duration), held, step)
    except ValueError as error:
        path = Path(program.source.file)
        raise _fault("V342", path, str(error), "see `specc simulate --help`") from error


def portrait(
    program: Program,
    axes: Sequence[str] | None = None,
    held: Mapping[str, Value] | None = None,
) -> Portrait:
    """The phase portrait over two states (or the only one), as numbers.

    Raises:
        SpecError: an axis or a name that it does not have, or a value outside its domain.
    """
    try:
        names = None if axes is None else tuple(axes)
        return look(program, names, si_settings(program, held or {}))
    except SliceError as error:
        path = Path(program.source.file)
        raise _fault("V346", path, str(error), "see `specc portrait --help`") from error


def verify(
    trace: Path | str, spec: Path | str | Program | None = None, clock: Clock = "auto"
) -> Verification:
    """Judge a recording against its spec: the one given, else attached, else the project's.

    Raises:
        SpecError: the spec or the log can't be used.
    """
    trace = Path(trace)
    if isinstance(spec, Program):
        found = Found(spec, f"{spec.name}, as given")
    else:
        found = find_spec(trace, None if spec is None else Path(spec), _without_running)
    return Verification(found, judge(found.program, read_trace(trace, found.program, clock)))


def _without_running(path: Path) -> Program:
    """A program for `verify`, which runs nothing that a spec's author wrote."""
    if path.suffix != ".specc":
        loaded = load(path)
        if isinstance(loaded.spec, BehaviorSpec) and loaded.spec.field.module is not None:
            message = "this field is Python code, and verify runs nobody's code"
            name = loaded.spec.name
            remedy = f"specc compile {path}, then specc verify TRACE --spec {name}.specc"
            raise SpecError([loaded.error("V336", ("field", "module"), message, remedy, key=True)])
    return load_program(path)


def _fault(code: str, path: Path, message: str, remedy: str) -> SpecError:
    source = Source(str(path), "")
    return SpecError([Diagnostic(code, Severity.ERROR, message, source, None, help=remedy)])
