"""All that a book is made of, gathered once: what was compiled, and what was found out of it."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final, final

from runtime import architecture_artifact, scenario_artifact
from runtime.architecture import Architecture, Node
from runtime.progress import Progress
from runtime.scenario import Scenario
from runtime.world.model import Body
from spec_schema.diagnostics import Diagnostic
from specc import loading
from specc.book.manifest import ARTIFACTS, Setting
from specc.book.rehearsing import trial_of
from specc.book.settings import DEFAULT, settings_of
from specc.book.sources import Sources, sources_of
from specc.book.speeds import speeds_at
from specc.book.tables import Sheet, sheets_of
from specc.book.trials import NO_TRIAL, Trial
from specc.book.views import Decisions, View, decisions_at, views_at
from specc.faults import fault
from specc.figures.rate_plane import RatePlane
from specc.origins import renamed
from specc.scenarios.simulating import Simulation, simulate_scenario
from verifier.report.requirement_results import RequirementResult

LIGHT: Final = 1.0
"""Seconds between two pictures of the light on the floor."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Shown:
    """A node with what the book shows of it beside its spec; nothing of what is no behavior."""

    node: Node
    settings: tuple[Setting, ...] = ()
    portraits: tuple[View, ...] = ()
    decisions: tuple[Decisions, ...] = ()
    speeds: tuple[RatePlane, ...] = ()
    sheets: tuple[Sheet, ...] = ()
    trial: Trial = NO_TRIAL


@final
@dataclass(frozen=True, eq=False, slots=True)
class Drawn:
    """An architecture with its body, and what is shown of each node, in their order."""

    architecture: Architecture
    body: Body
    notes: tuple[str, ...]
    robots: tuple[str, ...]
    nodes: tuple[Shown, ...]


@final
@dataclass(frozen=True, eq=False, slots=True)
class Contents:
    """A book's contents. Every file in what was compiled is named as it is in the book.

    scenario: None of the book of an architecture. run: of the scenario, with its own seed.
    artifact: its bytes.
    """

    name: str
    about: str
    spec: str
    sources: Sources
    artifact: bytes
    scenario: Scenario | None
    run: Simulation | None
    architectures: tuple[Drawn, ...]
    warnings: tuple[Diagnostic, ...]

    @property
    def kind(self) -> str:
        """What the book is of."""
        return "architecture" if self.scenario is None else "scenario"

    @property
    def artifact_name(self) -> str:
        """The file of its program."""
        return ARTIFACTS[self.kind]

    @property
    def results(self) -> tuple[RequirementResult, ...]:
        """What the run showed of each requirement."""
        return () if self.run is None else self.run.requirements


def gathered(path: Path, progress: Progress, *, allow_code: bool = False) -> Contents:
    """Compile an architecture or a scenario, and find out all that its book shows.

    Raises:
        SpecError: with everything that is wrong with it; or it is neither (V430).
    """
    kind = loading.kind_of(path)
    if path.suffix == ".specc" or kind not in {"architecture", "scenario"}:
        message = "a book is made of the spec of an architecture or of a scenario"
        raise fault("V430", path, message, "name such a spec (.yaml)")
    if kind == "scenario":
        return _of_scenario(path, progress, allow_code=allow_code)
    return _of_architecture(path, progress, allow_code=allow_code)


def _of_architecture(path: Path, progress: Progress, *, allow_code: bool) -> Contents:
    made = loading.compile_architecture_spec(path, progress, allow_code=allow_code)
    sources = sources_of(path, made.architecture, made.body)
    architecture = renamed(made.architecture, sources.name_of)
    body = renamed(made.body, sources.name_of)
    return Contents(
        name=architecture.name,
        about=architecture.about,
        spec=architecture.source.file,
        sources=sources,
        artifact=architecture_artifact.to_bytes(architecture, body),
        scenario=None,
        run=None,
        architectures=(drawn(architecture, body, made.notes, (), progress),),
        warnings=made.warnings,
    )


def _of_scenario(path: Path, progress: Progress, *, allow_code: bool) -> Contents:
    made = loading.compile_scenario_spec(path, progress, allow_code=allow_code)
    sources = sources_of(path, made.scenario)
    scenario = renamed(made.scenario, sources.name_of)
    alike: dict[str, list[str]] = {}
    for robot in scenario.robots:
        alike.setdefault(robot.architecture.source.file, []).append(robot.name)
    first = {robot.architecture.source.file: robot for robot in reversed(scenario.robots)}
    _refuse_alike(path, [robot.architecture for robot in first.values()])
    return Contents(
        name=scenario.name,
        about=scenario.about,
        spec=scenario.source.file,
        sources=sources,
        artifact=scenario_artifact.to_bytes(scenario),
        scenario=scenario,
        run=simulate_scenario(
            made.scenario, allow_code=allow_code, light_every=LIGHT, progress=progress
        ),
        architectures=tuple(
            drawn(first[file].architecture, first[file].body, (), tuple(robots), progress)
            for file, robots in alike.items()
        ),
        warnings=made.warnings,
    )


def _refuse_alike(path: Path, architectures: Sequence[Architecture]) -> None:
    """Stop where several files have architectures of one name: pages are called by it.

    Raises:
        SpecError: two do (V437).
    """
    for place, one in enumerate(architectures):
        for other in architectures[:place]:
            if one.name == other.name:
                message = f"{other.source.file} and {one.source.file} are both named '{one.name}'"
                raise fault("V437", path, message, "give one of them another `name`")


def drawn(
    architecture: Architecture,
    body: Body,
    notes: tuple[str, ...],
    robots: tuple[str, ...],
    progress: Progress,
) -> Drawn:
    """What the book shows of each node of an architecture."""
    nodes = []
    for done, node in enumerate(architecture.nodes):
        progress(f"looking at {node.name}", done, len(architecture.nodes))
        trial = trial_of(architecture, body, node)
        nodes.append(replace(_shown(architecture, node), trial=trial))
    return Drawn(architecture, body, notes, robots, tuple(nodes))


def _shown(architecture: Architecture, node: Node) -> Shown:
    if node.behavior >= 0:
        return _behavior(architecture, node)
    if node.arbiter < 0:
        return Shown(node)
    arbiter = architecture.arbiters[node.arbiter]
    plan = arbiter.plan
    if plan is None:
        settings, _ = settings_of(architecture, node)
        return Shown(node, settings, decisions=decisions_at(arbiter, settings))
    held = {control.name: control.default for control in plan.controls}
    return Shown(node, portraits=views_at(plan, (Setting(DEFAULT, (), held),)))


def _behavior(architecture: Architecture, node: Node) -> Shown:
    program = architecture.programs[node.behavior]
    settings, wired = settings_of(architecture, node)
    sheets = tuple(
        sheet
        for setting in settings
        for sheet in sheets_of(program, setting.name, setting.controls, wired)
    )
    views, speeds = views_at(program, settings), speeds_at(program, settings)
    return Shown(node, settings, views, sheets=sheets, speeds=speeds)
