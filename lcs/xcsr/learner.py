"""XCSR as one uses it: cycle by cycle, over several steps, or over many problems at once."""

from dataclasses import dataclass
from typing import Any, Self, final

import numpy as np
import numpy.typing as npt

from lcs.arrays import Array, Integers
from lcs.configs import config_of
from lcs.course import Course, Kind
from lcs.faults import LearnerError
from lcs.given import (
    NO_ACTION,
    chance_of,
    count_of,
    input_of,
    inputs_of,
    range_of,
    reward_of,
    rewards_of,
)
from lcs.rules.table import RuleTable
from lcs.state import State, chance_from, from_plain, plain_of, plain_of_chance
from lcs.xcsr.config import Config, Outside
from lcs.xcsr.kernels import cycle
from lcs.xcsr.kernels.layout import LINES, Classifiers, Numbers, Scratch, Space
from lcs.xcsr.population import Population, all_arrays, empty, restored, scratch_of


@final
@dataclass(frozen=True, slots=True)
class Plain:
    """What is saved of a learner beside its arrays."""

    actions: int
    low: tuple[float, ...]
    high: tuple[float, ...]
    config: Config
    chance: dict[str, Any]
    has_acted: bool
    is_trying: bool


@final
class XCSR:
    """A learner with a random state of its own.

    Args:
        actions: how many there are.
        inputs: how many numbers an input has.
        config: the constants.
        low, high: the range of the inputs: of all, or (n,).
        seed: of all its chance.

    Raises:
        LearnerError: constants that don't go together, or something given is not what it has to be.
    """

    def __init__(
        self,
        actions: int,
        inputs: int,
        config: Config | None = None,
        *,
        low: npt.ArrayLike = 0.0,
        high: npt.ArrayLike = 1.0,
        seed: int = 0,
    ) -> None:
        actions, inputs = count_of(actions, "actions"), count_of(inputs, "inputs")
        self.config = config_of(Config, config)
        _refuse_config(self.config, actions)
        self.actions = actions
        self.population: Population = empty(actions, self.config, *range_of(low, high, inputs))
        self.chance = chance_of(seed)
        self._has_acted = False
        self._is_trying = False

    def act(self, x: npt.ArrayLike) -> int:
        """The action on an input (n,): tried, or the best; `learn` follows one that was tried.

        Raises:
            LearnerError: not n finite numbers in the range, or a reward is owed.
        """
        self._refuse_while_waiting()
        action, kind = cycle.act(*self._parts(), self._inside(input_of(x, self._n)), self.chance)
        self._is_trying = kind != Kind.TEST
        self._has_acted = True
        return int(action)

    @property
    def is_trying(self) -> bool:
        """Whether the last action was tried and waits for its reward."""
        return self._is_trying

    def learn(self, reward: float, following: npt.ArrayLike | None = None) -> None:
        """The reward of the action that was tried; of one that was a test nothing is learnt.

        following: in a problem of several steps the input (n,) that comes next, unless it has
        ended; gamma times what is expected there counts as reward.

        Raises:
            LearnerError: the reward or the input is not finite, the input out of range, or there
                is no action that the reward is for.
        """
        given = reward_of(reward)
        if not self._has_acted:
            raise LearnerError(NO_ACTION)
        n = self._n
        after = np.zeros((0, n))
        if following is not None:
            after = self._inside(input_of(following, n))[None]
        if self._is_trying:
            cycle.learn(*self._parts(), given, after, self.chance)
        self._has_acted = self._is_trying = False

    def give_up(self) -> None:
        """No reward will come for the last action, because what it was part of has ended."""
        self._has_acted = self._is_trying = False

    def run(self, inputs: npt.ArrayLike, rewards: npt.ArrayLike) -> Course:
        """A cycle for each input (T, n), where action a would be given rewards (T, A).

        Raises:
            LearnerError: they are of other sizes, not finite or out of range, or a reward is owed.
        """
        x, given = self._problems(inputs, rewards)
        told, errors = np.zeros((len(x), 5), np.int64), np.zeros(len(x))
        cycle.run(*self._parts(), x, given, told, errors, self.chance)
        kind, action, rules, births, deaths = told.T
        return Course(kind, action, errors, rules, births, deaths)

    def teach(self, inputs: npt.ArrayLike, rewards: npt.ArrayLike) -> None:
        """Learn the rewards of all actions (T, A) for each input (T, n), as where labels are known.

        A row is a try of each action in turn, none of which is chosen.

        Raises:
            LearnerError: they are of other sizes, not finite or out of range, or a reward is owed.
        """
        x, given = self._problems(inputs, rewards)
        cycle.teach(*self._parts(), x, given, self.chance)

    def decide(self, inputs: npt.ArrayLike) -> tuple[Integers, Array]:
        """The best actions (T,), -1 where some action is unknown, and expected rewards (T, A).

        Nothing is learnt. Of equal actions one is taken at random, by a state of its own.

        Raises:
            LearnerError: not n finite numbers in the range each.
        """
        x = self._inside(inputs_of(inputs, self._n))
        actions, expected = np.zeros(len(x), np.int64), np.zeros((len(x), self.actions))
        them = self.population.classifiers
        scratch = scratch_of(self.actions, self._n, them.action.size)
        cycle.decide(them, scratch, x, actions, expected, np.random.default_rng(0))
        return actions, expected

    def rules(self) -> RuleTable:
        """What it knows now, as rules; their weight is their fitness."""
        them, space = self.population.classifiers, self.population.space
        living = slice(0, int(them.counts[LINES]))
        return RuleTable(
            actions=self.actions,
            action=them.action[living].copy(),
            lower=np.ascontiguousarray(them.lower[:, living].T),
            upper=np.minimum(them.upper[:, living].T, space.high),
            prediction=them.prediction[living].copy(),
            weight=them.fitness[living].copy(),
            right=them.right[living].copy(),
            wrong=them.wrong[living].copy(),
            low=space.low.copy(),
            high=space.high.copy(),
        )

    def state(self) -> State:
        """All that it is, now; between an action and its reward too."""
        space = self.population.space
        plain = Plain(
            actions=self.actions,
            low=tuple(space.low.tolist()),
            high=tuple(space.high.tolist()),
            config=self.config,
            chance=plain_of_chance(self.chance),
            has_acted=self._has_acted,
            is_trying=self.is_trying,
        )
        return State("XCSR", plain_of(plain), all_arrays(self.population))

    @classmethod
    def from_state(cls, state: State) -> Self:
        """The learner that had this state: it goes on bit for bit as that one would.

        Raises:
            LearnerError: the state is of another version, or damaged.
        """
        plain = from_plain(Plain, state.plain, "values")
        inputs = len(plain.low)
        learner = cls(plain.actions, inputs, plain.config, low=plain.low, high=plain.high)
        learner.population = restored(learner.population, state.arrays)
        learner.chance = chance_from(plain.chance)
        learner._has_acted = plain.has_acted
        learner._is_trying = plain.is_trying
        return learner

    @property
    def _n(self) -> int:
        return self.population.space.low.size

    def _parts(self) -> tuple[Classifiers, Space, Numbers, Scratch]:
        parts = self.population
        return parts.classifiers, parts.space, parts.numbers, parts.scratch

    def _refuse_while_waiting(self) -> None:
        if self._is_trying:
            raise LearnerError("the action before waits for its reward: call learn(reward) first")

    def _problems(self, inputs: npt.ArrayLike, rewards: npt.ArrayLike) -> tuple[Array, Array]:
        self._refuse_while_waiting()
        x = self._inside(inputs_of(inputs, self._n))
        return x, rewards_of(rewards, len(x), self.actions)

    def _inside(self, x: Array) -> Array:
        space = self.population.space
        if self.config.outside is Outside.CLIPPED:
            return np.clip(x, space.low, space.high)
        outside = (x < space.low) | (x > space.high)
        if outside.any():
            at = tuple(np.argwhere(outside)[0])
            low, high = space.low[at[-1]], space.high[at[-1]]
            raise LearnerError(
                f"number {at[-1]} of an input is {x[at]:g}, out of its range {low:g} to {high:g}: "
                "declare a wider one (low=, high=), or Config(outside=Outside.CLIPPED)"
            )
        return x


def _refuse_config(config: Config, actions: int) -> None:
    if actions < 1 or 2 * actions > config.N:
        raise LearnerError(f"{actions} actions need N of {2 * max(actions, 1)} at least")
    if config.epsilon_0 <= 0.0 or not 0.0 < config.beta <= 1.0:
        raise LearnerError("epsilon_0 must lie above 0, and beta above 0 and at most at 1")
    if not 0 <= config.theta_mna <= actions:
        raise LearnerError(f"theta_mna is 0 to {actions} of {actions} actions")
