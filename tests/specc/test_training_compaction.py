"""The best list made plainer: what goes, what stays, and that trials decide."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lcs.policies.decision_list import DecisionList, always
from runtime.progress import in_silence
from runtime.scenario import Scenario
from specc.training.compaction import Trials, compacted, touched
from specc.training.race import Racer, heat, heats
from specc.training.remembered import Remembered
from specc.training.workers import Workers
from tests.specc.training_scenes import equal, pen_in

GO, TURN = 0, 1
WORLDS = range(8)
FREE, NEAR = np.array([np.inf]), np.array([0.1])
CAREFUL = always(GO, 1).with_rule(0, TURN, -FREE, np.array([0.61237]))
PLACES = st.floats(0.0, 2.0)


@pytest.fixture(scope="module")
def pen(tmp_path_factory: pytest.TempPathFactory) -> Scenario:
    """The scenario, in files of its own."""
    return pen_in(tmp_path_factory.mktemp("pen"))


def tried(rules: DecisionList, workers: Workers) -> Racer:
    """A list that has run in all worlds."""
    racer = Racer(rules)
    heat([racer], None, WORLDS, workers, in_silence)
    return racer


def compacted_alone(rules: DecisionList, pen: Scenario) -> tuple[Racer, Racer]:
    """The list after its trials, and before."""
    with Workers(pen, 1) as workers:
        before = tried(rules, workers)
        return compacted(before, Trials(WORLDS, workers, in_silence, Remembered())), before


def test_rules_go_that_trials_do_not_need(pen: Scenario) -> None:
    wordy = CAREFUL.with_rule(0, GO, np.array([1.9]), FREE).with_rule(2, TURN, -FREE, NEAR)
    plain, before = compacted_alone(wordy, pen)

    assert plain.rules.action.tolist() == [TURN]
    assert plain.standing[0] == before.standing[0] == 1.0
    assert len(plain.episodes) == len(WORLDS)


def test_conditions_and_digits_go_that_trials_do_not_need(pen: Scenario) -> None:
    plain, _ = compacted_alone(CAREFUL.with_bound(0, 0, "lower", 1e-9), pen)

    assert plain.rules.lower.tolist() == [[-np.inf]]
    assert len(repr(plain.rules.upper.item())) <= len("0.61")
    assert plain.standing[0] == 1.0


def test_nothing_stands_behind_a_rule_that_always_holds() -> None:
    rules = CAREFUL.with_rule(1, TURN, -FREE, FREE).with_rule(2, GO, -FREE, NEAR)
    places = np.linspace(0.0, 2.0, 50)[:, None]

    closed = rules.closed()
    assert closed.upper.tolist() == CAREFUL.upper.tolist()
    assert closed.otherwise == TURN
    assert (closed.decide(places) == rules.decide(places)).all()
    assert CAREFUL.closed() is CAREFUL


def test_a_bound_in_few_digits_stays_as_it_is(pen: Scenario) -> None:
    """It might be moved into the middle of the gap that it ends."""
    with Workers(pen, 1) as workers:
        careful = tried(CAREFUL.with_bound(0, 0, "upper", 0.6), workers)
    read = np.unique(np.concatenate([each.places for each in careful.episodes]))
    beside = float(f"{read[read < 0.6].max() + 1e-6:.6f}")
    rules = careful.rules.with_bound(0, 0, "upper", beside)

    plain, before = compacted_alone(rules, pen)
    assert len(repr(plain.rules.upper.item())) <= len(repr(beside))
    assert before.rules is rules


def test_reward_is_not_given_up_where_nothing_is_required(pen: Scenario) -> None:
    free = replace(pen, requirements=())
    plain, before = compacted_alone(CAREFUL, free)

    total = np.array([each.total for each in before.episodes])
    assert before.standing[0] == plain.standing[0] == 1.0
    assert plain.standing[1] >= total.mean() - total.std() / np.sqrt(len(total)) - 1e-6
    assert len(plain.rules) == 1


def test_what_matters_in_many_worlds_is_not_tried(pen: Scenario) -> None:
    told: list[object] = []
    with Workers(pen, 1) as workers:
        careful = tried(CAREFUL, workers)
        trials = Trials(WORLDS, workers, lambda *of: told.append(of), Remembered())
        same = trials.unless_worse(careful, lambda _: always(TURN, 1), -np.inf)

    assert same is careful
    assert not told


def test_a_trial_ends_when_the_change_is_surely_behind(
    pen: Scenario, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("specc.training.compaction.RARE", 1.0)
    told: list[int] = []
    worlds = range(4 * len(WORLDS))
    with Workers(pen, 1) as workers:
        careful = Racer(CAREFUL)
        heat([careful], None, worlds, workers, in_silence)
        trials = Trials(worlds, workers, lambda _what, done, _of: told.append(done), Remembered())
        same = trials.unless_worse(careful, lambda _: always(GO, 1), -np.inf)

    assert same is careful
    assert 0 < max(told) <= heats(len(worlds))[0], "it lived no more than the first heat"


def test_two_processes_make_it_as_plain_as_one(pen: Scenario) -> None:
    plain, _ = compacted_alone(CAREFUL.with_rule(0, GO, np.array([1.9]), FREE), pen)
    with Workers(pen, 2) as workers:
        wordy = tried(CAREFUL.with_rule(0, GO, np.array([1.9]), FREE), workers)
        other = compacted(wordy, Trials(WORLDS, workers, in_silence, Remembered()))

    assert equal(plain.rules, other.rules)
    assert plain.standing == other.standing


def test_what_trials_need_stays(pen: Scenario) -> None:
    plain, before = compacted_alone(always(GO, 1).with_rule(0, TURN, -FREE, np.array([0.6])), pen)

    assert plain.rules.upper.tolist() == before.rules.upper.tolist() == [[0.6]]


def test_who_lives_anything_else_is_known_without_living_it(pen: Scenario) -> None:
    with Workers(pen, 1) as workers:
        careful, blind = tried(CAREFUL, workers), tried(always(GO, 1), workers)
    pairs = zip(careful.episodes, blind.episodes, strict=True)
    differ = sum(len(a.steps) != len(b.steps) or (a.steps.x != b.steps.x).any() for a, b in pairs)

    assert touched(blind.rules, careful) == differ > 0
    assert touched(CAREFUL.with_bound(0, 0, "lower", -1.0), careful) == 0


@given(
    actions=st.lists(st.sampled_from([GO, TURN]), min_size=1, max_size=4),
    data=st.data(),
)
@settings(max_examples=10)
def test_compaction_gives_up_no_success(
    actions: list[int], data: st.DataObject, pen: Scenario
) -> None:
    rules = always(GO, 1)
    for action in actions:
        low, high = sorted(data.draw(st.tuples(PLACES, PLACES)))
        rules = rules.with_rule(0, action, np.array([low]), np.array([high]))
    plain, before = compacted_alone(rules, pen)

    assert plain.standing[0] >= before.standing[0]
    assert plain.rules.conditions == len(list(plain.rules.bounds()))
    assert all(rule.conditions for rule in map(plain.rules.in_order, np.eye(len(plain.rules)) > 0))
    assert len(plain.rules) <= len(before.rules)
    assert plain.rules.conditions <= before.rules.conditions
