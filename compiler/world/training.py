"""The training of an arbiter in SI: whose it is, what is measured, and what that is worth."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import final

from compiler.findings import Findings
from compiler.lower_parts import code_of
from compiler.plain_numbers import parsed
from compiler.requirement import Measured, lower_requirement, read_quantity
from compiler.world.measured import check_measured
from compiler.world.windows import check_window
from runtime.arbiter import Arbiter
from runtime.architecture import Node
from runtime.code import Code
from runtime.requirement import Formula, Operator
from runtime.scenario import Robot
from runtime.training import How, Measure, Training
from spec_schema.expressions.rewrite import names_in, unknown_names
from spec_schema.expressions.tree import Expr
from spec_schema.faults import Fault
from spec_schema.places import Path
from spec_schema.requirement_words import words_of
from spec_schema.suggest import did_you_mean, there_are
from spec_schema.training import HOW, MeasureSpec, TrainingSpec

BASE: Path = ("train",)
NOTHING = Code("0.0")
FEWEST_STEPS = 1.5
"""Of the world in a period of what is trained: more than one, whatever was rounded."""


@final
@dataclass(frozen=True, slots=True)
class Span:
    """How long a run goes on, and how long each step of the world is; seconds."""

    duration: float
    step: float


def lower_training(
    spec: TrainingSpec,
    robots: Sequence[Robot],
    known: Mapping[str, Measured],
    span: Span,
    findings: Findings,
) -> Training:
    """The training of a scenario, with a finding for each mistake.

    known: the quantities of the run.
    """
    robot, node = _trained(spec.arbiter, robots, span.step, findings)
    reward = read_reward(spec, findings)
    quantities: dict[str, None] = {}
    measures = []
    for name, one in spec.measures.items():
        measure, read = _measure(name, one, known, span.duration, findings)
        measures.append(measure)
        quantities |= dict.fromkeys(sorted(read))
    ends_when, read = _end(spec.ends_when, known, findings)
    quantities |= dict.fromkeys(sorted(read))
    return Training(
        robot=robot,
        node=node,
        reward=reward,
        measures=tuple(measures),
        quantities=tuple(quantities),
        ends_when=ends_when,
        discount=spec.discount,
        origin=findings.origin(BASE),
    )


def read_reward(spec: TrainingSpec, findings: Findings) -> Code:
    """The reward over the measures, which are plain numbers; 0 of a bad one."""
    path = (*BASE, "reward")
    faults = [*_of_the_run(spec.reward)]
    expr = None if faults else parsed(spec.reward, path, findings)
    faults += [] if expr is None else unknown_names(expr, spec.measures)
    for fault in faults:
        findings.fault(path, fault)
    if expr is None or faults:
        return NOTHING
    _check_read(names_in(expr), spec, findings)
    return code_of(expr)


def _of_the_run(reward: str) -> Iterator[Fault]:
    """A fault for each quantity of the run that stands in a reward."""
    for word in words_of(reward)[0]:
        if word.is_name and "." in word.text:
            name = word.text.rpartition(".")[2]
            message = f"'{word.text}' is a quantity of the run, and a reward is made of measures"
            remedy = f"write `{name}` here, and `{name}: {{last: {word.text}}}` under `measures`"
            yield Fault(word.start, word.end, "S393", message, remedy)


def _check_read(read: frozenset[str], spec: TrainingSpec, findings: Findings) -> None:
    """A finding where the reward reads no measure, or not each of them."""
    if not read:
        message = "this reward is the same whatever the arbiter chooses: nothing can be learned"
        remedy = f"let it read a measure: {', '.join(spec.measures)}"
        findings.error("S393", (*BASE, "reward"), message, remedy)
        return
    for name in spec.measures:
        if name not in read:
            message = f"nothing reads '{name}'"
            at = (*BASE, "measures", name)
            findings.warning("S223", at, message, "use it in `reward`, or remove it", key=True)


def _trained(
    text: str, robots: Sequence[Robot], step: float, findings: Findings
) -> tuple[str, str]:
    """The robot and the node whose arbiter is trained; step: of the world, seconds."""
    path = (*BASE, "arbiter")
    nodes = [(f"{robot}.{node.name}", node, arbiter) for robot, node, arbiter in _nodes(robots)]
    arbiters = {name: (node, arbiter) for name, node, arbiter in nodes if arbiter is not None}
    if text not in arbiters:
        is_other = text in {name for name, _, _ in nodes}
        message = f"'{text}' is no arbiter" if is_other else f"no arbiter is named '{text}'"
        meant = "" if is_other else did_you_mean(text, sorted(arbiters))
        findings.error("S392", path, message, meant or there_are(sorted(arbiters)))
        return text, ""
    trained, arbiter = arbiters[text]
    if not arbiter.learner:
        message = f"'{text}' decides by {arbiter.way}, and what is trained decides by alcsr or xcsr"
        remedy = f"write `by: {{alcsr: {{}}}}` in {arbiter.source.file}"
        findings.error("S392", path, message, remedy)
    elif not arbiter.reads:
        message = f"'{text}' reads nothing, so there is nothing that rules could be about"
        findings.error("S392", path, message, "declare under `reads` what it decides by")
    elif trained.period < FEWEST_STEPS * step:
        every = f"{1000.0 * trained.period:g} ms"
        message = (
            f"'{text}' decides every {every}, and so does the world step: nothing is seen between"
            " two decisions"
        )
        findings.error("S392", path, message, "let it decide less often, or take a shorter `step`")
    robot, _, node = text.partition(".")
    return robot, node


def _nodes(robots: Sequence[Robot]) -> Iterator[tuple[str, Node, Arbiter | None]]:
    """Robot, node and arbiter, of all nodes."""
    for robot in robots:
        for node in robot.architecture.nodes:
            is_arbiter = node.arbiter >= 0
            arbiter = robot.architecture.arbiters[node.arbiter] if is_arbiter else None
            yield robot.name, node, arbiter


def _measure(
    name: str,
    spec: MeasureSpec,
    known: Mapping[str, Measured],
    duration: float,
    findings: Findings,
) -> tuple[Measure, frozenset[str]]:
    """A measure, and the quantities that its code reads."""
    how = next(How(key) for key in HOW if getattr(spec, key) is not None)
    path = (*BASE, "measures", name, how.value)
    origin, text = findings.origin((*BASE, "measures", name)), getattr(spec, how.value)
    if how is How.ROBUSTNESS:
        requirement = lower_requirement(text, path, known, findings)
        if requirement is not None:
            check_window(requirement, path, duration, findings)
        return Measure(name, how, None, requirement, origin), frozenset()
    expr: Expr | None = read_quantity(text, path, known, findings)
    if expr is None:
        return Measure(name, how, NOTHING, None, origin), frozenset()
    check_measured(expr, how, path, known, findings)
    return Measure(name, how, code_of(expr), None, origin), names_in(expr)


def _end(
    text: str | None, known: Mapping[str, Measured], findings: Findings
) -> tuple[Code | None, frozenset[str]]:
    """The margin of what ends an episode, and the quantities that it reads."""
    path = (*BASE, "ends_when")
    requirement = None if text is None else lower_requirement(text, path, known, findings)
    if requirement is None:
        return None, frozenset()
    parts: list[Code] = []
    for formula in requirement.formula:
        count = formula.operator.operands
        operands = parts[len(parts) - count :] if count else []
        del parts[len(parts) - count : len(parts) if count else 0]
        joined = _joined(formula, operands)
        if joined is None:
            message = f"'{formula.operator}' looks ahead, and an episode ends at one instant"
            findings.error("S394", path, message, "write a comparison alone: `r.clearance < 1 cm`")
            return None, frozenset()
        parts.append(joined)
    return parts[-1], frozenset(requirement.quantities)


def _joined(formula: Formula, operands: Sequence[Code]) -> Code | None:
    """The margin of a part of a condition; None of one that speaks of other instants."""
    texts = [one.text for one in operands]
    match formula.operator:
        case Operator.PREDICATE:
            return formula.margin
        case Operator.NOT:
            return Code(f"{texts[0]} neg")
        case Operator.AND:
            return Code(f"{texts[0]} {texts[1]} min")
        case Operator.OR:
            return Code(f"{texts[0]} {texts[1]} max")
        case Operator.IMPLIES:
            return Code(f"{texts[0]} neg {texts[1]} max")
    return None
