"""The rules and corpses of one learner, and the room for them, which grows as need be."""

from dataclasses import asdict, dataclass, fields, replace
from typing import Any, Final, final

import numpy as np

from lcs.alcsr.config import Config
from lcs.alcsr.kernels.layout import Corpses, Land, Numbers, Rules, Scratch
from lcs.faults import LearnerError
from lcs.state import Arrays, arrays_of, filled

ROOM: Final = 1024
"""For rules and for corpses of each action, at first."""

SAMPLE: Final = 1500
"""How many foods are enough while a body takes shape."""


@final
@dataclass(slots=True)
class Population:
    """All that a learner knows; arrays are changed in place by kernels, and replaced to grow."""

    rules: Rules
    corpses: Corpses
    land: Land
    scratch: Scratch
    numbers: Numbers

    def make_room(self) -> None:
        """Twice the room where it is short."""
        if self.rules.living.max() + 1 >= self.rules.prediction.shape[1]:
            self.rules = Rules(self.rules.living, *(_longer(each) for each in self.rules[1:]))
        needed = (self.corpses.buried + self.scratch.fed_count).max()
        if needed >= self.corpses.prediction.shape[1]:
            self.corpses = Corpses(
                self.corpses.buried, *(_longer(each) for each in self.corpses[1:])
            )
        self.scratch = _wider(self.scratch, self.rules.prediction.shape[1])


def all_arrays(population: Population) -> Arrays:
    """Copies of all arrays by name; the constants are no part of them."""
    parts = {name: getattr(population, name) for name in _parts(population)}
    return {key: each for name in parts for key, each in arrays_of(name, parts[name]).items()}


def restored(population: Population, arrays: Arrays) -> Population:
    """What `all_arrays` were of; the population has as much room or less, and the same constants.

    Raises:
        LearnerError: an array is missing, or of another type or shape.
    """
    whole = replace(
        population,
        **{name: filled(name, getattr(population, name), arrays) for name in _parts(population)},
    )
    rules, corpses, scratch = whole.rules, whole.corpses, whole.scratch
    counts = ((rules.living, rules.prediction), (corpses.buried, corpses.prediction))
    if any(np.any((count < 0) | (count > room.shape[1])) for count, room in counts):
        raise LearnerError("there are more rules or corpses than room for them")
    if scratch.order.size != rules.prediction.shape[1]:
        raise LearnerError("'rules' and 'scratch' have not the same room")
    return whole


def _parts(population: Population) -> list[str]:
    return [each.name for each in fields(population) if each.name != "numbers"]


def empty(actions: int, inputs: int, config: Config, reward_range: float) -> Population:
    """Landscapes that nobody lives on, of which nothing is known."""
    return Population(
        _no_rules(actions, inputs),
        _no_corpses(actions, inputs),
        _unknown_land(actions, inputs, config),
        _scratch(actions, inputs, config),
        numbers_of(config, reward_range),
    )


def _no_rules(a: int, n: int) -> Rules:
    return Rules(
        living=np.zeros(a, np.int64),
        lower=np.zeros((a, ROOM, n)),
        upper=np.zeros((a, ROOM, n)),
        prediction=np.zeros((a, ROOM)),
        strength=np.zeros((a, ROOM)),
        experience=np.zeros((a, ROOM), np.int64),
        volume=np.zeros((a, ROOM)),
        right=np.zeros((a, ROOM), np.int64),
        wrong=np.zeros((a, ROOM), np.int64),
        right_center=np.zeros((a, ROOM, n)),
        wrong_center=np.zeros((a, ROOM, n)),
        damaged=np.zeros((a, ROOM), np.bool_),
        was_able=np.zeros((a, ROOM), np.bool_),
        fed_at=np.zeros((a, ROOM), np.int64),
        grows_at=np.zeros((a, ROOM), np.int64),
        meals=np.zeros((a, ROOM), np.int64),
        poisoned=np.zeros((a, ROOM), np.int64),
        core_meals=np.zeros((a, ROOM), np.int64),
        core_wrong=np.zeros((a, ROOM), np.int64),
    )


def _no_corpses(a: int, n: int) -> Corpses:
    return Corpses(
        buried=np.zeros(a, np.int64),
        center=np.zeros((a, ROOM, n)),
        prediction=np.zeros((a, ROOM)),
        lower=np.zeros((a, ROOM, n)),
        upper=np.zeros((a, ROOM, n)),
    )


def _unknown_land(a: int, n: int, config: Config) -> Land:
    known = config.beyond.remembers
    return Land(
        low=np.full(n, np.inf),
        high=np.full(n, -np.inf),
        foods=np.zeros((a, n, known)),
        rewards=np.zeros((a, known)),
        met=np.zeros(a, np.int64),
        noise=np.zeros(a),
        season=np.full(a, config.beyond.season),
        order=np.zeros((a, n, known), np.int64),
        sample=np.zeros((a, n, min(known, SAMPLE)), np.int64),
        ordered=np.zeros(a, np.int64),
    )


def _scratch(a: int, n: int, config: Config) -> Scratch:
    known = config.beyond.remembers
    neighbors = 1 + max(config.breeding_neighbors, config.corpse_neighbors)
    return Scratch(
        fed=np.zeros((a, ROOM), np.int64),
        fed_count=np.zeros(a, np.int64),
        order=np.zeros(ROOM, np.int64),
        dead=np.zeros(ROOM, np.bool_),
        pool=np.zeros(ROOM, np.int64),
        able=np.zeros(ROOM, np.int64),
        near=np.zeros(neighbors, np.int64),
        distance=np.zeros(neighbors),
        votes=np.zeros(a),
        fractions=np.zeros((2, n)),
        body=np.zeros((4, n)),
        axes=np.arange(n),
        place=np.zeros(n),
        losses=np.zeros(2 * n),
        values=np.zeros(known),
        signs=np.zeros(known),
        outside=np.zeros(known, np.int16),
        picked=np.zeros(known + 1, np.int64),
        eaters=np.zeros(known, np.int64),
        progress=np.array([-1, 0, 0, 0]),
        tally=np.zeros(5, np.int64),
    )


def numbers_of(config: Config, reward_range: float) -> Numbers:
    """The constants for kernels."""
    values = asdict(config)
    readings = values.pop("readings")
    readings["corpse_rate_is"] = readings.pop("corpse_rate")
    beyond = values.pop("beyond")
    return Numbers(
        **values,
        reward_range=reward_range,
        **{name: int(value) for name, value in (readings | beyond).items()},
    )


def _longer(values: Any) -> Any:
    grown = np.zeros((values.shape[0], 2 * values.shape[1], *values.shape[2:]), values.dtype)
    grown[:, : values.shape[1]] = values
    return grown


def _wider(scratch: Scratch, room: int) -> Scratch:
    if scratch.order.size >= room:
        return scratch
    more = room - scratch.order.size
    names = ("order", "dead", "pool", "able")
    wide = {name: np.pad(getattr(scratch, name), (0, more)) for name in names}
    return scratch._replace(fed=np.pad(scratch.fed, ((0, 0), (0, more))), **wide)
