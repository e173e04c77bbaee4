"""By what the recording of a scenario is judged: what it carries, or a spec that is named."""

import hashlib
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final, final

from runtime import architecture_artifact
from runtime.arbiter import Arbiter
from runtime.architecture import Architecture
from runtime.container import ArtifactError
from runtime.program import Program
from runtime.requirement import Requirement
from runtime.scenario import Robot, Start
from runtime.scenario_artifact import faults_of_times
from runtime.world.model import Body
from spec_schema.diagnostics import SpecError
from spec_schema.suggest import did_you_mean
from specc.faults import fault
from specc.loading import kind_of, load_architecture, load_scenario
from verifier.architectures.document import SUFFIX, ScenarioDocument, attached_scenario
from verifier.report.places import place_of
from verifier.report.report import SpecIdentity
from verifier.traces.files.open_log import attached_programs, attachments, damaged_attachments

DAMAGED: Final = "V332"
OTHER: Final = "V392"
"""The code of a spec that is about nothing in the recording."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Carried:
    """What a recording carries: its robots, and the document of its scenario, if it has one."""

    robots: tuple[Robot, ...]
    document: ScenarioDocument | None


@final
@dataclass(frozen=True, eq=False, slots=True)
class Standard:
    """What the nodes of each robot, and the whole run, are held against.

    only: names of the nodes that are judged, `robot.node`; None for all. spec: of the scenario
    that requires something. how: where all that comes from, as a phrase. beside: the folder in
    which code of the user's own is looked for: that of the recording, or of the spec that is named;
    None: that of each architecture's file, where the spec that is named was compiled from those.
    """

    robots: tuple[Robot, ...]
    requirements: tuple[Requirement, ...]
    only: frozenset[str] | None
    spec: SpecIdentity
    how: str
    beside: Path | None


@final
@dataclass(frozen=True, slots=True)
class _Named:
    """Where a spec comes from, and the folder of its code; see `Standard`."""

    how: str
    beside: Path | None


def carries_architectures(trace: Path) -> bool:
    """Whether this is the recording of a scenario."""
    if trace.suffix.lower() != ".mcap" or not trace.is_file():
        return False
    return any(_is_architecture(data) for _, data in attached_programs(trace))


def _is_architecture(data: bytes) -> bool:
    try:
        return architecture_artifact.is_architecture(data)
    except ArtifactError:
        return False


def is_of_runs(spec: Path) -> bool:
    """Whether a spec is about whole runs: a scenario, or an architecture.

    Raises:
        SpecError: it can't be read.
    """
    return kind_of(spec) in {"scenario", "architecture"}


def carried_by(trace: Path) -> Carried | None:
    """What the recording of a scenario carries; None where it is of something else.

    Raises:
        SpecError: something of it is damaged (V332), or it can't be read (V301).
    """
    if trace.suffix.lower() != ".mcap" or not trace.is_file():
        return None
    _refuse_damaged(trace)
    robots = []
    for name, data in attached_programs(trace):
        try:
            if architecture_artifact.is_architecture(data):
                architecture, body = architecture_artifact.from_bytes(data)
                robots.append(_robot(name.removesuffix(".specc"), architecture, body))
        except ArtifactError as error:
            message = f"the attached {name} can't be used: {error}"
            raise fault(DAMAGED, trace, message, "record it again") from error
    if not robots:
        return None
    try:
        document = attached_scenario(trace)
    except ArtifactError as error:
        raise _damaged_scenario(trace, str(error)) from error
    for problem in () if document is None else faults_of_times(robots, document.step):
        raise _damaged_scenario(trace, problem)
    return Carried(tuple(robots), document)


def _damaged_scenario(trace: Path, why: str) -> SpecError:
    return fault(DAMAGED, trace, f"the attached scenario can't be used: {why}", "record it again")


def _refuse_damaged(trace: Path) -> None:
    """Stops where an attachment of a scenario's recording is damaged: what it says would be missed.

    Raises:
        SpecError: one is (V332).
    """
    names = damaged_attachments(trace)
    known = [*names, *(name for name, _ in attachments(trace, SUFFIX))]
    judged = [name for name in names if name.endswith((SUFFIX, ".specc"))]
    if judged and any(name.endswith(SUFFIX) for name in known):
        message = f"the attached {judged[0]} can't be used: its checksum does not fit"
        raise fault(DAMAGED, trace, message, "record it again")


def standard_of(
    trace: Path,
    carried: Carried,
    spec: Path | Program | None,
    program_of: Callable[[Path], Program | Arbiter],
) -> Standard:
    """What the recording is held against; `program_of` makes a behavior or arbiter of a path.

    Raises:
        SpecError: the spec is wrong, or about nothing that was recorded (V392).
    """
    document = carried.document
    name = trace.stem if document is None else document.name
    own = _own(trace, name, document)
    if spec is None:
        requirements = () if document is None else document.requirements
        return Standard(
            carried.robots, requirements, None, own, "attached to the trace", trace.parent
        )
    if isinstance(spec, Program):
        given = f"{spec.name}, as given"
        return _by_node(trace, carried, spec, _Named(given, trace.parent), own)
    is_compiled = spec.suffix == ".specc"
    named = _Named(f"{spec}, as named by --spec", spec.parent if is_compiled else None)
    match kind_of(spec):
        case "scenario":
            return _by_scenario(trace, carried, spec, named)
        case "architecture":
            return _by_architecture(trace, carried, spec, named, own)
        case _:
            return _by_node(
                trace, carried, program_of(spec), replace(named, beside=spec.parent), own
            )


def _own(trace: Path, name: str, document: ScenarioDocument | None) -> SpecIdentity:
    """The scenario that a recording carries: the file it was written in, the hash of what it is."""
    data = next((data for _, data in attachments(trace, SUFFIX)), b"")
    places = [place_of(each.origin) for each in document.requirements] if document else []
    file = next((place.file for place in places if place is not None), name)
    return SpecIdentity(
        name, f"{file}, attached to the recording", hashlib.sha256(data).hexdigest()
    )


def _by_scenario(trace: Path, carried: Carried, spec: Path, named: _Named) -> Standard:
    scenario = load_scenario(spec).scenario
    recorded = {robot.name for robot in carried.robots}
    missing = [robot.name for robot in scenario.robots if robot.name not in recorded]
    if missing:
        raise _about_others(trace, f"{spec} is about robot '{missing[0]}'", "robots", recorded)
    source = scenario.source
    identity = SpecIdentity(scenario.name, source.file, source.sha256)
    return Standard(scenario.robots, scenario.requirements, None, identity, named.how, named.beside)


def _by_architecture(
    trace: Path, carried: Carried, spec: Path, named: _Named, own: SpecIdentity
) -> Standard:
    """Every robot of an architecture of that name; where there is one robot, that one."""
    architecture, body = load_architecture(spec)
    meant = [robot for robot in carried.robots if robot.architecture.name == architecture.name]
    if not meant and len(carried.robots) == 1:
        meant = list(carried.robots)
    if not meant:
        names = {robot.architecture.name for robot in carried.robots}
        message = f"{spec} is architecture '{architecture.name}'"
        raise _about_others(trace, message, "architectures", names)
    robots = tuple(_robot(robot.name, architecture, body) for robot in meant)
    return Standard(robots, (), None, own, named.how, named.beside)


def _by_node(
    trace: Path, carried: Carried, spec: Program | Arbiter, named: _Named, own: SpecIdentity
) -> Standard:
    """The nodes of a behavior or arbiter of that name, and no others."""
    found = [(robot, _with(robot.architecture, spec)) for robot in carried.robots]
    only = frozenset(
        f"{robot.name}.{node.name}"
        for robot, _ in found
        for node in robot.architecture.nodes
        if _name_of(robot.architecture, node.behavior, node.arbiter) == (type(spec), spec.name)
    )
    if not only:
        wired = [robot.architecture for robot in carried.robots]
        names = {each.name for one in wired for each in one.programs}
        names |= {each.name for one in wired for each in one.arbiters}
        kind = "arbiter" if isinstance(spec, Arbiter) else "behavior"
        raise _about_others(trace, f"the spec is {kind} '{spec.name}'", "specs", names)
    robots = tuple(replace(robot, architecture=changed) for robot, changed in found)
    return Standard(robots, (), only, own, named.how, named.beside)


def _with(architecture: Architecture, spec: Program | Arbiter) -> Architecture:
    """The architecture with the spec in the place of that of the same name."""
    if isinstance(spec, Arbiter):
        arbiters = tuple(spec if a.name == spec.name else a for a in architecture.arbiters)
        return replace(architecture, arbiters=arbiters)
    programs = tuple(spec if p.name == spec.name else p for p in architecture.programs)
    return replace(architecture, programs=programs)


def _name_of(architecture: Architecture, behavior: int, arbiter: int) -> tuple[type, str]:
    if behavior >= 0:
        return Program, architecture.programs[behavior].name
    return (Arbiter, architecture.arbiters[arbiter].name) if arbiter >= 0 else (object, "")


def _robot(name: str, architecture: Architecture, body: Body) -> Robot:
    return Robot(name, body, architecture, Start(None), "")


def _about_others(trace: Path, what: str, kind: str, names: set[str]) -> SpecError:
    there = f"{kind} in it: {', '.join(sorted(names))}"
    word = what.rpartition("'")[0].rpartition("'")[2]
    remedy = "\n".join(part for part in (did_you_mean(word, names), there) if part)
    return fault(OTHER, trace, f"{what}, which is not in this recording", remedy)
