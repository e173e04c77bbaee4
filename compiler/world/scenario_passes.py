"""Scenarios: robots in a world, the step of time, and what is required of the run."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import final

from compiler.architecture.library import Library
from compiler.architecture.passes import CompiledArchitecture, compile_parts
from compiler.architecture.times import (
    LEAST_STEP,
    SHORT_STEP,
    common,
    exact,
    seconds,
    short_step,
    step_of,
)
from compiler.findings import Findings
from compiler.lower_parts import origin_of
from compiler.requirement import Measured, lower_requirement
from compiler.world.meeting import check_sights, check_starts
from compiler.world.quantities_of_run import quantities_of
from compiler.world.shapes import pose_of, positive
from compiler.world.size import check_heights_with, is_small_enough
from compiler.world.starts import beginnings_of
from compiler.world.training import Span, lower_training, read_reward
from compiler.world.windows import check_window
from compiler.world.world import lower_world
from runtime.requirement import Requirement
from runtime.scenario import Robot, Scenario, Start
from runtime.training import Training
from spec_schema.architecture import ArchitectureSpec
from spec_schema.diagnostics import Diagnostic
from spec_schema.load import Loaded
from spec_schema.places import Path
from spec_schema.scenario import RobotSpec, ScenarioSpec
from spec_schema.world import WorldSpec


@final
@dataclass(frozen=True, eq=False, slots=True)
class CompiledScenario:
    """A scenario, the warnings on it and on what it names, and the choices on the way to it."""

    scenario: Scenario
    warnings: tuple[Diagnostic, ...]
    notes: tuple[str, ...] = ()


@final
@dataclass(eq=False, slots=True)
class Robots:
    """The robots of a scenario as they are read; the architectures each compiled once."""

    found: list[Robot] = field(default_factory=list)
    is_whole: bool = True
    compiled: dict[str, CompiledArchitecture | None] = field(default_factory=dict)
    notes: tuple[str, ...] = ()


def compile_parts_of_scenario(
    spec: ScenarioSpec,
    loaded: Loaded,
    library: Library,
    findings: Findings,
    seed: int | None = None,
) -> CompiledScenario | None:
    """The passes, in order; None where something can't be run, which the findings tell."""
    world = library.lowered(loaded, ("world",), spec.world, WorldSpec, lower_world, findings)
    robots = Robots()
    for name, robot in spec.robots.items():
        _add(name, robot, loaded, library, robots, findings)
    step = _step(spec, robots.found, findings)
    duration = positive(spec.duration, "s", "a duration", ("duration",), findings)
    beginnings: dict[str, float] = {}
    for one in robots.found:
        beginnings |= beginnings_of(one, spec.robots[one.name], findings)
    if world is not None:
        check_starts(world, robots.found, findings)
        check_sights(world, robots.found, findings)
        check_heights_with(world, robots.found, findings)
    known = quantities_of(world, robots.found) if world is not None and robots.is_whole else None
    requirements = _requirements(spec, known, duration, findings)
    training = _training(spec, known, robots.found, Span(duration, float(step)), findings)
    if world is None or not robots.is_whole or findings.has_errors:
        return None
    scenario = Scenario(
        name=spec.name,
        about=spec.about or "",
        world=world,
        robots=tuple(robots.found),
        duration=duration,
        step=float(step),
        seed=spec.seed if seed is None else seed,
        beginnings=beginnings,
        requirements=requirements,
        source=origin_of(loaded),
        training=training,
    )
    if not is_small_enough(scenario, findings):
        return None
    warnings = (*findings.diagnostics, *library.doubts)
    return CompiledScenario(scenario, warnings, (*findings.notes, *robots.notes))


def _add(
    name: str,
    spec: RobotSpec,
    loaded: Loaded,
    library: Library,
    robots: Robots,
    findings: Findings,
) -> None:
    path: Path = ("robots", name)
    pose = None if spec.at == "random" else pose_of(spec.at, (*path, "at"), findings)
    at = (*path, "architecture")
    found = library.spec(loaded, at, spec.architecture, "architecture", findings)
    if found is None or not isinstance(found.spec, ArchitectureSpec):
        robots.is_whole = False
        return
    file = found.source.name
    if file not in robots.compiled:
        own = Findings(found)
        robots.compiled[file] = compile_parts(found.spec, found, library, own)
        library.keep(found, own.diagnostics)
        robots.notes += own.notes
    compiled = robots.compiled[file]
    if compiled is None:
        robots.is_whole = False
        return
    robot = Robot(name, compiled.body, compiled.architecture, Start(pose), loaded.origin(path))
    robots.found.append(robot)


def _step(spec: ScenarioSpec, robots: list[Robot], findings: Findings) -> Fraction:
    """The longest step up to the wanted one that divides all times of all robots."""
    longest = exact(positive(spec.step, "s", "a step", ("step",), findings))
    if longest < LEAST_STEP:
        message = f"a step of {seconds(float(longest))} is shorter than 0.1 ms"
        findings.error("S352", ("step",), message, "write 'step: 1 ms' or more")
        return LEAST_STEP
    shared = Fraction(0)
    for robot in robots:
        with_it = common((shared, *map(exact, times_of(robot))))
        if 0 < with_it < LEAST_STEP:
            message = f"no step of 0.1 ms or more divides the times of {robot.name} and the others"
            remedy = "write times that are multiples of one another, or of 1 ms"
            findings.error("S352", ("robots", robot.name), message, remedy, key=True)
            return LEAST_STEP
        shared = with_it
    step = step_of(shared, longest) if shared else longest
    if step < LEAST_STEP:
        # Every divisor of what they share that is no longer than wanted is too short.
        message = f"a step up to {seconds(float(longest))} that divides all times is below 0.1 ms"
        findings.error("S352", ("step",), message, f"write 'step: {seconds(float(shared))}'")
    elif step < SHORT_STEP <= longest:
        _tell_short_step(robots, findings)
    return max(step, LEAST_STEP)


def _tell_short_step(robots: list[Robot], findings: Findings) -> None:
    """A warning where it is the times of several robots together; each by itself has its own."""
    each = [common(map(exact, times_of(robot))) for robot in robots]
    if all(one == 0 or one >= SHORT_STEP for one in each):
        message, remedy = short_step(exact(time) for robot in robots for time in times_of(robot))
        findings.warning("S355", ("robots", robots[-1].name), message, remedy, key=True)


def times_of(robot: Robot) -> list[float]:
    """Every time above 0 that a step must divide."""
    times = [time for s in robot.body.sensors for time in (s.every, s.latency)]
    times += [time for n in robot.architecture.nodes for time in (n.period, n.response_time)]
    return [time for time in times if time > 0.0]


def _requirements(
    spec: ScenarioSpec, known: Mapping[str, Measured] | None, duration: float, findings: Findings
) -> tuple[Requirement, ...]:
    if known is None:
        return ()  # what a run has is not known
    found = []
    for i, text in enumerate(spec.require):
        one = lower_requirement(text, ("require", i), known, findings)
        if one is not None:
            check_window(one, ("require", i), duration, findings)
            found.append(one)
    return tuple(found)


def _training(
    spec: ScenarioSpec,
    known: Mapping[str, Measured] | None,
    robots: Sequence[Robot],
    span: Span,
    findings: Findings,
) -> Training | None:
    if spec.train is None:
        return None
    if known is None:
        read_reward(spec.train, findings)  # the rest is of what a run has
        return None
    return lower_training(spec.train, robots, known, span, findings)
