"""A learner for delayed rewards: the land remembers steps, and bodies divide in it."""

from dataclasses import dataclass
from typing import Any, Final, Self, final

import numpy as np
import numpy.typing as npt

from lcs.arrays import Array, Booleans, Integers
from lcs.configs import config_of
from lcs.faults import LearnerError
from lcs.given import chance_of, count_of, input_of, inputs_of, reward_of
from lcs.problems.steps import Plane, World
from lcs.rules.table import RuleTable
from lcs.state import (
    State,
    array_named,
    arrays_of,
    chance_from,
    from_plain,
    plain_of,
    plain_of_chance,
)
from lcs.steps.config import Config, refuse_unfit
from lcs.steps.kernels import episodes, growing, voting
from lcs.steps.kernels.layout import Bodies, Numbers
from lcs.steps.population import empty_land, one_body, restored_bodies, restored_land

LONGEST: Final = 500


@final
@dataclass(frozen=True, eq=False, slots=True)
class Episodes:
    """How E episodes went, all (E,).

    steps: how many. returns: the sum of their rewards, not discounted. reached: whether they ended
    by themselves, not given up. bodies: how many there were after it.
    """

    steps: Integers
    returns: Array
    reached: Booleans
    bodies: Integers


@final
@dataclass(frozen=True, slots=True)
class Kept:
    """What is saved of a learner beside its arrays.

    said: the action that waits for what it led to, as `voting.tried` says it; None for none.
    """

    actions: int
    inputs: int
    config: Config
    due: int
    chance: dict[str, Any]
    said: int | None


@final
class StepsLearner:
    """A learner for several steps with a random state of its own.

    Args:
        actions: how many there are.
        inputs: how many numbers a place has.
        config: the constants.
        seed: of all its chance.

    Raises:
        LearnerError: a constant is out of its range, or something given is not what it has to be.
    """

    def __init__(
        self, actions: int, inputs: int, config: Config | None = None, *, seed: int = 0
    ) -> None:
        actions, inputs = count_of(actions, "actions"), count_of(inputs, "inputs")
        self.config = config_of(Config, config)
        refuse_unfit(self.config)
        self.land = empty_land(self.config.memories, inputs)
        self.bodies = one_body(actions, inputs)
        self.due = self.config.first
        self.chance = chance_of(seed)
        self._waits: tuple[Array, int] | None = None

    @property
    def actions(self) -> int:
        """How many there are."""
        return int(self.bodies.meals.shape[1])

    @property
    def _n(self) -> int:
        return int(self.bodies.lower.shape[1])

    def act(self, x: npt.ArrayLike) -> int:
        """The action to take at a place (n,): the best, or by chance any; `learn` follows.

        Raises:
            LearnerError: not n finite numbers, or `learn` of the action before is owed.
        """
        if self._waits is not None:
            raise LearnerError(
                "the action before waits for what it led to: call learn(reward, next_x, done) first"
            )
        place = input_of(x, self._n)
        said = int(voting.try_once(self.bodies, place, self.config.explore, self.chance))
        self._waits = (place, said)
        return said if said >= 0 else -1 - said

    def learn(self, reward: float, next_x: npt.ArrayLike, done: bool) -> None:  # noqa: FBT001 as gymnasium says it
        """What the action led to: a reward, a place (n,), and whether the episode ends there.

        Only actions that were tried by chance are remembered, as in the thesis (4.4).

        Raises:
            LearnerError: no action waits, or something is not finite.
        """
        if self._waits is None:
            raise LearnerError("no action waits for what it led to: call act(x) first")
        given, after = reward_of(reward), input_of(next_x, self._n)
        place, said = self._waits
        if said >= 0:
            voting.remember_once(self.land, place, said, given, after, bool(done), self.chance)
        self._waits = None
        if done:
            self.end_episode()

    def end_episode(self) -> None:
        """Grow if it is time to; for episodes that are given up, since `learn` calls it else."""
        if self.land.seen[0] >= self.due:
            self.grow()
            self.due = 2 * int(self.land.seen[0])

    def grow(self) -> None:
        """Grow all bodies anew from what the land remembers."""
        self.bodies = Bodies(*growing.grow(self.land, self.bodies, self._numbers(), self.chance))

    def run(self, world: World, count: int, outside: np.random.Generator) -> Episodes:
        """Learn in so many episodes of a world; all chance of the world is `outside`.

        In a `Plane` episodes are compiled; any other world is asked step by step.

        Raises:
            LearnerError: the world has other actions or inputs.
        """
        self._fits(world)
        told, bodies, done = np.zeros((count, 3)), np.zeros(count, np.int64), 0
        while done < count:
            before = done
            if isinstance(world, Plane):
                done = self._run_compiled(world, told, done, outside)
            else:
                told[done] = self._one_episode(world, outside)
                done += 1
            bodies[before:done] = len(self.bodies.lower)
            self.end_episode()
            bodies[done - 1] = len(self.bodies.lower)
        return _told(told, bodies)

    def follow(
        self,
        world: Plane,
        starts: npt.ArrayLike,
        outside: np.random.Generator,
        longest: int = LONGEST,
    ) -> Episodes:
        """The best actions from each start (E, 2), nothing learnt; ties by a state of its own.

        An episode is given up after `longest` steps.

        Raises:
            LearnerError: the world has other actions or inputs.
        """
        self._fits(world)
        places = inputs_of(starts, self._n)
        told = np.zeros((len(places), 3))
        ties = np.random.default_rng(0)
        episodes.follow(world.square, self.bodies, places, longest, told, ties, outside)
        return _told(told, np.full(len(places), len(self.bodies.lower)))

    def decide(self, inputs: npt.ArrayLike) -> tuple[Integers, Array]:
        """The best actions (T,) at places (T, n), and what all are expected to lead to (T, A).

        What is unknown is expected to lead to -inf, and where nothing is known any action is best.

        Raises:
            LearnerError: not n finite numbers each.
        """
        x = inputs_of(inputs, self._n)
        actions, worth = np.zeros(len(x), np.int64), np.zeros((len(x), self.actions))
        voting.decide(self.bodies, x, actions, worth, np.random.default_rng(0))
        return actions, worth

    def rules(self) -> RuleTable:
        """What it knows, a rule for each body and action; a prediction is a discounted reward.

        A rule is right as often as its body has memories of the action: it expects their mean.
        """
        kept = min(int(self.land.seen[0]), len(self.land.action))
        places = self.land.x[:kept]
        low, high = (places.min(axis=0), places.max(axis=0)) if kept else (0.0, 1.0)
        n = self._n
        low, high = np.broadcast_to(low, n).astype(float), np.broadcast_to(high, n).astype(float)
        body, action = np.nonzero(self.bodies.meals)
        return RuleTable(
            actions=self.actions,
            action=action,
            lower=np.clip(self.bodies.lower, low, high)[body],
            upper=np.clip(self.bodies.upper, low, high)[body],
            prediction=self.bodies.expected[body, action],
            weight=np.ones(len(body)),
            right=self.bodies.meals[body, action],
            wrong=np.zeros(len(body), np.int64),
            low=low,
            high=high,
        )

    def state(self) -> State:
        """All that it is, now; between an action and what it led to, too."""
        kept = Kept(
            actions=self.actions,
            inputs=self._n,
            config=self.config,
            due=self.due,
            chance=plain_of_chance(self.chance),
            said=None if self._waits is None else self._waits[1],
        )
        arrays = arrays_of("land", self.land) | arrays_of("bodies", self.bodies)
        if self._waits is not None:
            arrays["waits_at"] = self._waits[0].copy()
        return State("StepsLearner", plain_of(kept), arrays)

    @classmethod
    def from_state(cls, state: State) -> Self:
        """The learner that had this state: it goes on bit for bit as that one would.

        Raises:
            LearnerError: the state is of another version, or damaged.
        """
        kept = from_plain(Kept, state.plain, "values")
        learner = cls(kept.actions, kept.inputs, kept.config)
        learner.land = restored_land(learner.land, kept.actions, state.arrays)
        learner.bodies = restored_bodies(learner.bodies, state.arrays)
        learner.due = kept.due
        learner.chance = chance_from(kept.chance)
        if kept.said is not None:
            if not -kept.actions <= kept.said < kept.actions:
                raise LearnerError(f"'values.said' is {kept.said}, and there is no such action")
            place = input_of(array_named("waits_at", state.arrays), kept.inputs)
            learner._waits = (place, kept.said)
        return learner

    def _run_compiled(
        self, world: Plane, told: Array, done: int, outside: np.random.Generator
    ) -> int:
        return int(
            episodes.learn(
                world.square,
                self.land,
                self.bodies,
                self._numbers(),
                self.due,
                done,
                told,
                self.chance,
                outside,
            )
        )

    def _one_episode(self, world: World, outside: np.random.Generator) -> tuple[int, float, bool]:
        x, returned = world.reset(outside), 0.0
        for steps in range(1, self.config.longest + 1):
            after, reward, done = world.step(x, self.act(x), outside)
            returned += reward
            if done:
                self.learn(reward, after, done=True)
                return steps, returned, True
            self.learn(reward, after, done=False)
            x = after
        return self.config.longest, returned, False

    def _numbers(self) -> Numbers:
        c = self.config
        return Numbers(c.explore, c.discount, c.fed, c.families, c.generations, c.longest)

    def _fits(self, world: World) -> None:
        n = self._n
        if (world.actions, world.inputs) != (self.actions, n):
            raise LearnerError(
                f"the world has {world.actions} actions and {world.inputs} inputs, "
                f"the learner {self.actions} and {n}"
            )


def _told(told: Array, bodies: Integers) -> Episodes:
    return Episodes(told[:, 0].astype(np.int64), told[:, 1], told[:, 2] > 0.0, bodies)
