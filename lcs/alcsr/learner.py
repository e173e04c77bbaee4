"""ALCSR as one uses it: cycle by cycle, or over many problems at once."""

from dataclasses import dataclass
from typing import Any, Final, Self, final

import numpy as np
import numpy.typing as npt

from lcs.alcsr.config import Config
from lcs.alcsr.kernels import cycle
from lcs.alcsr.kernels.layout import (
    ACTION,
    STAGE,
    UNEATEN,
    UNTENDED,
    Corpses,
    Land,
    Numbers,
    Rules,
    Scratch,
)
from lcs.alcsr.kernels.tending import tend
from lcs.alcsr.population import Population, all_arrays, empty, restored
from lcs.alcsr.readings import RangeIs
from lcs.arrays import Array, Integers
from lcs.configs import config_of
from lcs.course import Course
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
from lcs.state import State, array_named, chance_from, from_plain, plain_of, plain_of_chance

REWARD_RANGE: Final = 2000.0
"""From -1000 to 1000 (4.3.2)."""

TINY: Final = 1e-12
"""The weight of those with no strength: they vote where nobody else does."""


@final
@dataclass(frozen=True, slots=True)
class Kept:
    """What is saved of a learner beside its arrays."""

    actions: int
    inputs: int
    reward_range: float
    config: Config
    chance: dict[str, Any]
    has_acted: bool
    is_trying: bool


@final
class ALCSR:
    """A learner with a random state of its own.

    Args:
        actions: how many there are.
        inputs: how many numbers an input has.
        config: the constants, and how open places of the thesis are read.
        reward_range: from the lowest to the highest reward.
        low, high: the declared range of the inputs: of all, or (n,). What is experienced widens it,
            but in the reading `RangeIs.DECLARED`, which needs one.
        seed: of all its chance.

    Raises:
        LearnerError: that reading has no range, or something given is not what it has to be.
    """

    def __init__(
        self,
        actions: int,
        inputs: int,
        config: Config | None = None,
        *,
        reward_range: float = REWARD_RANGE,
        low: npt.ArrayLike | None = None,
        high: npt.ArrayLike | None = None,
        seed: int = 0,
    ) -> None:
        actions, inputs = count_of(actions, "actions"), count_of(inputs, "inputs")
        self.config = config_of(Config, config)
        self.population: Population = empty(actions, inputs, self.config, reward_of(reward_range))
        if low is not None and high is not None:
            land = self.population.land
            land.low[:], land.high[:] = range_of(low, high, inputs)
        elif self.config.readings.range_is is RangeIs.DECLARED:
            raise LearnerError("RangeIs.DECLARED needs a range of the inputs: give low= and high=")
        self.chance = chance_of(seed)
        self._has_acted = False
        self._waits_with: Array | None = None

    def act(self, x: npt.ArrayLike) -> int:
        """The action on an input (n,): tried, or the best; `learn` follows one that was tried.

        Raises:
            LearnerError: not n finite numbers, or the reward of the action before is owed.
        """
        self._refuse_while_waiting()
        given = self._checked(x)
        actions = self.population.rules.living.size
        while True:
            said = int(cycle.begin(*self._parts(), given, self.chance))
            if said < actions:
                break
            self.population.make_room()
        self._has_acted = True
        if said < 0:
            return -1 - said
        self._waits_with = given
        return said

    @property
    def is_trying(self) -> bool:
        """Whether the last action was tried and waits for its reward."""
        return self._waits_with is not None

    def learn(self, reward: float) -> None:
        """The reward of the action that was tried; of one that was a test nothing is learnt.

        Raises:
            LearnerError: the reward is not finite, or there is no action that it is for.
        """
        given = reward_of(reward)
        if not self._has_acted:
            raise LearnerError(NO_ACTION)
        self._has_acted = False
        if self._waits_with is None:
            return
        owed = np.full((1, self.population.rules.living.size), given)
        self._run(self._waits_with[None], owed, cycle.OWED)
        self._waits_with = None

    def give_up(self) -> None:
        """No reward will come for the last action, because what it was part of has ended."""
        self._has_acted, self._waits_with = False, None

    def run(self, inputs: npt.ArrayLike, rewards: npt.ArrayLike) -> Course:
        """A cycle for each input (T, n), where action a would be given rewards (T, A).

        Raises:
            LearnerError: they are of other sizes or not finite, or a reward is owed.
        """
        x, given = self._problems(inputs, rewards)
        told, errors = self._run(x, given, cycle.CYCLES)
        kind, action, rules, births, deaths = told.T
        return Course(kind, action, errors, rules, births, deaths)

    def teach(self, inputs: npt.ArrayLike, rewards: npt.ArrayLike) -> None:
        """Learn the rewards of all actions (T, A) for each input (T, n), as where labels are known.

        A row is a cycle for each action in turn, none of which is chosen.

        Raises:
            LearnerError: they are of other sizes or not finite, or a reward is owed.
        """
        self._run(*self._problems(inputs, rewards), cycle.ALL)

    def decide(self, inputs: npt.ArrayLike) -> tuple[Integers, Array]:
        """The best actions (T,), -1 where some action is unknown, and expected rewards (T, A).

        Nothing is learnt. Of equal actions one is taken at random, by a state of its own.

        Raises:
            LearnerError: not n finite numbers each.
        """
        x = self._all_checked(inputs)
        actions = np.zeros(len(x), np.int64)
        expected = np.zeros((len(x), self.population.rules.living.size))
        parts = self.population
        waiting = parts.scratch  # whose action sets `learn` still needs
        cycle.decide(
            parts.rules,
            parts.land,
            parts.numbers,
            waiting._replace(fed=waiting.fed.copy(), fed_count=waiting.fed_count.copy()),
            x,
            actions,
            expected,
            np.random.default_rng(0),
        )
        return actions, expected

    def rules(self) -> RuleTable:
        """What it knows now, as rules; their weight is what their vote counts (4.3.2)."""
        rules, land = self.population.rules, self.population.land
        living = [slice(0, int(count)) for count in rules.living]

        def of_all(values: Any) -> Any:
            return np.concatenate([values[a, those] for a, those in enumerate(living)])

        weights = np.zeros_like(rules.strength)
        cycle.weigh(rules, land, self.population.numbers, weights)
        weight = of_all(weights)
        weight[~np.isfinite(weight)] = 0.0
        return RuleTable(
            actions=rules.living.size,
            action=np.repeat(np.arange(rules.living.size), rules.living),
            lower=of_all(rules.lower),
            upper=of_all(rules.upper),
            prediction=of_all(rules.prediction),
            weight=np.maximum(weight, TINY),
            right=of_all(rules.right),
            wrong=of_all(rules.wrong),
            low=land.low.copy(),
            high=land.high.copy(),
        )

    def state(self) -> State:
        """All that it is, now; between an action and its reward too."""
        kept = Kept(
            actions=self.population.rules.living.size,
            inputs=self.population.land.low.size,
            reward_range=self.population.numbers.reward_range,
            config=self.config,
            chance=plain_of_chance(self.chance),
            has_acted=self._has_acted,
            is_trying=self.is_trying,
        )
        arrays = dict(all_arrays(self.population))
        if self._waits_with is not None:
            arrays["waits_with"] = self._waits_with.copy()
        return State("ALCSR", plain_of(kept), arrays)

    @classmethod
    def from_state(cls, state: State) -> Self:
        """The learner that had this state: it goes on bit for bit as that one would.

        Raises:
            LearnerError: the state is of another version, or damaged.
        """
        kept = from_plain(Kept, state.plain, "values")
        learner = cls(
            kept.actions,
            kept.inputs,
            kept.config,
            reward_range=kept.reward_range,
            low=0.0,  # until what was known of the land is restored
            high=1.0,
        )
        learner.population = restored(learner.population, state.arrays)
        learner.chance = chance_from(kept.chance)
        learner._has_acted = kept.has_acted
        if kept.is_trying:
            learner._waits_with = learner._checked(array_named("waits_with", state.arrays))
        return learner

    def _run(self, x: Array, rewards: Array, what: int) -> tuple[Integers, Array]:
        told, errors = np.zeros((len(x), 5), np.int64), np.zeros(len(x))
        done = 0
        while done < len(x):
            done = cycle.run(*self._parts(), x, rewards, done, what, told, errors, self.chance)
            if done < len(x):
                self._go_on(x[done], rewards[done])
        return told, errors

    def _go_on(self, x: Array, rewards: Array) -> None:
        """Do what the kernels stopped for."""
        parts = self.population
        progress = parts.scratch.progress
        if progress[STAGE] in (UNEATEN, UNTENDED):
            reward = float(rewards[progress[ACTION]])
            tend(parts.rules, parts.land, parts.numbers, parts.scratch, x, reward, self.chance)
        else:
            parts.make_room()

    def _parts(self) -> tuple[Rules, Corpses, Land, Numbers, Scratch]:
        parts = self.population
        return parts.rules, parts.corpses, parts.land, parts.numbers, parts.scratch

    def _refuse_while_waiting(self) -> None:
        if self._waits_with is not None:
            raise LearnerError("the action before waits for its reward: call learn(reward) first")

    def _problems(self, inputs: npt.ArrayLike, rewards: npt.ArrayLike) -> tuple[Array, Array]:
        self._refuse_while_waiting()
        x = self._all_checked(inputs)
        return x, rewards_of(rewards, len(x), self.population.rules.living.size)

    def _checked(self, x: npt.ArrayLike) -> Array:
        return input_of(x, self.population.land.low.size)

    def _all_checked(self, inputs: npt.ArrayLike) -> Array:
        return inputs_of(inputs, self.population.land.low.size)
