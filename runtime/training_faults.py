"""What keeps a training from being done: one that was read from a file may hold anything."""

from collections.abc import Iterable, Iterator

from runtime.code import Code
from runtime.requirement_faults import faults_of as faults_of_requirement
from runtime.scenario import Robot
from runtime.tape import check_code
from runtime.training import How, Measure, Training


def faults_of(training: Training, robots: Iterable[Robot]) -> Iterator[str]:
    """What is wrong with a training, each in a sentence; nothing where it can be done."""
    if not learns(training, robots):
        yield f"'{training.arbiter}' is to be trained, and is no arbiter that learns"
    if not 0.0 <= training.discount <= 1.0:
        yield f"the training has the discount {training.discount!r}"
    for names in (training.register, training.quantities):
        if len(set(names)) != len(names):
            yield "the training names something twice"
    yield from _unreadable("the reward", training.reward, training.register)
    if training.ends_when is not None:
        yield from _unreadable("the end of an episode", training.ends_when, training.quantities)
    for measure in training.measures:
        yield from _of_measure(measure, training.quantities)


def learns(training: Training, robots: Iterable[Robot]) -> bool:
    """Whether there is such an arbiter, and it is one that learns."""
    for robot in robots:
        arbiters = robot.architecture.arbiters
        for node in robot.architecture.nodes:
            if (robot.name, node.name) == (training.robot, training.node):
                return 0 <= node.arbiter < len(arbiters) and arbiters[node.arbiter].learner != ""
    return False


def _of_measure(measure: Measure, quantities: tuple[str, ...]) -> Iterator[str]:
    of_run = measure.how is How.ROBUSTNESS
    if of_run != (measure.requirement is not None) or of_run == (measure.code is not None):
        yield f"the measure '{measure.name}' is not of a quantity or of a requirement"
    if measure.code is not None:
        yield from _unreadable(f"the measure '{measure.name}'", measure.code, quantities)
    if measure.requirement is not None:
        yield from faults_of_requirement(measure.requirement)


def _unreadable(what: str, code: Code, register: tuple[str, ...]) -> Iterator[str]:
    try:
        check_code(code, register)
    except ValueError as problem:
        yield f"{what} can't be worked out: {problem}"
