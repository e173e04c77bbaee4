"""What the thesis leaves open, each place a choice by name.

The first member of each is the default. What the others do to the figures of section 4.4 is
measured by `python -m tests.study.lcs readings`.
"""

from enum import IntEnum


class ErrorOf(IntEnum):
    """What a prediction error is a fraction of (4.3.3)."""

    REWARD = 0  # "as a fraction of the reward actually returned": wrong is 2 for +-1000
    RANGE = 1  # as the plots of system error have it: wrong is 1


class PredictionIs(IntEnum):
    """What becomes of a rule's prediction; the thesis has no rule that updates it."""

    FIXED = 0  # a sub-species is what eats one type of food
    AVERAGED = 1  # as in XCS, by `learning_rate`


class DamagedBy(IntEnum):
    """Which feedings count for Damaged (table 4.2)."""

    LATEST = 0
    ANY = 1  # once poisoned, always damaged


class StarvedAt(IntEnum):
    """Which strength is death: 4.3.3 says negative, table 4.2 has <= 0."""

    ZERO = 0  # of those that were just fed
    NEGATIVE = 1


class Order(IntEnum):
    """What follows the reward."""

    DIE_FIGHT_BREED = 0
    FIGHT_DIE_BREED = 1
    DIE_BREED_FIGHT = 2


class CoveredIs(IntEnum):
    """Whether the rule that covers an input eats the unit of food that was found there."""

    HUNGRY = 0
    FED = 1


class VoteOfNone(IntEnum):
    """The vote where all strengths are zero."""

    EQUAL = 0
    EMPTY = 1  # nobody votes: an empty set, which forces exploration


class SeedsAre(IntEnum):
    """Around whom breeding pools form: "an organism", "any time" (4.3.4)."""

    FED = 0  # each member of the action set that meets the criteria
    JUST_ABLE = 1  # those that met them only by this feeding


class NeighborsAre(IntEnum):
    """Among whom the nearest neighbors are looked for."""

    POPULATION = 0  # then those of another food-type count against the pool
    SUB_SPECIES = 1


class HalfOf(IntEnum):
    """Half of what has to meet the criteria, where there are fewer neighbors than asked for."""

    ALL_ASKED_FOR = 0
    THOSE_THERE_ARE = 1


class OffspringIn(IntEnum):
    """Whether offspring join the pool that they were born in."""

    POPULATION = 0
    POOL = 1


class Generalization(IntEnum):
    """The offspring's bounds in a dimension in which it generalizes."""

    HULL = 0  # of both parents
    HULL_AND_BEYOND = 1  # the hull, moved out by up to a tenth of its width


class MutationIs(IntEnum):
    """When offspring mutate: 4.3.4 reads as always, 4.6 says against duplicates only."""

    AGAINST_DUPLICATES = 0
    ALWAYS = 1


class FirstAggressor(IntEnum):
    """In which order fights are fought."""

    LARGEST = 0
    AS_THEY_STAND = 1


class RangeIs(IntEnum):
    """What volumes and cover fractions are fractions of."""

    EXPERIENCED = 0
    DECLARED = 1


class CorpseSpans(IntEnum):
    """The cover fractions of a corpse, before one is halved."""

    WIDTH_EACH = 0  # both are its width: what sprouts is as wide on average
    HALF_EACH = 1
    FROM_CENTER = 2  # from where it fed well to its bounds


class CorpsesLearn(IntEnum):
    """Which fractions of the neighbors a new corpse moves."""

    ALL = 0
    HALVED = 1


class CorpseRate(IntEnum):
    """The Widrow-Hoff rate at a distance d, "inversely proportional"."""

    CAPPED = 0  # min(1, corpse_rate / d)
    SHRUNK = 1  # 1 / (1 + d)
    RELATIVE = 2  # the nearest's distance / d


class SeedingBy(IntEnum):
    """Whose corpses end the seeding, and vote."""

    POPULATION = 0
    SUB_SPECIES = 1
