"""Training: the same however it is interrupted and divided; its rules are what was learnt."""

import itertools
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from lcs.policies.decision_list import always
from lcs.policies.steps import Steps, joined
from runtime.progress import in_silence
from runtime.run import run
from runtime.scenario import Scenario
from spec_schema.diagnostics import SpecError
from specc.loading import load_scenario
from specc.training.challengers import own_places, policy_of
from specc.training.checkpoint import keep, taken_up
from specc.training.course import Course, Failure, Generation, Took, Trial
from specc.training.episode import Task, lived, trained_arbiter
from specc.training.folder import Begun, begin_in, scenario_in
from specc.training.judging import AsItWas, judged
from specc.training.pace import paced
from specc.training.result import text_of
from specc.training.settings import Settings
from specc.training.spelled import with_rules
from specc.training.training import BEFORE, AtRandom, choosing_worlds, exploring_tasks
from specc.training.workers import Workers
from specc.training.worlds import For, world
from tests.specc.training_scenes import FILES, SMALL, equal, pen_in, trained, written_in

TRIAL = Trial(1.0, 0.5, 3.0, 7)
FAILED = Failure(11, 40), Failure(12, 3)
SAFE = "{robustness: always within 3 s r.clearance > -1 m}"
NOTHING = Steps(
    *(np.zeros((0, 1)), np.zeros(0, np.int64), np.zeros(0), np.zeros((0, 1))),
    *(np.zeros(0, np.bool_), np.zeros(0, np.bool_)),
)


@pytest.fixture(scope="module")
def pen(tmp_path_factory: pytest.TempPathFactory) -> Scenario:
    """The scenario, in files of its own."""
    return pen_in(tmp_path_factory.mktemp("pen"))


@pytest.fixture(scope="module")
def whole(pen: Scenario) -> Course:
    """A training that nobody interrupted."""
    return trained(pen)


def generation(
    episodes: int, failed: tuple[Failure, ...] = (), *, is_new: bool = True
) -> Generation:
    """One whose race a new list won, or the best so far."""
    took = Took(0.0, 0.0, 0.0)
    return Generation(episodes, 9, TRIAL, TRIAL, failed, always(0, 1), is_new, 7, took)


def test_two_processes_learn_what_one_learns(pen: Scenario, whole: Course) -> None:
    other = trained(pen, jobs=2)

    assert len(other.generations) == len(whole.generations) == 2
    for one, same in zip(other.generations, whole.generations, strict=True):
        assert equal(one.rules, same.rules)
        assert (one.explored, one.tried) == (same.explored, same.tried)


def test_a_training_that_goes_on_from_its_checkpoint_learns_the_same(
    pen: Scenario, whole: Course, tmp_path: Path
) -> None:
    first, last = whole.generations
    after_first = whole.lived[: last.episodes - SMALL.each]
    assert len(after_first) > first.episodes, "what raced is learnt from, too"
    keep(Course(after_first, (first,)), tmp_path / "first.npz")

    resumed = trained(pen, course=taken_up(tmp_path / "first.npz"))

    assert equal(resumed.generations[1].rules, whole.generations[1].rules)
    assert resumed.generations[1].tried == whole.generations[1].tried


def test_a_checkpoint_holds_everything_to_the_bit(whole: Course, tmp_path: Path) -> None:
    one, other = tmp_path / "one.npz", tmp_path / "other.npz"
    first, last = whole.generations
    course = Course(whole.lived, (replace(first, failed=FAILED), last))
    keep(course, one)
    kept = taken_up(one)
    keep(kept, other)

    assert one.read_bytes() == other.read_bytes()
    assert [each.failed for each in kept.generations] == [FAILED, last.failed]
    for mine, its in zip(course.generations, kept.generations, strict=True):
        assert equal(mine.rules, its.rules)
        assert (mine.explored, mine.tried, mine.took) == (its.explored, its.tried, its.took)
    assert all(
        (mine.x == its.x).all() and (mine.reward == its.reward).all()
        for mine, its in zip(course.lived, kept.lived, strict=True)
    )


def test_a_checkpoint_that_is_damaged_anywhere_is_refused(whole: Course, tmp_path: Path) -> None:
    path = tmp_path / "checkpoint.npz"
    keep(whole, path)
    data = path.read_bytes()
    for length in range(0, len(data), len(data) // 7):
        path.write_bytes(data[:length])
        with pytest.raises(SpecError, match="V412"):
            taken_up(path)


def test_what_was_learnt_is_worth_more_than_chance(pen: Scenario, whole: Course) -> None:
    learnt = whole.champion.rules, policy_of(joined(whole.lived), pen, SMALL, 2).tables[0]
    with Workers(pen, 1) as workers:
        beside = judged(learnt, trained_arbiter(pen), 10, workers, in_silence)

    assert [each.what for each in beside] == [
        "what was learnt",
        "all rules learnt, by their vote",
        "choices at random",
    ]
    assert beside[0].trial.reward > beside[2].trial.reward + 5.0
    assert beside[0].low <= beside[0].trial.success <= beside[0].high
    assert len(beside[2].failed) == round(10 * (1.0 - beside[2].trial.success))


def test_what_was_best_first_is_learnt_again_to_the_bit(pen: Scenario, whole: Course) -> None:
    first = whole.generations[0]
    again = policy_of(joined(whole.lived[: first.episodes]), pen, SMALL, 0)
    assert any(equal(again.counted(rules), first.rules) for rules in again.lists)


def test_the_arbiter_with_its_rules_decides_in_a_run_as_the_list(
    whole: Course, tmp_path: Path
) -> None:
    scenario = pen_in(tmp_path)
    rules, seed = whole.champion.rules, world(For.JUDGING, 0)
    assert len(rules) > 0
    text = with_rules(text_of(scenario, "alcsr"), trained_arbiter(scenario), "alcsr", rules).text
    (tmp_path / "choose.yaml").write_text(text)
    copy = load_scenario(tmp_path / "pen.yaml", seed=seed).scenario

    steps = lived(scenario, Task(seed, rules, 0.0)).steps
    chosen = run(copy).signals["r.choose.choice"].values

    known = np.concatenate([steps.x, steps.after[-1:]])
    told = rules.decide(known)
    assert set(told.tolist()) == {0, 1}
    changes = [choice for choice, _ in itertools.groupby(chosen[np.isfinite(chosen)].tolist())]
    assert changes == [choice for choice, _ in itertools.groupby(told.tolist())]
    grid = np.linspace(0.0, 2.0, 2001)[:, None]
    near = np.concatenate([np.nextafter(rules.lower, 0.0), rules.lower, rules.upper])
    places = np.concatenate([grid, near[np.isfinite(near)][:, None]])
    assert (AsItWas(trained_arbiter(copy)).decide(places) == rules.decide(places)).all()


def test_failures_are_lived_again_until_shortly_before_their_end() -> None:
    settings = Settings(episodes=20, first=8, each=8, again=0.25)
    failing = Course((NOTHING,) * 8, (generation(8, FAILED),))
    tasks = exploring_tasks(failing, settings)
    again = {task.world: task.first_try for task in tasks if task.first_try is not None}

    assert len(tasks) == 8
    assert set(again) == {each.world for each in FAILED}
    for failure in FAILED:
        assert max(failure.decisions - BEFORE, 0) <= again[failure.world] < failure.decisions
    assert {task.world for task in tasks} - set(again) == {
        world(For.LEARNING, 8 + i) for i in range(2, 8)
    }


def test_a_failure_that_is_lived_again_is_the_same_until_something_is_tried(
    pen: Scenario,
) -> None:
    seed, rules = world(For.CHOOSING, 0), always(0, 1)
    before = lived(pen, Task(seed, rules, 0.0))
    again = lived(pen, Task(seed, rules, 1.0, tries=5, first_try=3))

    assert len(before.steps) > 3
    assert (again.steps.x[:4] == before.steps.x[:4]).all()
    assert (again.steps.action[:3] == 0).all()


def test_a_lists_own_places_are_of_the_episodes_that_it_would_have_lived(
    pen: Scenario, whole: Course
) -> None:
    rules = whole.champion.rules
    mine = [lived(pen, Task(world(For.CHOOSING, i), rules, 0.0)).steps for i in range(3)]
    ends = [len(each) for each in mine]
    theirs = [lived(pen, Task(world(For.CHOOSING, i), AtRandom(), 1.0)).steps for i in range(3)]
    assert any((rules.decide(each.x) != each.action).any() for each in theirs)

    parts = [theirs[0], mine[0], theirs[1], mine[1], theirs[2], mine[2]]
    own = own_places(rules, joined(parts))
    chosen = joined(parts).x[own]
    assert (rules.decide(chosen) == joined(parts).action[own]).all()
    assert set(range(len(theirs[0]), len(theirs[0]) + ends[0])) <= set(own.tolist())
    assert len(own) >= sum(ends)


def test_new_worlds_are_explored_where_nothing_failed() -> None:
    settings = Settings(episodes=10, first=8, each=8)
    tasks = exploring_tasks(Course((NOTHING,) * 8, (generation(8),)), settings)

    assert [task.world for task in tasks] == [world(For.LEARNING, 8), world(For.LEARNING, 9)]


def test_each_generation_races_in_worlds_of_its_own() -> None:
    settings = Settings(tried_in=5)
    worlds = [seed for number in range(4) for seed in choosing_worlds(number, settings)]
    assert len(set(worlds)) == 20


def test_it_stops_where_the_same_list_wins_for_long_enough() -> None:
    settings = Settings(episodes=100, patience=2)
    every = tuple(generation(10 * i, is_new=i <= 2) for i in range(1, 5))
    course = Course((NOTHING,) * 40, every)

    assert course.champion is every[1]
    assert course.is_over(settings)
    assert not Course(course.lived, every[:3]).is_over(settings)
    assert Course((NOTHING,) * 100, every[:1]).is_over(settings)
    assert Course((NOTHING,) * 81, every[:1]).is_over(settings), "19 of 80 are hardly any"
    assert not Course((NOTHING,) * 80, every[:1]).is_over(settings)


def test_the_world_alone_takes_a_part_of_an_episode(pen: Scenario) -> None:
    tasks = [Task(world(For.JUDGING, i), AtRandom(), 1.0) for i in (1, 2)]
    pace = paced(pen, tasks)

    assert pace.decisions == sum(len(lived(pen, task).steps) for task in tasks)
    assert 0.0 < pace.world < pace.seconds


def test_rules_may_change_in_a_training_that_goes_on_and_nothing_else(tmp_path: Path) -> None:
    path = written_in(tmp_path)
    folder = tmp_path / "out"
    begin_in(folder, Begun(str(path), SMALL, 1), load_scenario(path).scenario)
    text, arbiter = FILES["choose.yaml"], tmp_path / "choose.yaml"

    learnt = "{otherwise: turn, rules: [{choose: go, when: ahead > 0.5}]}"
    arbiter.write_text(text.replace("alcsr: {}", f"xcsr: {learnt}").replace("0.9", "0.8"))
    kept = scenario_in(folder, load_scenario(path).scenario)
    assert len(trained_arbiter(kept).rules) == 1

    arbiter.write_text(text.replace("[0, 2]", "[0, 3]"))
    with pytest.raises(SpecError, match="V413"):
        scenario_in(folder, load_scenario(path).scenario)


def test_a_requirement_that_an_early_end_leaves_open_is_rewarded_as_far_as_it_was_seen(
    tmp_path: Path,
) -> None:
    path = written_in(tmp_path)
    text = FILES["pen.yaml"].replace(
        "room: {least: r.clearance}", f"room: {{least: r.clearance}}\n    safe: {SAFE}"
    )
    path.write_text(text.replace("reward: 5 * fast", "reward: safe + 5 * fast"))
    scenario = load_scenario(path).scenario
    episodes = [lived(scenario, Task(world(For.LEARNING, i), always(0, 1), 0.0)) for i in range(4)]

    assert any(each.steps.ends[-1] for each in episodes), "one ends before its three seconds"
    assert all(np.isfinite(each.total) for each in episodes)
