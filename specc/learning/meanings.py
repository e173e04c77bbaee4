"""What each constant of a learner means, in a few words, and which do nothing as it is set."""

from collections.abc import Mapping
from typing import Any, Final

from lcs.alcsr.config import Config
from lcs.alcsr.readings import PredictionIs

ALCSR: Final[Mapping[str, str]] = {
    "explore": "share of cycles that try an action at random",
    "immature_vote": "what the vote of a rule that is not mature is weighed by",
    "error_cost": "what wrong food costs in strength",
    "metabolism_cost": "what a cycle costs in strength",
    "damaged_error": "error beyond which a rule is damaged",
    "mature_level": "foods per volume from which on a rule is mature",
    "breed_level": "strength per volume from which on a rule breeds",
    "breeding_neighbors": "nearest neighbors in a breeding pool",
    "breeding_share": "share of the pool that has to be able to breed",
    "generalize": "chance in each input that offspring span both parents",
    "mutate": "chance that a bound of offspring mutates",
    "mutation": "largest step of a mutation, as a share of the range",
    "transfer": "share of strength that parents give to offspring",
    "seeding": "how far what is born reaches at first, as a share of the range",
    "corpses": "corpses from which on rules are born as those had lived",
    "corpse_neighbors": "nearest corpses that say how wide a rule is born",
    "corpse_rate": "rate by which a new corpse moves its neighbors",
    "sprout_width": "what the width is multiplied with that corpses tell",
    "learning_rate": "rate of predictions that are averaged",
    "error_of": "what an error is a fraction of",
    "prediction_is": "what becomes of a rule's prediction",
    "damaged_by": "which feedings make a rule damaged",
    "starved_at": "which strength is death",
    "order": "what follows a reward, in this order",
    "covered_is": "whether a new rule eats the food that it was born for",
    "vote_of_none": "the vote where all strengths are zero",
    "seeds_are": "around whom breeding pools form",
    "neighbors_are": "among whom neighbors are looked for",
    "half_of": "half of what, where there are few neighbors",
    "offspring_in": "whether offspring join the pool that they were born in",
    "generalization": "the bounds of offspring that span both parents",
    "mutation_is": "when offspring mutate",
    "first_aggressor": "in which order fights are fought",
    "range_is": "what range shares of the range are of",
    "corpse_spans": "how a corpse's width is shared by its two sides",
    "corpses_learn": "which widths of its neighbors a corpse moves",
    "readings.corpse_rate": "how that rate falls with distance",
    "seeding_by": "whose corpses count",
    "remembers": "foods that each action's land remembers",
    "sprouts": "bodies that are grown, of which the best is born; 0 for none",
    "grows": "whether a body grows again when it holds twice the food",
    "withdraws": "whether a body shrinks from wrong food, instead of weakening",
    "famine": "whether those starve whose food others eat, too",
    "season": "foods between two famines, at least",
    "doubts": "whether noise is told from wrong food, and borne",
    "hunger": "foods after which who got none starves; 0 for never",
    "breeds": "whether rules breed",
    "weighs_evidence": "whether votes count by food held, not by strength",
}

XCSR: Final[Mapping[str, str]] = {
    "N": "classifiers at most",
    "beta": "rate of learning",
    "alpha": "accuracy right beyond epsilon_0",
    "epsilon_0": "error below which a classifier is accurate, in rewards",
    "nu": "how steeply accuracy falls with error",
    "gamma": "discount of what comes next, in problems of several steps",
    "theta_GA": "problems between two births in an action set, on average",
    "chi": "chance of crossover",
    "mu": "chance that a gene mutates",
    "theta_del": "experience from which on low fitness speeds deletion",
    "delta": "share of the mean below which fitness is low",
    "theta_sub": "experience that one needs to subsume",
    "theta_mna": "actions that have to be covered; 0 for all",
    "s_0": "largest half width of a covering interval, as a share of the range",
    "m_0": "largest step of a mutation, as a share of the range",
    "P_hash": "chance that covering leaves an input free",
    "p_I": "prediction at birth",
    "epsilon_I": "error at birth",
    "F_I": "fitness at birth",
    "ga_subsumption": "whether parents subsume offspring",
    "action_set_subsumption": "whether the most general of an action set subsumes",
    "selection": "how parents are chosen",
    "tau": "chance that each joins a tournament",
    "bounds": "how conditions are written down",
    "explore": "share of cycles that try an action at random",
    "outside": "what becomes of inputs outside the range",
}

STEPS: Final[Mapping[str, str]] = {
    "explore": "share of steps that try an action at random; those are remembered",
    "discount": "what a reward is worth one step later",
    "memories": "steps that are remembered at most, a fair sample of all",
    "fed": "memories of each action that a box needs",
    "families": "layers of boxes that vote together",
    "first": "tries after which boxes are first grown; anew whenever there were twice as many",
    "generations": "how often they are grown at such a time",
    "longest": "steps after which an episode is given up",
}

CONSTANTS: Final[Mapping[str, Mapping[str, str]]] = {
    "alcsr": ALCSR,
    "thesis": ALCSR,
    "xcsr": XCSR,
    "steps": STEPS,
}

OF_BREEDING: Final = (
    *("breed_level", "breeding_neighbors", "breeding_share", "generalize", "mutate", "mutation"),
    *("transfer", "seeds_are", "neighbors_are", "half_of", "offspring_in", "generalization"),
    "mutation_is",
)
OF_CORPSES: Final = (
    *("corpses", "corpse_neighbors", "corpse_rate", "sprout_width", "covered_is"),
    *("corpse_spans", "corpses_learn", "readings.corpse_rate", "seeding_by"),
)
OF_STRENGTH: Final = ("immature_vote", "error_cost", "damaged_error", "damaged_by", "error_of")
"""Where who tastes wrong food shrinks; the cost of living can starve those who share, all the same.
"""


def idle(config: Any) -> dict[str, str]:
    """What does nothing as a config is set, and while what holds."""
    if not isinstance(config, Config):
        return {}
    beyond, found = config.beyond, dict[str, str]()
    if not beyond.breeds:
        found |= dict.fromkeys(OF_BREEDING, "breeds=no")
    if beyond.sprouts > 0:
        found |= dict.fromkeys(OF_CORPSES, "sprouts > 0")
    if beyond.weighs_evidence and beyond.withdraws:
        found |= dict.fromkeys(OF_STRENGTH, "weighs_evidence and withdraws")
    if config.readings.prediction_is is PredictionIs.FIXED:
        found["learning_rate"] = "prediction_is=fixed"
    return found
