"""A recording judged against its spec, wherever the spec is found."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Literal, TypeAlias, final

from runtime.arbiter import Arbiter
from runtime.program import Program
from runtime.requirement import Requirement
from spec_schema.arbiter import ArbiterSpec
from spec_schema.behavior import BehaviorSpec
from spec_schema.diagnostics import SpecError
from spec_schema.load import Loaded, load
from specc.faults import fault
from specc.loading import load_program, refuse_log
from specc.verifying.arbiter import arbiter_for_verify, examine_arbiter
from specc.verifying.spec_finding import Found, find_spec
from specc.verifying.standard import carries_architectures
from verifier.arbitration.reader import reader_of
from verifier.examination import explain
from verifier.fidelity.verify import Judgement, judgement_of
from verifier.report.examination import Depth, Examination
from verifier.report.report import Report
from verifier.traces.files.log import Progress
from verifier.traces.read import read_trace

Clock: TypeAlias = Literal["auto", "sensor", "log"]
Judged: TypeAlias = Program | Arbiter | tuple[Requirement, ...]
"""What something is judged by."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Verification:
    """An examination, and the spec that it was made under.

    judgement: what the verdict rests on, without what was read and predicted; of an arbiter None.
    part: which part of a scenario's recording it is about: `robot.node`, or `requirements`.
    remarks: what has to be known of how a part was judged.
    """

    found: Found[Judged]
    examination: Examination
    judgement: Judgement | None
    part: str = ""
    remarks: tuple[str, ...] = ()

    @property
    def report(self) -> Report:
        """The verdict and its evidence."""
        return self.examination.report


def verify(
    trace: Path | str,
    spec: Path | str | Program | None = None,
    clock: Clock = "auto",
    *,
    allow_code: bool = False,
    strict: bool = False,
    depth: Depth = "all",
    progress: Callable[[str], None] | None = None,
    reading: Progress | None = None,
) -> Verification:
    """Judge a recording against its spec: the one given, else attached, else the project's.

    The recording of a scenario has many specs: see `verify_run`.

    Args:
        allow_code: whether an arbiter that is code of the user's own may be run.
        strict: any loss in the log is an error.
        depth: what is found out beside the verdict.
        progress: is told what is done next, as a phrase.
        reading: is told now and then how many bytes of how many were read.

    Raises:
        SpecError: the spec or the log can't be used, or it is a scenario's recording (V393).
    """
    if carries_architectures(Path(trace)):
        message = "this is the recording of a scenario, in which each node has a spec of its own"
        raise fault("V393", trace, message, "use specc.verify_run")
    return verify_by(
        Path(trace),
        spec,
        clock,
        partial(program_for_verify, allow_code=allow_code),
        strict=strict,
        depth=depth,
        progress=progress,
        reading=reading,
    )


def verify_by(
    trace: Path,
    spec: Path | str | Program | None,
    clock: Clock,
    program_of: Callable[[Path], Program | Arbiter],
    *,
    strict: bool,
    depth: Depth,
    progress: Callable[[str], None] | None,
    reading: Progress | None,
) -> Verification:
    """What `verify` does, with `program_of` to make a program of a spec's path.

    Raises:
        SpecError: the spec or the log can't be used.
    """
    found: Found[Program | Arbiter]
    if isinstance(spec, Program):
        found = Found(spec, f"{spec.name}, as given")
    else:
        found = find_spec(trace, None if spec is None else Path(spec), program_of)
    tell = progress or _in_silence
    tell("reading")
    if isinstance(found.program, Arbiter):
        arbiter = found.program
        read = read_trace(trace, reader_of(arbiter), clock, reading, strict=strict)
        tell("judging")
        examined = examine_arbiter(arbiter, read, depth=depth)
        return Verification(Found(arbiter, found.how), examined, None)
    read = read_trace(trace, found.program, clock, reading, strict=strict)
    tell("judging")
    judgement = judgement_of(found.program, read)
    made = explain(found.program, read, judgement, tell, depth=depth)
    return Verification(Found(found.program, found.how), made, replace(judgement, study=None))


def _in_silence(_phase: str) -> None:
    """Nobody watches."""


def program_for_verify(path: Path, *, allow_code: bool = False) -> Program | Arbiter:
    """What `verify` judges by; of what a spec's author wrote, an arbiter alone may be allowed.

    Raises:
        SpecError: the spec is wrong, or it is code.
    """
    refuse_log(path)
    if path.suffix != ".specc" and isinstance(load(path).spec, ArbiterSpec):
        return arbiter_for_verify(path, allow_code=allow_code)
    return behavior_for_verify(path)


def behavior_for_verify(path: Path) -> Program:
    """The program of a behavior, without running what its author wrote.

    Raises:
        SpecError: the spec is wrong, or its field is code.
    """
    refuse_log(path)
    if path.suffix != ".specc":
        loaded = load(path)
        name = loaded.spec.name
        remedy = f"specc compile {path}, then specc verify TRACE --spec {name}.specc"
        refuse_code(loaded, "verify", remedy)
    return load_program(path, allow_code=False)


def refuse_code(loaded: Loaded, command: str, remedy: str) -> None:
    """Stops `command` before it would run what the spec's author wrote.

    Raises:
        SpecError: the spec's field is code (V336).
    """
    if isinstance(loaded.spec, BehaviorSpec) and loaded.spec.field.module is not None:
        message = f"this field is Python code, and {command} runs nobody's code"
        raise SpecError([loaded.error("V336", ("field", "module"), message, remedy, key=True)])
