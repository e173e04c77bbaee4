"""xcsf, a classifier system in C, as its users drive it: the peer of ours.

It is GPL and stands in the extra `bench` alone. Its settings are those of our XCSR where both have
them; it adapts its mutation itself.
"""

from typing import Any, Final, final

import numpy as np
import xcsf

from lcs.arrays import Array, Integers

RIGHT, WRONG = 1000.0, -1000.0
SPREAD: Final = 0.5
"""How far covering reaches; the best of seven settings tried on the 6-multiplexer."""

TOURNAMENT: Final = {
    "select_type": "tournament",
    "select_size": 0.4,
    "theta_ea": 12,
    "lambda": 2,
    "p_crossover": 0.8,
    "err_reduc": 0.25,
    "fit_reduc": 0.1,
    "subsumption": True,
    "pred_reset": False,
}


def made(inputs: int, actions: int, outputs: int, most: int, seed: int, spread: float) -> Any:
    """A learner on one thread, of inputs from 0 to 1, with room for so many classifiers."""
    bounds = {"eta": 0, "min": 0, "max": 1, "spread_min": spread}
    return xcsf.XCS(
        x_dim=inputs,
        y_dim=outputs,
        n_actions=actions,
        omp_num_threads=1,
        random_state=seed,
        pop_size=most,
        pop_init=False,
        loss_func="mae",
        beta=0.2,
        alpha=0.1,
        nu=5,
        e0=10.0,
        delta=0.1,
        theta_del=20,
        theta_sub=20,
        ea=TOURNAMENT,
        action={"type": "integer"},
        condition={"type": "hyperrectangle_ubr", "args": bounds},
        prediction={"type": "constant"},
    )


@final
class OneByOne:
    """A reward of one action for each input: a call from Python for each, its fastest way there."""

    def __init__(
        self, inputs: int, actions: int, seed: int, most: int = 800, spread: float = SPREAD
    ) -> None:
        self.model = made(inputs, actions, 1, most, seed, spread)

    def learn(self, x: Array, rewards: Array, actions: Integers) -> None:
        fit = self.model.fit
        given = rewards[np.arange(len(x)), actions].tolist()
        for one, action, reward in zip(x, actions.tolist(), given, strict=True):
            fit(one, action, reward)

    def decide(self, x: Array) -> Integers:
        return best_of(self.model.predict(x))

    def rules(self) -> int:
        return int(self.model.pset_size())


@final
class Labelled:
    """The rewards of all actions of each input, in one call for many: its fastest way at all."""

    def __init__(
        self, inputs: int, actions: int, seed: int, most: int = 800, spread: float = SPREAD
    ) -> None:
        self.model = made(inputs, 1, actions, most, seed, spread)
        self.has_begun = False

    def learn(self, x: Array, rewards: Array, actions: Integers | None = None) -> None:  # noqa: ARG002
        self.model.set_params(max_trials=len(x), perf_trials=len(x))
        self.model.fit(x, rewards, shuffle=False, warm_start=self.has_begun, verbose=False)
        self.has_begun = True

    def decide(self, x: Array) -> Integers:
        return best_of(self.model.predict(x))

    def rules(self) -> int:
        return int(self.model.pset_size())


def best_of(predicted: Array) -> Integers:
    """The best actions (T,), -1 where some action is not covered, which it predicts as 0."""
    return np.where((predicted != 0.0).all(axis=1), predicted.argmax(axis=1), -1)


@final
class OnTable:
    """A classifier of tables: `OnTable(x, label, seed=1).predict(fresh)`.

    x (T, n), of any range; label (T,), from 0. The table is gone through in random order until
    `tries` rows have been learnt, all classes of each row rewarded with +-1000.
    """

    def __init__(
        self,
        x: Array,
        label: Integers,
        *,
        seed: int,
        tries: int = 100_000,
        most: int = 2000,
        spread: float = SPREAD,
    ) -> None:
        self.low, self.high = x.min(axis=0), x.max(axis=0)
        classes = int(label.max()) + 1
        rows = np.random.default_rng(seed).integers(len(x), size=tries)
        rewards = np.where(np.arange(classes) == label[:, None], RIGHT, WRONG)
        self.learner = Labelled(x.shape[1], classes, seed, most, spread)
        self.learner.learn(self._scaled(x[rows]), rewards[rows])

    def predict(self, x: Array) -> Integers:
        """The classes (T,); -1 where no rule holds."""
        return self.learner.decide(self._scaled(x))

    def rules(self) -> int:
        """How many it has."""
        return self.learner.rules()

    def _scaled(self, x: Array) -> Array:
        width = np.where(self.high > self.low, self.high - self.low, 1.0)
        return np.ascontiguousarray(np.clip((x - self.low) / width, 0.0, 1.0))
