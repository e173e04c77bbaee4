"""The page of a scenario: its world, what is required, and what a run showed."""

from collections.abc import Iterator

from runtime.scenario import Scenario
from runtime.world.model import World
from specc.book.chapters import Block, Bullets, Chapter, Figure, Paragraph, Section, Table
from specc.book.contents import Contents
from specc.book.naming import RUN, Names
from specc.book.words.source import author_words, spec_section
from specc.figures.quantities import number, seconds
from verifier.report.requirement_results import Outcome

SIGNS = {Outcome.SATISFIED: "✓", Outcome.VIOLATED: "✗", Outcome.OPEN: "?"}


def scenario_chapter(contents: Contents, scenario: Scenario, names: Names) -> Chapter:
    """The scenario in which the architecture was tried."""
    words = author_words(scenario.source.text)
    sections = (
        Section("What it is", tuple(map(Paragraph, words))),
        Section("What is required of a run", tuple(_required(contents, scenario))),
        Section("The world", tuple(_world(scenario, names))),
        spec_section(scenario.source, "The spec of the scenario"),
        spec_section(scenario.world.source, "The spec of the world"),
    )
    return Chapter(
        "scenario",
        "scenario",
        f"Scenario {scenario.name}",
        scenario.about,
        tuple(section for section in sections if section.blocks),
    )


def _required(contents: Contents, scenario: Scenario) -> Iterator[Block]:
    lasts = seconds(scenario.duration)
    if contents.results:
        yield Paragraph(
            f"The run below is the scenario's own: seed {scenario.seed}, {lasts}, in steps of"
            f" {number(scenario.step * 1e3, 6)} ms. The last column is what decides; a run with"
            " another seed is another one."
        )
        rows = tuple(
            (f"`{each.text}`", f"{SIGNS[each.outcome]} {each.outcome}", each.detail or "–")
            for each in contents.results
        )
        yield Table(("required", "in this run", "what decides"), rows)
    else:
        yield Paragraph(f"Nothing is required of a run; one lasts {lasts}.")
    yield Figure(RUN, "The run from above: where it went, and when.", f"trail of {scenario.name}")


def _world(scenario: Scenario, names: Names) -> Iterator[Block]:
    world = scenario.world
    if world.about:
        yield Paragraph(world.about)
    told = [_arena(world)]
    told += [f"`{thing.name}`: {_thing(thing.is_fixed, thing.mass)}." for thing in world.things]
    told += [
        f"`{each.name}`: {each.count} things laid at random by the seed, at least"
        f" {number(each.gap, 4)} m apart; {_thing(each.fixed >= 1.0, each.prototype.mass)}."
        for each in world.scattered
    ]
    told += [
        f"`{light.name}`: a light of {number(light.power, 4)} cd, {number(light.height, 4)} m above"
        " the floor."
        for light in world.lights
    ]
    robots = [
        f"`{robot.name}`: {_where(robot.start.pose is None)}, controlled by"
        f" [{robot.architecture.name}]({names.overview(robot.architecture)})."
        for robot in scenario.robots
    ]
    yield Bullets((*told, *robots))


def _arena(world: World) -> str:
    xs, ys = zip(*world.arena, strict=True)
    size = f"{number(max(xs) - min(xs), 4)} m by {number(max(ys) - min(ys), 4)} m"
    light = f"ambient light {number(world.ambient, 4)} lx"
    return f"An arena of {size}, {len(world.arena)} walls, {light}."


def _thing(is_fixed: bool, mass: float) -> str:  # noqa: FBT001
    return "fixed" if is_fixed else f"can be pushed, {number(mass, 4)} kg"


def _where(is_anywhere: bool) -> str:  # noqa: FBT001
    return (
        "starts anywhere that is free, by the seed" if is_anywhere else "starts where the spec says"
    )
