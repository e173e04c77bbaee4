"""Worlds and runs that are larger than what can be run, found before anything is run."""

from collections.abc import Sequence

from compiler.findings import Findings
from runtime.run_size import MOST, bytes_of, gigabytes, longest
from runtime.scenario import Robot, Scenario
from runtime.world.heights import BITS, ranges_of
from runtime.world.model import World


def check_heights(world: World, findings: Findings) -> None:
    """A finding where the things of a world fill more ranges of height than can be told apart."""
    count = ranges_of(_heights(world))
    if count > BITS:
        key = "things" if world.things else "scatter"
        findings.error("S380", (key,), _too_many(world.name, count), _remedy(), key=True)


def check_heights_with(world: World, robots: Sequence[Robot], findings: Findings) -> None:
    """A finding where the robots' heights, with those of the things, are more than that."""
    bodies = [(robot.body.low, robot.body.high) for robot in robots]
    count = ranges_of([*_heights(world), *bodies])
    if count > BITS:
        message = _too_many(f"{world.name} with its robots", count)
        findings.error("S380", ("robots",), message, _remedy(), key=True)


def is_small_enough(scenario: Scenario, findings: Findings) -> bool:
    """Whether a run takes no more memory than it may, for it keeps all; a finding where not."""
    takes = bytes_of(scenario)
    if takes <= MOST:
        return True
    steps = scenario.duration / scenario.step
    message = (
        f"a run of {scenario.duration:.12g} s has {steps:.3g} steps and takes about "
        f"{gigabytes(takes)} of memory, of which {gigabytes(MOST)} are allowed"
    )
    remedy = f"write 'duration: {longest(scenario):.12g} s' or less"
    findings.error("S381", ("duration",), message, remedy)
    return False


def _heights(world: World) -> list[tuple[float, float]]:
    things = (*world.things, *(scatter.prototype for scatter in world.scattered))
    return [(thing.low, thing.high) for thing in things]


def _too_many(whose: str, count: int) -> str:
    return (
        f"what stands in {whose} fills {count} different ranges of height, "
        f"and the physics tells {BITS} apart"
    )


def _remedy() -> str:
    return "let some of them begin or end at the same height"
