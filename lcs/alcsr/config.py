"""The constants of ALCSR by the thesis's names, and how its open places are read."""

import math
from dataclasses import dataclass, field, fields
from typing import Final, final

from lcs.alcsr.readings import (
    CorpseRate,
    CorpsesLearn,
    CorpseSpans,
    CoveredIs,
    DamagedBy,
    ErrorOf,
    FirstAggressor,
    Generalization,
    HalfOf,
    MutationIs,
    NeighborsAre,
    OffspringIn,
    Order,
    PredictionIs,
    RangeIs,
    SeedingBy,
    SeedsAre,
    StarvedAt,
    VoteOfNone,
)
from lcs.faults import LearnerError


@final
@dataclass(frozen=True, slots=True)
class Readings:
    """How the open places of the thesis are read; `lcs.alcsr.readings` says what each means."""

    error_of: ErrorOf = ErrorOf.REWARD
    prediction_is: PredictionIs = PredictionIs.FIXED
    damaged_by: DamagedBy = DamagedBy.LATEST
    starved_at: StarvedAt = StarvedAt.ZERO
    order: Order = Order.DIE_FIGHT_BREED
    covered_is: CoveredIs = CoveredIs.HUNGRY
    vote_of_none: VoteOfNone = VoteOfNone.EQUAL
    seeds_are: SeedsAre = SeedsAre.FED
    neighbors_are: NeighborsAre = NeighborsAre.POPULATION
    half_of: HalfOf = HalfOf.ALL_ASKED_FOR
    offspring_in: OffspringIn = OffspringIn.POPULATION
    generalization: Generalization = Generalization.HULL
    mutation_is: MutationIs = MutationIs.AGAINST_DUPLICATES
    first_aggressor: FirstAggressor = FirstAggressor.LARGEST
    range_is: RangeIs = RangeIs.EXPERIENCED
    corpse_spans: CorpseSpans = CorpseSpans.WIDTH_EACH
    corpses_learn: CorpsesLearn = CorpsesLearn.ALL
    corpse_rate: CorpseRate = CorpseRate.CAPPED
    seeding_by: SeedingBy = SeedingBy.POPULATION


@final
@dataclass(frozen=True, slots=True)
class Beyond:
    """What goes beyond the thesis, each a switch of its own; all are off at first.

    remembers: how many foods each landscape remembers; what follows needs some, but for `hunger`,
    `breeds` and `weighs_evidence`.
    sprouts: whoever is born grows before it lives; the best of so many bodies is born.
    grows: a body grows again when it holds twice the food, and reaches for food just outside.
    withdraws: poison makes a body smaller, where that costs it least, instead of weaker.
    famine: at the end of each season those starve whose food others eat too, and what nobody eats
    is settled. season: of so many foods at least.
    doubts: wrong food is told from noise, which is borne.
    hunger: who was not fed for so many foods of its landscape starves; 0 for never.
    breeds: whether there are breeding pools.
    weighs_evidence: votes count by the food that bodies hold, and not by strength per volume.
    """

    remembers: int = 0
    sprouts: int = 0
    grows: bool = False
    withdraws: bool = False
    famine: bool = False
    season: int = 500
    doubts: bool = False
    hunger: int = 0
    breeds: bool = True
    weighs_evidence: bool = False

    def __post_init__(self) -> None:
        """Refuse what needs a memory and has none.

        Raises:
            LearnerError: a switch needs `remembers`.
        """
        needy = ("sprouts", "grows", "withdraws", "famine", "doubts")
        asked = [name for name in needy if getattr(self, name)]
        if asked and self.remembers <= 0:
            raise LearnerError(
                f"{', '.join(asked)} needs a land that remembers: set remembers, 50000 for instance"
            )


CHANCES: Final = frozenset(
    {"explore", "immature_vote", "breeding_share", "generalize", "mutate", "mutation", "transfer"}
    | {"learning_rate"}
)
"""The constants that are chances or shares."""


@final
@dataclass(frozen=True, slots=True)
class Config:
    """Every constant of ALCSR: the thesis's name, its value and its section.

    explore: P(explore), the share of cycles that try an action at random (4.4).
    immature_vote: by what the vote of a rule that is not mature is weighed (4.3.2).
    error_cost, metabolism_cost: ErrorCost and MetabolismCost (4.3.3).
    damaged_error: the error beyond which a rule is Damaged (table 4.2).
    mature_level, breed_level: per unit of volume, MatureLevel and BreedLevel (4.3.4).
    breeding_neighbors: k_b. breeding_share: of the pool, "half or more" (4.3.4).
    generalize: the chance in each dimension that an offspring generalizes its parents (4.3.4).
    mutate, mutation: the chance of each bound, and by how much of the range at most (4.3.4).
    transfer: StrengthTransferFraction, stf (4.3.4).
    seeding: CoverFractions while the mausoleum holds fewer than `corpses` corpses (4.3.5).
    corpse_neighbors: k_c (4.3.5).

    Not in the thesis:

    corpse_rate: the constant of the Widrow-Hoff rate. sprout_width: what a corpse's fractions are
    multiplied with. learning_rate: where predictions are averaged.
    """

    explore: float = 0.9
    immature_vote: float = 0.1
    error_cost: float = 2000.0
    metabolism_cost: float = 1.0 / 50.0
    damaged_error: float = 0.01
    mature_level: float = 500.0
    breed_level: float = 376.0
    breeding_neighbors: int = 12
    breeding_share: float = 0.5
    generalize: float = 2.0 / 3.0
    mutate: float = 1.0 / 12.0
    mutation: float = 0.01
    transfer: float = 0.43
    seeding: float = 0.5
    corpses: int = 20
    corpse_neighbors: int = 5
    corpse_rate: float = 0.02
    sprout_width: float = 1.0
    learning_rate: float = 0.2
    readings: Readings = field(default_factory=Readings)
    beyond: Beyond = field(default_factory=Beyond)

    def __post_init__(self) -> None:
        """Refuse numbers that can't be what they are called.

        Raises:
            LearnerError: a chance or share is not from 0 to 1, or another number is negative.
        """
        for each in fields(self):
            value = getattr(self, each.name)
            if not isinstance(value, (int, float)):
                continue
            if each.name in CHANCES and not 0.0 <= value <= 1.0:
                raise LearnerError(f"{each.name} is from 0 to 1, and {value} is not")
            if not 0.0 <= value < math.inf:
                raise LearnerError(f"{each.name} is a number of 0 or more, and {value} is not")


GROWN: Final = Config(
    beyond=Beyond(
        remembers=50_000,
        sprouts=4,
        grows=True,
        withdraws=True,
        famine=True,
        doubts=True,
        breeds=False,
        weighs_evidence=True,
    )
)
"""All that makes it learn faster and with fewer rules: for users, and one set for all problems."""
