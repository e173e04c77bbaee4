"""Arbiters that learn: their boxes, what covers what, and that they decide as rules by hand do."""

from itertools import product
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import specc
from compiler.architecture.arbiters import compile_arbiter
from compiler.architecture.boxes import Limit, boxes_of, is_covered
from compiler.check import check
from runtime.arbiter import Paradigm, Rule
from runtime.arrays import Array
from runtime.machine import evaluate
from runtime.program import Kind, Role, State, Unit
from tests.verifier.arbitration.test_arbiters_judged import LOG, SPEC, section
from verifier.report.report import Verdict

ONE = Unit("1", 1.0)
VALUES = ("open", "shut", "ajar")
HEAD = (
    "specc: 1\nkind: arbiter\nname: tried\nreads: {ahead: {unit: cm, domain: [0, 200]}, "
    "used: {unit: '1', domain: [0, 1]}, door: {kind: discrete, values: [open, shut]}}\n"
    "choices: [flee, go, wait]\n"
)
BY_HAND = """
constants: {near: {value: 31 cm, unit: cm}, far: {value: 1.2, unit: m}}
by:
  rules:
    - {choose: flee, when: ahead < near and used > 0.5}
    - {choose: wait, when: door == 'shut' and 0.2 <= used and used < 0.9}
    - {choose: flee, when: not ahead <= far}
    - {choose: go}
"""
LEARNED = """
by:
  alcsr:
    otherwise: go
    rules:
      - {choose: flee, when: "ahead < 0.31 and used > 0.5", right: 412, wrong: 3}
      - {choose: wait, when: "door == 'shut' and 0.2 <= used < 0.9"}
      - {choose: flee, when: "1.2 < ahead"}
"""
UNTRAINED = "by: {xcsr: {}}"


def write(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "tried.yaml"
    path.write_text(HEAD + text, encoding="utf-8")
    return path


def state(name: str, kind: Kind = Kind.CONTINUOUS) -> State:
    is_discrete = kind is Kind.DISCRETE
    high, values = (2.0, VALUES) if is_discrete else (4.0, ())
    return State(
        name, ONE, 0.0, high, Role.SENSED, kind, 0.0, None, values, ("", ""), "", "here:1:1"
    )


READS = (state("x"), state("y"), state("door", Kind.DISCRETE))
HOLDS = {
    "lt": lambda a, b: a < b,
    "le": lambda a, b: a <= b,
    "gt": lambda a, b: a > b,
    "ge": lambda a, b: a >= b,
    "eq": lambda a, b: a == b,
    "ne": lambda a, b: a != b,
}
LIMITS = st.one_of(
    st.builds(
        Limit,
        st.sampled_from(["x", "y"]),
        st.sampled_from(["lt", "le", "gt", "ge"]),
        st.integers(-1, 5).map(float),
        st.just(0),
        st.just(0),
    ),
    st.builds(
        Limit,
        st.just("door"),
        st.sampled_from(["eq", "ne"]),
        st.integers(0, 2).map(float),
        st.just(0),
        st.just(0),
    ),
)
HALVES = [0.5 * k for k in range(9)]
POINTS = [
    dict(zip(("x", "y", "door"), at, strict=True)) for at in product(HALVES, HALVES, range(3))
]
"""Each limit is whole, so these lie in every cell that they make: on it, and on both its sides."""


def holds(limits: list[Limit], point: dict[str, float]) -> bool:
    return all(HOLDS[limit.op](point[limit.read], limit.value) for limit in limits)


@given(st.lists(st.lists(LIMITS, max_size=4), min_size=1, max_size=6))
def test_a_box_is_covered_exactly_where_each_of_its_points_is(
    conditions: list[list[Limit]],
) -> None:
    *before, last = conditions
    inside = [point for point in POINTS if holds(last, point)]
    *boxes, box = boxes_of(conditions, READS)

    assert (0 in box) == (not inside)
    if inside:
        covered = all(any(holds(one, point) for one in before) for point in inside)
        assert is_covered(box, boxes) == covered


def test_it_has_its_learner_its_rules_and_a_last_one_that_always_holds(tmp_path: Path) -> None:
    arbiter = compile_arbiter(write(tmp_path, LEARNED)).arbiter
    first, second, third, last = arbiter.rules

    assert (arbiter.learner, arbiter.paradigm) == ("alcsr", Paradigm.RULES)
    assert arbiter.way == "rules learned by ALCSR"
    assert [rule.choice for rule in arbiter.rules] == [0, 2, 0, 1]
    assert (first.right, first.wrong, second.right) == (412, 3, 0)
    assert last.when is None
    assert third.when is not None
    assert third.when.text == "1.2 ahead lt"
    assert first.origin.endswith("tried.yaml:11:9")


def test_before_training_it_always_chooses_the_first_and_a_warning_says_so(tmp_path: Path) -> None:
    compiled = compile_arbiter(write(tmp_path, UNTRAINED))

    assert compiled.arbiter.way == "rules to be learned by XCSR"
    assert [(rule.choice, rule.when) for rule in compiled.arbiter.rules] == [(0, None)]
    assert [found.code for found in compiled.warnings] == ["S390"]


def test_it_decides_as_the_same_rules_by_hand(tmp_path: Path) -> None:
    """Two ways to the same code: numbers in SI, and constants with units."""
    learned = compile_arbiter(write(tmp_path, LEARNED)).arbiter
    by_hand = compile_arbiter(write(tmp_path, BY_HAND)).arbiter
    chance = np.random.default_rng(7)
    reads = chance.uniform(0.0, [2.0, 1.0, 2.0], (2000, 3))
    reads[:, 2] = np.floor(reads[:, 2])
    reads[:40, 0] = np.repeat([0.31, 1.2], 20)  # at the bounds, too
    constants = np.tile([one.value for one in by_hand.constants], (len(reads), 1))

    def chosen(rules: tuple[Rule, ...], names: tuple[str, ...], at: Array) -> list[int]:
        found = np.full(len(at), -1)
        for rule in rules:
            wants = (
                np.ones(len(at)) if rule.when is None else evaluate([rule.when], names, at)[:, 0]
            )
            found = np.where((found < 0) & (wants != 0), rule.choice, found)
        return list(found)

    mine = chosen(learned.rules, learned.register, reads)
    assert mine == chosen(by_hand.rules, by_hand.register, np.hstack([reads, constants]))
    assert set(mine) == {0, 1, 2}


def test_a_rule_that_decides_nothing_is_told_and_one_that_decides_is_not(tmp_path: Path) -> None:
    more = """
      - {choose: wait, when: "ahead < 0.2 and used > 0.6 and door == 'open'"}
      - {choose: wait, when: "ahead < 0.2 and used > 0.4 and door == 'open'"}
      - {choose: wait}
      - {choose: go, when: "used < 0.1"}"""
    found = check(write(tmp_path, LEARNED.rstrip() + more))

    places = [(one.code, one.span.line) for one in found if one.span is not None]
    assert places == [("S329", 14), ("S329", 17)]


def test_of_hundreds_of_rules_those_that_are_called_covered_are() -> None:
    chance = np.random.default_rng(3)
    reads = tuple(state(f"r{k}") for k in range(4))
    lows = chance.uniform(0.0, 3.0, (300, 4))
    highs = np.minimum(lows + chance.uniform(0.2, 3.0, lows.shape), 4.0)
    boxes = boxes_of([box_between(reads, *ends) for ends in zip(lows, highs, strict=True)], reads)

    covered = [i for i in range(300) if is_covered(boxes[i], boxes[:i])]

    for i in covered:
        points = chance.uniform(lows[i], highs[i], (500, 4))
        within = (lows[:i, None] <= points) & (points < highs[:i, None])
        assert within.all(axis=2).any(axis=0).all()
    assert 5 < len(covered) < 295


def box_between(reads: tuple[State, ...], low: Array, high: Array) -> list[Limit]:
    return [
        Limit(read.name, op, float(value), 0, 0)
        for read, *ends in zip(reads, low, high, strict=True)
        for op, value in zip(("ge", "lt"), ends, strict=True)
    ]


def test_of_many_rules_verify_says_where_decisions_differ_and_that_it_moved_no_number(
    tmp_path: Path,
) -> None:
    """A fence of rules that say the same: each comparison is one, and a place is told once."""
    rules = [
        f'{{choose: slight_left, when: "left > 0.9 and front >= {0.9 + 0.1 * k:.1f}"}}'
        for k in range(15, -1, -1)
    ]
    own = '{choose: sharp_right, when: "front <= 0.9"}, {choose: slight_right, when: "left < 0.6"}'
    learned = f"by: {{alcsr: {{otherwise: forward, rules: [{', '.join(rules)}, {own}]}}}}\n"
    before, _, after = SPEC.read_text().partition("by:\n")
    path = tmp_path / "learned.yaml"
    path.write_text(before + learned + "agreement:" + after.partition("agreement:")[2])

    found = specc.verify(LOG, path)

    assert found.report.verdict is Verdict.FAIL
    assert section(found).thresholds == ()
    assert any("too many to be moved one by one" in note for note in found.report.notes)
    worst = section(found).cells[0]
    assert "left < 0.6 m" in worst.conditions
    assert max(len(cell.conditions) for cell in section(found).cells) <= 4


@pytest.mark.parametrize("near", [0.4945, 0.55])
def test_a_physical_robot_is_judged_by_learned_rules_as_by_those_of_a_hand(
    tmp_path: Path, near: float
) -> None:
    by_hand = tmp_path / "by_hand.yaml"
    by_hand.write_text(SPEC.read_text().replace("value: 0.4945", f"value: {near}"))
    learned = tmp_path / "learned.yaml"
    before, _, after = by_hand.read_text().partition("by:\n")
    agreement = after.partition("agreement:")[2]
    learned.write_text(
        f"{before}by:\n  alcsr:\n    otherwise: forward\n    rules:\n"
        '      - {choose: sharp_right, when: "front <= 0.9"}\n'
        '      - {choose: slight_left, when: "left > 0.9"}\n'
        f'      - {{choose: slight_right, when: "left < {near}"}}\n'
        f"agreement:{agreement}"
    )
    one, other = (specc.verify(LOG, path) for path in (by_hand, learned))

    assert section(other).share == section(one).share
    assert other.report.verdict is one.report.verdict
    told = "\n".join(other.report.reasons)
    if near == 0.55:
        assert "the number in `left < 0.55` is 0.494 to 0.495 m (spec 0.55 m)" in told
        assert any(
            "write `left < 0.4945` for `left < 0.55`" in each for each in other.report.advice
        )
