"""Races of lists: who wins, in which worlds, and what a champion has to defend."""

from dataclasses import replace

import numpy as np
import pytest

from lcs.policies.decision_list import DecisionList, always
from runtime.progress import in_silence
from runtime.scenario import Scenario
from specc.training.course import Course, Generation, Took, Trial
from specc.training.last_race import last_race
from specc.training.race import LEFT, Racer, raced
from specc.training.remembered import Remembered
from specc.training.settings import Settings
from specc.training.workers import Workers
from tests.specc.training_scenes import pen_in
from verifier.report.requirement_results import Outcome

GO, TURN = 0, 1
WORLDS = range(8)


@pytest.fixture(scope="module")
def pen(tmp_path_factory: pytest.TempPathFactory) -> Scenario:
    """The scenario, in files of its own."""
    return pen_in(tmp_path_factory.mktemp("pen"))


def careful(room: float) -> DecisionList:
    """To turn where less room is ahead, and to go elsewhere."""
    counts = np.zeros(1, np.int64)
    lower, upper = np.array([[-np.inf]]), np.array([[room]])
    return DecisionList(np.array([TURN]), lower, upper, counts, counts, GO)


def test_who_satisfies_what_is_required_in_more_worlds_wins(pen: Scenario) -> None:
    blind, good = always(GO, 1), careful(0.6)
    with Workers(pen, 1) as workers:
        race = raced(blind, [blind, good, always(GO, 1)], WORLDS, workers, in_silence)

    assert race.winner.rules is good
    assert race.is_won
    assert len(race.winner.episodes) == len(WORLDS)


def test_of_equals_the_champion_stays(pen: Scenario) -> None:
    with Workers(pen, 1) as workers:
        race = raced(careful(0.6), [careful(0.6), always(GO, 1)], WORLDS, workers, in_silence)
    assert not race.is_won
    assert race.winner is race.holder


def test_who_is_only_a_little_luckier_does_not_beat_the_champion(pen: Scenario) -> None:
    with Workers(pen, 1) as workers:
        good = raced(None, [careful(0.6)], WORLDS, workers, in_silence).winner
    failed = replace(good.episodes[0], outcomes=(Outcome.VIOLATED,))

    def with_failures(count: int) -> Racer:
        return Racer(good.rules, episodes=[*([failed] * count), *good.episodes[count:]])

    assert all(each.succeeded for each in good.episodes)
    assert good.beats(with_failures(3))
    assert not good.beats(with_failures(1))
    assert not good.beats(good)


def test_only_few_go_on_to_all_worlds_and_all_decisions_are_counted(pen: Scenario) -> None:
    told: list[tuple[str, int, int]] = []
    lists = [careful(0.1 * i) for i in range(10)]
    with Workers(pen, 1) as workers:
        race = raced(None, lists, WORLDS, workers, lambda *of: told.append(of))

    assert [of for _, done, of in told if done == 0] == [10, 2 * LEFT[0], 5 * LEFT[1]]
    assert len(race.episodes) == 10 + 2 * LEFT[0] + 5 * LEFT[1]
    assert all(each in race.episodes for each in race.winner.episodes)


def test_who_decides_as_the_champion_is_given_its_episodes_and_they_are_what_it_would_live(
    pen: Scenario,
) -> None:
    """Half a millimetre of a bound changes no decision in most worlds."""
    holder, like = careful(0.6), careful(0.6005)
    with Workers(pen, 1) as workers:
        race = raced(holder, [like], WORLDS, workers, in_silence)
        alone = raced(None, [like], WORLDS, workers, in_silence).winner

    assert race.holder is not None
    given = [each for each in race.challenger.episodes if each in race.holder.episodes]
    assert len(given) > len(WORLDS) / 2
    assert len(race.episodes) == len(set(map(id, race.episodes))) < 2 * len(WORLDS)
    pairs = zip(race.challenger.episodes, alone.episodes, strict=True)
    assert all((a.steps.x == b.steps.x).all() and a.total == b.total for a, b in pairs)


def test_the_best_of_all_generations_wins_the_last_race(pen: Scenario) -> None:
    took, one = Took(0.0, 0.0, 0.0), Trial(0.0, 0.0, 0.0, 0)
    lists = careful(0.1), careful(0.6), always(GO, 1)
    every = tuple(
        Generation(1, 1, one, one, (), rules, place == 0, 1, took)
        for place, rules in enumerate(lists)
    )
    with Workers(pen, 1) as workers:
        race = last_race(Course((), every), Settings(tried_in=4), workers, in_silence, Remembered())

    assert race.best is every[1]
    assert race.winner.rules is race.best.rules
    assert len(race.worlds) == len(race.winner.episodes) == 2 * 4
