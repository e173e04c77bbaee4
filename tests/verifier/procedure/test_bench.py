"""Test procedures of arbiters: readings that tell the spec's own decisions from other ones."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from compiler.architecture.arbiters import compile_arbiter
from runtime.arbiter import Arbiter
from runtime.arbitration.build import arbiter_of
from runtime.arrays import Array, Integers
from runtime.user_code import Callee
from verifier.arbitration.judging import judge_arbiter
from verifier.arbitration.reader import CHOICE
from verifier.procedure.bench import bench_test
from verifier.procedure.bench_model import BenchTest
from verifier.procedure.bench_wording import bench_sentences
from verifier.procedure.single_rules import without_rule
from verifier.report.report import Verdict
from verifier.traces.trace import TICKS, Series, Trace

PERIOD = 0.05


@pytest.fixture(scope="module")
def arbiter() -> Arbiter:
    specs = Path(__file__).parents[3] / "specs"
    return compile_arbiter(specs / "arbiters" / "who_moves.yaml").arbiter


@pytest.fixture(scope="module")
def bench(arbiter: Arbiter) -> BenchTest:
    found = bench_test(arbiter, PERIOD)
    assert found is not None
    return found


def who_moves(near: float, beside: float) -> Callable[[float, float, float], int]:
    """The rules in who_moves.yaml, in Python: 0 turns away, 1 goes on."""
    holds = False

    def decide(ahead: float, left: float, right: float) -> int:
        nonlocal holds
        if ahead < near or min(left, right) < beside:
            holds = True
        elif ahead > near + 0.1 and min(left, right) > beside + 0.02:
            holds = False
        return 0 if holds else 1

    return decide


def shown_to(
    arbiter: Arbiter, bench: BenchTest, decide: Callable[[float, float, float], int]
) -> Verdict:
    names = ("ahead", "left", "right")
    ticks = round(bench.seconds / PERIOD)
    rows = [[each.values[n] for n in names] for each in bench.shown for _ in range(ticks)]
    rows *= bench.repeats
    times: Array = PERIOD * np.arange(float(len(rows)))
    told = np.array(rows)
    series = {n: Series(n, times, told[:, i], n, TICKS) for i, n in enumerate(names)}
    chosen = np.array([decide(*row) for row in rows], dtype=float)
    series[CHOICE] = Series(CHOICE, times, chosen, CHOICE, TICKS)
    trace = Trace("bench", series, {}, 0.0, (), ())
    own = replace(arbiter, judge_when=None)
    return judge_arbiter(own, trace, depth="verdict").report.verdict


def test_one_that_decides_by_the_same_rules_passes(arbiter: Arbiter, bench: BenchTest) -> None:
    assert shown_to(arbiter, bench, who_moves(0.2, 0.2)) is Verdict.PASS


@pytest.mark.parametrize(("near", "beside"), [(0.32, 0.2), (0.08, 0.2), (0.2, 0.32), (0.2, 0.08)])
def test_one_with_another_threshold_does_not(
    arbiter: Arbiter, bench: BenchTest, near: float, beside: float
) -> None:
    assert shown_to(arbiter, bench, who_moves(near, beside)) is Verdict.FAIL


def test_the_choices_that_are_told_are_those_of_the_rules(bench: BenchTest) -> None:
    decide, ticks = who_moves(0.2, 0.2), round(bench.seconds / PERIOD)
    for each in bench.shown:
        names = ("ahead", "left", "right")
        found = [decide(*(each.values[n] for n in names)) for _ in range(ticks)][-1]
        assert ("turn_away", "go_on")[found] == each.chosen


def test_it_is_told_in_words(bench: BenchTest) -> None:
    told = bench_sentences(bench)
    assert told[0].startswith(f"show the arbiter these {len(bench.shown)} sets of readings")
    assert any(
        line.startswith("1: ahead ") and line.endswith(("turn_away", "go_on")) for line in told
    )
    assert any("too high gets FAIL" in line for line in told)


STRIPS = """specc: 1
kind: arbiter
name: strips
reads:
  ahead: {unit: m, domain: [0, 2]}
  lamp: {unit: m, domain: [0, 6]}
choices: [flee, go]
by:
  rules:
    - {choose: go, when: ahead >= narrow and ahead < wide}
    - {choose: go, when: ahead >= some and lamp < near}
    - {choose: go, when: ahead >= wide and lamp < nearest}
    - {choose: flee, when: ahead < wider and lamp >= nearest}
    - {choose: go}
constants:
  narrow: {value: 0.3, unit: m}
  wide: {value: 0.36, unit: m}
  wider: {value: 0.37, unit: m}
  some: {value: 0.23, unit: m}
  near: {value: 1.22, unit: m}
  nearest: {value: 0.62, unit: m}
"""
"""Strips of 6 cm and of 1 cm, and a rule that nobody would miss."""


@pytest.fixture(scope="module")
def strips(tmp_path_factory: pytest.TempPathFactory) -> Arbiter:
    path = tmp_path_factory.mktemp("strips") / "strips.yaml"
    path.write_text(STRIPS, encoding="utf-8")
    return compile_arbiter(path).arbiter


def test_rules_that_hold_in_narrow_strips_are_missed_where_they_lack(strips: Arbiter) -> None:
    """The rules once more, in Python; each is left out in turn."""
    found = bench_test(strips, PERIOD)
    assert found is not None
    rules: list[tuple[Callable[[float, float], bool], int]] = [
        (lambda ahead, _: 0.3 <= ahead < 0.36, 1),
        (lambda ahead, lamp: ahead >= 0.23 and lamp < 1.22, 1),
        (lambda ahead, lamp: ahead >= 0.36 and lamp < 0.62, 1),
        (lambda ahead, lamp: ahead < 0.37 and lamp >= 0.62, 0),
        (lambda _ahead, _lamp: True, 1),
    ]
    wrong = np.zeros(4)
    for each in found.shown:
        ahead, lamp = each.values["ahead"], each.values["lamp"]
        chosen = next(choice for holds, choice in rules if holds(ahead, lamp))
        assert ("flee", "go")[chosen] == each.chosen
        for lacking in range(4):
            left = [*rules[:lacking], *rules[lacking + 1 :]]
            wrong[lacking] += next(c for holds, c in left if holds(ahead, lamp)) != chosen

    assert (wrong > 0).tolist() == [True, True, False, True]
    assert (wrong[[0, 1, 3]] > 0.02 * len(found.shown)).all(), "more than may differ"
    assert [(each.rule, each.verdict) for each in found.lacking] == [
        (1, Verdict.FAIL),
        (2, Verdict.FAIL),
        (4, Verdict.FAIL),
    ]
    assert found.idle == (3,)
    assert found.decides
    told = bench_sentences(found)
    assert "one that lacks rule 1, 2 or 4 gets FAIL" in told
    assert "one that lacks rule 3 chooses the same at all of them" in told


HEAD = """specc: 1
kind: arbiter
name: tried
reads:
  ahead: {unit: m, domain: [0, 2]}
  left: {unit: m, domain: [0, 2]}
  bump: {unit: "1", domain: [0, 1]}
choices: [flee, go]
constants:
  near: {value: 0.4, unit: m}
  free: {value: 0.8, unit: m}
  wide: {value: 1, unit: m}
  least: {value: 1.1, unit: m}
  most: {value: 1.17, unit: m}
by:
  rules:
"""


@pytest.mark.parametrize(
    "rules",
    [
        [
            "choose: flee, when: ahead < near, until: ahead > free",
            "choose: flee, when: ahead < near, until: left > wide",
        ],
        ["choose: flee, when: bump >= 1", "choose: flee, when: ahead < near"],
        ["choose: flee, when: ahead - left > least and ahead - left < most"],
    ],
    ids=["that last", "at the end of a domain", "of two readings together"],
)
def test_what_is_said_of_lacking_rules_is_what_such_arbiters_choose(
    rules: list[str], tmp_path: Path
) -> None:
    path = tmp_path / "tried.yaml"
    lines = [f"    - {{{rule}}}\n" for rule in (*rules, "choose: go")]
    path.write_text(HEAD + "".join(lines), encoding="utf-8")
    arbiter = compile_arbiter(path).arbiter
    found = bench_test(arbiter, PERIOD)
    assert found is not None

    rows = np.array([[each.values[n] for n in ("ahead", "left", "bump")] for each in found.shown])
    rows = np.repeat(rows, round(found.seconds / PERIOD), axis=0)
    whole = chosen_by(arbiter, rows)
    for place in range(len(rules)):
        differs = chosen_by(without_rule(arbiter, place), rows) != whole
        assert differs.any() == (place + 1 not in found.idle)
        assert differs.any() == any(each.rule == place + 1 for each in found.lacking)
    assert found.lacking, "one rule at least is told apart"


def chosen_by(arbiter: Arbiter, rows: Array) -> Integers:
    """What a fresh one chooses at readings that are shown one after the other."""
    made = arbiter_of(arbiter, "tried", PERIOD, _no_code)
    made.reset(0)
    return np.array([made.decide(row, PERIOD * k).argmax() for k, row in enumerate(rows)])


def _no_code(_text: str) -> Callee:
    raise AssertionError("no arbiter here is code")


def test_the_only_rule_can_not_lack(strips: Arbiter) -> None:
    found = bench_test(replace(strips, rules=strips.rules[:1]), PERIOD)

    assert found is not None
    assert (found.lacking, found.idle) == ((), ())


def test_an_arbiter_that_reads_nothing_has_none(arbiter: Arbiter) -> None:
    assert bench_test(replace(arbiter, reads=()), PERIOD) is None
