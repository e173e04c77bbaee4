"""One episode: a run with an exploring arbiter in it, until it is over, and what it was worth."""

import dataclasses
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from time import process_time
from typing import Final, final

import numpy as np

from lcs.faults import LearnerError
from lcs.policies.policy import Policy
from lcs.policies.steps import Steps
from runtime.arbiter import Arbiter
from runtime.arrays import Array, Integers
from runtime.recording.live import LastTicks, Live
from runtime.scenario import Scenario
from runtime.scheduler.nodes import Learner
from runtime.scheduler.scheduler import Scheduler
from runtime.start import started
from runtime.training import How, Training
from specc.training.exploring import Exploring
from specc.training.rewards import ended_at, rewards_of
from verifier.architectures.required import results_on
from verifier.report.requirement_results import Outcome, RequirementResult

TRIES: Final = 1
"""What sets the chance of tries apart from all else that follows from a seed."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Task:
    """An episode to live: the world's seed, what decides, and how much it explores.

    tries: sets what it tries apart from what another episode in the same world does. first_try:
    see `Exploring`.
    """

    world: int
    policy: Policy
    explore: float
    tries: int = 0
    first_try: int | None = None


@final
@dataclass(frozen=True, eq=False, slots=True)
class Episode:
    """What came of an episode.

    total: the sum of its rewards. seconds: how long it lasted. outcomes: of what the scenario
    requires, as far as it went. running, rewarding: seconds of the processor, of the world with all
    that decides and acts in it, and of measuring and rewarding.
    """

    steps: Steps
    total: float
    seconds: float
    outcomes: tuple[Outcome, ...]
    running: float
    rewarding: float

    @property
    def places(self) -> Array:
        """All that was read in it (D + 1, m): at each decision, and where the last one led."""
        return np.concatenate([self.steps.x, self.steps.after[-1:]])

    @property
    def succeeded(self) -> bool:
        """Whether all that is required is satisfied."""
        return all(outcome is Outcome.SATISFIED for outcome in self.outcomes)


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Course:
    """How it went: rows (T, q) of quantities, one after each step of the world.

    decided (D + 1,): the row that each decision was made at, and the row where the last one's
    reward is due. ends: whether the episode ended with that. running: seconds of the processor, of
    the run alone.
    """

    rows: Array
    decided: Integers
    ends: bool
    running: float


def lived(scenario: Scenario, task: Task, ticks: LastTicks | None = None) -> Episode:
    """Live one episode of a scenario that trains; it ends where that says so, or with the run.

    ticks: who observes it, if anybody else does.

    Raises:
        NoRoomError: there is no room for what is placed at random.
        UserCodeError: the scenario needs Python of the user's own.
        LearnerError: a reward, or what is read, is not finite.
    """
    began = process_time()
    training, arbiter = training_of(scenario), trained_arbiter(scenario)
    scenario = dataclasses.replace(scenario, seed=task.world)
    exploring = Exploring(
        task.policy,
        len(arbiter.reads),
        len(arbiter.choices),
        task.explore,
        np.random.default_rng([task.world, TRIES, task.tries]),
        task.first_try,
    )
    ticks = ticks or LastTicks()
    learners = {training.arbiter: Learner(exploring, _nothing)}
    begun = started(scenario, learners=learners, observer=ticks)
    demands = [each.requirement for each in training.measures if each.requirement is not None]
    required = (*scenario.requirements, *demands)
    names = (*training.quantities, *(name for one in required for name in one.quantities))
    live = Live([*dict.fromkeys(names)], scenario, begun, ticks)
    course = _course(training, scenario, begun.scheduler, live, exploring)
    times = np.arange(1.0, len(course.rows) + 1.0) * scenario.step
    results = results_on(required, live.sampled(times, course.rows), float(times[-1]))
    own = len(scenario.requirements)
    rewards = rewards_of(training, course.rows, course.decided, _robustness(results[own:]))
    _refuse_endless(rewards)
    return Episode(
        steps=_steps(exploring, rewards, ends=course.ends),
        total=float(rewards.sum()),
        seconds=float(times[-1]),
        outcomes=tuple(result.outcome for result in results[:own]),
        running=course.running,
        rewarding=process_time() - began - course.running,
    )


def _refuse_endless(rewards: Array) -> None:
    """Stop where one is not finite: it would outweigh all others.

    Raises:
        LearnerError: one is not.
    """
    endless = np.flatnonzero(~np.isfinite(rewards))
    if len(endless):
        first = int(endless[0])
        raise LearnerError(f"the reward of decision {first} is not finite: {rewards[first]}")


def training_of(scenario: Scenario) -> Training:
    """What is trained in it.

    Raises:
        ValueError: nothing is.
    """
    if scenario.training is None:
        raise ValueError(f"'{scenario.name}' trains nothing")
    return scenario.training


def trained_arbiter(scenario: Scenario) -> Arbiter:
    """The arbiter that is trained, as it was before."""
    training = training_of(scenario)
    robot = next(robot for robot in scenario.robots if robot.name == training.robot)
    node = next(node for node in robot.architecture.nodes if node.name == training.node)
    return robot.architecture.arbiters[node.arbiter]


def _course(
    training: Training,
    scenario: Scenario,
    scheduler: Scheduler,
    live: Live,
    exploring: Exploring,
) -> _Course:
    """Run until it is over; whether it is, is asked at each decision."""
    instants = max(round(scenario.duration / scenario.step), 1)
    rows = np.empty((instants, live.count))
    decided: list[int] = []
    running = 0.0

    def course(end: int, *, ends: bool) -> _Course:
        until = [*decided, end] if ends else decided
        return _Course(rows[: end + 1], np.array(until), ends, running)

    for instant in range(instants):
        began = process_time()
        scheduler.step()
        running += process_time() - began
        rows[instant] = live.now()
        if len(exploring.choices) > len(decided):
            over = _over(training, rows[:instant], decided)
            if over >= 0:
                return course(over, ends=True)
            decided.append(max(instant - 1, 0))
    over = _over(training, rows, decided)
    if over >= 0:
        return course(over, ends=True)
    is_judged_whole = any(measure.how is How.ROBUSTNESS for measure in training.measures)
    return course(instants - 1, ends=is_judged_whole)


def _over(training: Training, rows: Array, decided: Sequence[int]) -> int:
    """The first of the rows after the last decision at which the episode is over, or -1."""
    since = decided[-1] + 1 if decided else 0
    found = ended_at(training, rows[since:, : len(training.quantities)])
    return found + since if found >= 0 else -1


def _steps(exploring: Exploring, rewards: Array, *, ends: bool) -> Steps:
    """The decisions whose rewards are known; what the last one led to is not, where it ended."""
    count = len(rewards)
    reads = np.array(exploring.reads)
    after = reads[1 : count + 1]
    if len(after) < count:
        after = np.concatenate([after, reads[-1:]])
    last = np.arange(count) == count - 1
    choices = np.array(exploring.choices[:count])
    return Steps(reads[:count], choices, rewards, after, last, last & ends)


def _robustness(results: Sequence[RequirementResult]) -> Mapping[str, float]:
    """By its text the robustness of each, finite where the episode ended before all was seen."""
    return {result.text: _as_far_as_seen(result) for result in results}


def _as_far_as_seen(result: RequirementResult) -> float:
    """The bound that decides; the other where nothing bounds it there, and 0 where nothing does."""
    bounds = result.robustness, result.low, result.high
    return next((bound for bound in bounds if np.isfinite(bound)), 0.0)


def _nothing() -> float:
    """Rewards are worked out after the run."""
    return 0.0
