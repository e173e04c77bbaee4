"""The best list made plainer: what goes, what stays, and that trials decide."""

from dataclasses import replace

import numpy as np
import pytest

from lcs.policies.decision_list import DecisionList, always
from lcs.policies.learner import Found
from lcs.policies.steps import joined
from runtime.scenario import Scenario
from specc.training.challengers import policy_of
from specc.training.compaction import compacted, plainest
from specc.training.course import Generation, Took, Trial
from specc.training.last_race import LastRace
from specc.training.race import Racer, heat
from specc.training.workers import Workers
from tests.specc.training_scenes import SMALL, in_silence, pen_in
from verifier.report.requirement_results import Outcome

GO, TURN = 0, 1
WORLDS = range(8)
CAREFUL = always(GO, 1).with_rule(0, TURN, np.array([-np.inf]), np.array([0.61237]))


@pytest.fixture(scope="module")
def pen(tmp_path_factory: pytest.TempPathFactory) -> Scenario:
    """The scenario, in files of its own."""
    return pen_in(tmp_path_factory.mktemp("pen"))


def won_by(rules: DecisionList, workers: Workers) -> LastRace:
    """A last race that this list won."""
    winner = Racer(rules)
    heat([winner], None, WORLDS, workers, in_silence)
    one, took = Trial(0.0, 0.0, 0.0, 0), Took(0.0, 0.0, 0.0)
    return LastRace(
        Generation(1, 1, one, one, (), rules, is_new=True, raced=1, took=took), winner, WORLDS
    )


def known_from(race: LastRace, pen: Scenario) -> Found:
    """What is learnt where the winner came, as if the other action cost one wherever it decides."""
    lived = joined([each.steps for each in race.winner.episodes])
    found = policy_of(lived, pen, SMALL, 0)
    own = CAREFUL.decide(found.x)
    return replace(found, cost=1.0 - np.eye(2)[own], good=np.eye(2, dtype=np.bool_)[own])


def test_rules_conditions_and_digits_go_that_change_next_to_nothing(pen: Scenario) -> None:
    free, far = np.array([-np.inf]), np.array([1.99])
    wordy = CAREFUL.with_rule(0, GO, far, -free).with_rule(0, TURN, free, np.array([0.1]))
    with Workers(pen, 1) as workers:
        race = won_by(wordy, workers)
        kept = compacted(race, known_from(race, pen), workers, in_silence)

    assert len(kept.rules) == 1
    assert kept.rules.conditions == 1
    assert kept.rules.upper.item() in {0.6, 0.61}
    assert kept.trial.success == kept.before.success == 1.0


def test_a_rule_stays_that_trials_need_whatever_it_is_said_to_save(pen: Scenario) -> None:
    with Workers(pen, 1) as workers:
        race = won_by(CAREFUL, workers)
        found = known_from(race, pen)
        kept = compacted(race, replace(found, cost=0.0 * found.cost), workers, in_silence)

    assert kept.rules.upper.tolist() == [[0.61237]]
    assert kept.trial == kept.before


def test_the_plainest_is_no_more_than_a_standard_error_behind_the_best(pen: Scenario) -> None:
    with Workers(pen, 1) as workers:
        episode = won_by(CAREFUL, workers).winner.episodes[0]
    lost = replace(episode, outcomes=(Outcome.VIOLATED,))

    def racer(wins: int) -> Racer:
        return Racer(CAREFUL, [episode] * wins + [lost] * (100 - wins))

    # of 100 worlds with 80 wins the error is 4
    three = [racer(70), racer(80), racer(76)]
    assert plainest(three) is three[2]
    assert plainest([*three, racer(75)]) is three[2]
    assert plainest([racer(80), racer(75)]).standing[0] == 0.8
