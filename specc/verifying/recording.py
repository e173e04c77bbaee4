"""The recording of a scenario judged: what it requires, and every node by its own spec."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final, final

from runtime.arbiter import Arbiter
from runtime.program import Program
from runtime.requirement import Requirement
from runtime.scenario import Robot
from specc.faults import fault
from specc.verifying.architecture import How, NodeVerdict, NotJudged, examine_nodes
from specc.verifying.requirements import judged_on
from specc.verifying.spec_finding import Found
from specc.verifying.standard import Carried, Standard, carried_by, standard_of
from specc.verifying.trace import Verification, program_for_verify
from verifier.architectures.log import RunLog, open_run, together
from verifier.architectures.motion import topics_of_motion, with_motion
from verifier.architectures.own_doing import topics_of_doing, with_own_doing
from verifier.architectures.quantities import POSE, quantities_in, topics_of_quantities
from verifier.architectures.recorded import records_of, topics_of_nodes
from verifier.architectures.required import examine_requirements
from verifier.report.examination import Depth
from verifier.report.report import WORST_FIRST, Verdict
from verifier.traces.files.log import Progress
from verifier.traces.read import refuse_losses

REQUIREMENTS: Final = "requirements"
"""What that part of a recording is called that no node answers for."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class RunVerification:
    """What the recording of a scenario shows of its requirements and of its nodes.

    requirements: None where nothing is required. nodes: in the order of robots and nodes, each
    with its `part`, `robot.node`. not_judged: nodes of which nothing can be said, and why.
    """

    source: str
    requirements: Verification | None
    nodes: tuple[Verification, ...]
    not_judged: tuple[NotJudged, ...]

    @property
    def verdict(self) -> Verdict:
        """The worst of the requirements and of all nodes."""
        found = {each.report.verdict for each in self.judged}
        return next(verdict for verdict in WORST_FIRST if verdict in found)

    @property
    def judged(self) -> tuple[Verification, ...]:
        """All that has a verdict, the requirements first."""
        return (*([self.requirements] if self.requirements else []), *self.nodes)

    def node(self, name: str) -> Verification:
        """The verdict on `robot.node`.

        Raises:
            KeyError: it has none.
        """
        return {each.part: each for each in self.nodes}[name]


def verify_run(
    trace: Path | str,
    spec: Path | str | Program | None = None,
    *,
    allow_code: bool = False,
    strict: bool = False,
    depth: Depth = "all",
    progress: Callable[[str], None] | None = None,
    reading: Progress | None = None,
) -> RunVerification:
    """Judge the recording of a scenario: its requirements, and each node where it had its way.

    Args:
        spec: a scenario, an architecture, or one behavior or arbiter; None: what is attached.
        allow_code: whether arbiters that are code of the user's own may be run.
        strict: any loss in the recording is an error.
        depth: what is found out beside the verdict.
        progress: is told what is done next, as a phrase.
        reading: is told now and then how many bytes of how many were read.

    Raises:
        SpecError: this is no recording of a scenario, it or the spec can't be used, or nothing of
            it can be judged (V391).
    """
    trace = Path(trace)
    carried = carried_by(trace)
    if carried is None:
        raise fault("V393", trace, "this is not the recording of a scenario", "use specc.verify")
    named = spec if spec is None or isinstance(spec, Program) else Path(spec)
    return verify_carried(
        trace,
        carried,
        named,
        program_for_verify,
        allow_code=allow_code,
        strict=strict,
        depth=depth,
        progress=progress,
        reading=reading,
    )


def verify_carried(
    trace: Path,
    carried: Carried,
    spec: Path | Program | None,
    program_of: Callable[[Path], Program | Arbiter],
    *,
    allow_code: bool,
    strict: bool,
    depth: Depth,
    progress: Callable[[str], None] | None,
    reading: Progress | None,
) -> RunVerification:
    """What `verify_run` does, with what the recording carries at hand.

    Raises:
        SpecError: see `verify_run`.
    """
    return verify_standard(
        trace,
        carried,
        standard_of(trace, carried, spec, program_of),
        allow_code=allow_code,
        strict=strict,
        depth=depth,
        is_named=spec is not None,
        progress=progress,
        reading=reading,
    )


def verify_standard(
    trace: Path,
    carried: Carried,
    standard: Standard,
    *,
    allow_code: bool,
    strict: bool,
    depth: Depth,
    is_named: bool,
    progress: Callable[[str], None] | None,
    reading: Progress | None,
) -> RunVerification:
    """What `verify_run` does, by a standard that need not be what was carried.

    is_named: whether it is another one, under which the robot need not have run.

    Raises:
        SpecError: see `verify_run`.
    """
    tell = progress or _in_silence
    tell("reading")
    log = _opened(trace, carried, standard, reading)
    if strict:
        refuse_losses(trace, log.losses)
    tell("judging")
    required = _required(trace, carried, standard, log)
    how = How(
        standard.beside,
        _seed(carried),
        standard.only,
        allow_code,
        depth,
        is_named,
    )
    records = records_of(log, {robot.name: robot.architecture for robot in standard.robots})
    records |= {
        robot.name: with_motion(log, robot, with_own_doing(log, robot, records[robot.name]))
        for robot in standard.robots
    }
    found = [
        each
        for robot in standard.robots
        for each in examine_nodes(robot.architecture, records[robot.name], str(trace), how)
    ]
    nodes = tuple(_verification(each, standard) for each in found if isinstance(each, NodeVerdict))
    lost = tuple(each for each in found if isinstance(each, NotJudged))
    if required is None and not nodes:
        why = "; ".join(f"{each.source}: {each.why}" for each in lost)
        raise fault("V391", trace, "no node of it can be judged, and nothing is required", why)
    return RunVerification(str(trace), required, nodes, lost)


def _opened(trace: Path, carried: Carried, standard: Standard, reading: Progress | None) -> RunLog:
    wanted = [topics_of_nodes({r.name: r.architecture for r in standard.robots})]
    for robot in standard.robots:
        wanted += [topics_of_doing(robot), topics_of_motion(robot)]
    if standard.requirements:
        things = _things(standard.requirements, carried.robots)
        wanted.append(topics_of_quantities(carried.robots, things))
    step = 0.0 if carried.document is None else carried.document.step
    return open_run(trace, together(wanted), step, reading)


def _things(requirements: Sequence[Requirement], robots: Sequence[Robot]) -> list[str]:
    """The names of what requirements read the pose of, and that is no robot."""
    names = [name for each in requirements for name in each.quantities]
    heads = {head for head, _, last in (name.rpartition(".") for name in names) if last in POSE}
    return sorted(heads - {robot.name for robot in robots})


def _required(
    trace: Path, carried: Carried, standard: Standard, log: RunLog
) -> Verification | None:
    if not standard.requirements:
        return None
    things = _things(standard.requirements, carried.robots)
    results, duration = judged_on(
        trace, standard.requirements, quantities_in(log, carried.robots, things), carried, log
    )
    source = f"{trace}: {REQUIREMENTS}"
    made = examine_requirements(results, standard.spec, source, duration, log.losses)
    return Verification(Found(standard.requirements, standard.how), made, None, REQUIREMENTS)


def _verification(each: NodeVerdict, standard: Standard) -> Verification:
    how = standard.how
    if standard.how == "attached to the trace":
        how = f"{each.name.partition('.')[0]}.specc, attached to the trace"
    return Verification(
        Found(each.spec, how), each.examination, each.judgement, each.name, each.remarks
    )


def _seed(carried: Carried) -> int:
    return 0 if carried.document is None else carried.document.seed


def _in_silence(_phase: str) -> None:
    """Nobody watches."""
