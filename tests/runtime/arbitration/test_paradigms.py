"""Arbiters of every paradigm against plain second implementations, and what papers say of them."""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from runtime import chance
from runtime.arbiter import Arbiter, Competition, Paradigm, Rule
from runtime.arbitration.build import arbiter_of
from runtime.arbitration.competition import STEPS, Competing
from runtime.arbitration.protocol import Arbiter as Deciding
from runtime.code import Code
from runtime.program import Constant, Control, Role
from runtime.user_code import Callee, UserCodeError
from tests.runtime.behaviors import formula_program, state
from tests.runtime.hybrids import guard, with_modes
from tests.runtime.scheduler.plane import HERE, ONE
from tests.runtime.scheduler.test_acting import arbiter, by_weights

PERIOD = 0.1


def no_code(text: str) -> Callee:
    raise AssertionError(text)


def deciding(compiled: Arbiter, code: Callable[[str], Callee] = no_code) -> Deciding:
    made = arbiter_of(compiled, "r.choose", PERIOD, code)
    made.reset(3)
    return made


def decisions(compiled: Arbiter, xs: list[float]) -> list[list[float]]:
    """What is decided, one decision a period, with the readings `xs`."""
    made = deciding(compiled)
    return [made.decide(np.array([x]), k * PERIOD).tolist() for k, x in enumerate(xs)]


def rule(choice: int, when: str | None, until: str | None = None, lasts: float = 0.0) -> Rule:
    codes = (Code(text) if text else None for text in (when, until))
    return Rule(choice, *codes, lasts, HERE)


RULES = (
    rule(0, "x 0.2 lt", "x 0.5 gt", 0.3),
    rule(1, "x 0.6 lt x 0.4 gt and", None, 0.4),
    rule(2, "x 0.9 gt", "x 0.7 lt"),
    rule(3, None),
)


def plainly(xs: list[float]) -> list[list[bool]]:
    """Which of RULES hold at each period, once more: by looking back instead of by latches."""

    def when(i: int, x: float) -> bool:
        return (x < 0.2, 0.4 < x < 0.6, x > 0.9, True)[i]

    def until(i: int, x: float) -> bool:
        return (x > 0.5, not 0.4 < x < 0.6, x < 0.7, False)[i]

    periods = (3, 4, 0, 0)  # `lasts`, in periods

    def holds(i: int, k: int) -> bool:
        begun: int | None = None
        for j in range(k + 1):
            if begun is None:
                begun = j if when(i, xs[j]) else None
            elif not when(i, xs[j]) and until(i, xs[j]) and j - begun >= periods[i]:
                begun = None
        return begun is not None

    return [[holds(i, k) for i in range(4)] for k in range(len(xs))]


@given(st.lists(st.sampled_from([0.0, 0.1, 0.3, 0.45, 0.55, 0.65, 0.8, 1.0]), max_size=40))
def test_rules_and_layers_hold_as_looking_back_says(xs: list[float]) -> None:
    names = ["a", "b", "c", "d"]
    first = arbiter(names, Paradigm.RULES, rules=RULES)
    layers = arbiter(names, Paradigm.SUBSUMPTION, rules=RULES)
    holding = plainly(xs)

    assert decisions(layers, xs) == [[float(h) for h in row] for row in holding]
    assert decisions(first, xs) == [
        [float(i == row.index(True)) for i in range(4)] for row in holding
    ]


def test_where_no_rule_holds_nothing_is_chosen() -> None:
    only = arbiter(["a"], Paradigm.RULES, rules=(rule(0, "x 0 gt"),))

    assert decisions(only, [-1.0, 1.0, -1.0]) == [[0.0], [1.0], [0.0]]


def test_a_reset_forgets_what_was_latched() -> None:
    made = deciding(arbiter(["a"], Paradigm.RULES, rules=(rule(0, "x 0 gt", "x -5 lt"),)))
    assert made.decide(np.array([1.0]), 0.0)[0] == made.decide(np.array([-1.0]), 0.1)[0] == 1.0

    made.reset(0)

    assert made.decide(np.array([-1.0]), 0.0)[0] == 0.0


def test_controls_follow_what_is_read_and_constants_are_known() -> None:
    limited = replace(
        arbiter(["a"], Paradigm.RULES, rules=(rule(0, "x near margin add lt"),)),
        controls=(Control("near", ONE, 0.0, 9.0, 1.0, "", HERE),),
        constants=(Constant("margin", ONE, 0.25, "", HERE),),
    )
    made = deciding(limited)

    assert [made.decide(np.array([1.1, near]), 0.0)[0] for near in (0.8, 0.9)] == [0.0, 1.0]


def test_weights_below_zero_and_without_a_value_count_as_none() -> None:
    weights = by_weights(p="x", q="1 x sub", r="x sqrt")

    assert decisions(weights, [0.25, -4.0]) == [[0.25, 0.75, 0.5], [0.0, 5.0, 0.0]]


def competing(advantage: tuple[str, ...], suppression: str, noise: float = 1e-3) -> Arbiter:
    k = len(advantage)
    row = (Code(suppression),) * k
    competition = Competition(tuple(map(Code, advantage)), (row,) * k, 0.05, noise)
    names = ["a", "b", "c"][:k]
    return arbiter(names, Paradigm.COMPETITION, competition=competition)


def test_a_competition_is_the_equation_stepped_plainly() -> None:
    compiled = competing(("x", "1 x sub", "0.5"), "0.8", noise=0.05)
    xs = [0.2, 0.9, 0.9, 0.1, 0.5, -0.3]

    found = decisions(compiled, xs)

    u, generator = [0.0] * 3, chance.generator(3, "competition", "r.choose")
    steps = math.ceil(STEPS * 0.8 * 3 * PERIOD / 0.05 * (1 - 1e-9))
    h = PERIOD / steps
    for x, row in zip(xs, found, strict=True):
        a = [min(max(v, -1.0), 1.0) for v in (x, 1.0 - x, 0.5)]
        for kick in generator.standard_normal((steps, 3)):
            rates = [
                a[i] * u[i]
                - abs(a[i]) * u[i] ** 3
                - sum(0.8 * u[j] ** 2 * u[i] for j in range(3) if j != i)
                for i in range(3)
            ]
            u = [
                v + h / 0.05 * r + 0.05 * math.sqrt(h) * z
                for v, r, z in zip(u, rates, kick, strict=True)
            ]
        assert row == pytest.approx([v * v for v in u], rel=1e-9, abs=1e-12)


@pytest.mark.parametrize(("advantages", "winner"), [((0.9, 0.3), 0), ((0.2, 0.8), 1)])
def test_of_two_that_suppress_each_other_the_favored_one_wins_all(
    advantages: tuple[float, float], winner: int
) -> None:
    # Large et al. 1999, section 3: |u| is 1 for the winner and 0 for the other, where the
    # suppression is larger than the advantage.
    compiled = competing(tuple(map(repr, advantages)), "1.5")

    last = decisions(compiled, [0.0] * 60)[-1]

    assert last[winner] == pytest.approx(1.0, abs=0.01)
    assert last[1 - winner] == pytest.approx(0.0, abs=0.01)


def test_without_suppression_both_are_active_and_without_advantage_none() -> None:
    assert decisions(competing(("1", "1"), "0"), [0.0] * 60)[-1] == pytest.approx([1, 1], abs=0.01)
    assert decisions(competing(("-1", "-1"), "0"), [0.0] * 60)[-1] == pytest.approx(
        [0, 0], abs=0.01
    )


def test_who_has_won_keeps_on_for_a_while_although_the_other_is_favored_now() -> None:
    compiled = competing(("1 x sub", "x"), "2")

    found = decisions(compiled, [0.2] * 40 + [0.6] * 40 + [1.5] * 40)

    assert [row.index(max(row)) for row in found[39::40]] == [0, 0, 1]  # hysteresis


def test_a_competition_has_chance_of_its_own_seed() -> None:
    compiled = competing(("1", "1"), "2")
    winners = set()
    for seed in range(12):
        made = Competing(compiled, "r.choose", PERIOD)
        made.reset(seed)
        for k in range(60):
            last = made.decide(np.zeros(1), k * PERIOD)
        winners.add(int(np.argmax(last)))

    assert winners == {0, 1}


def test_a_plan_chooses_the_mode_that_its_behavior_is_in() -> None:
    errand = with_modes(
        formula_program(
            (
                replace(state("t", 0.0, 9.0), role=Role.DRIVEN, hold=0.0),
                replace(state("x", -9.0, 9.0), role=Role.SENSED),
            ),
            {"t": "1"},
        ),
        ("go", "wait", "back"),
        guard(0, 1, "x 1 sub", t="0"),
        guard(1, 2, "t 0.35 sub"),
    )
    compiled = arbiter(["go", "wait", "back"], Paradigm.PLAN, plan=errand)

    found = decisions(compiled, [0.0, 0.5, 1.2, 0.0, 0.0, 0.0, 0.0, 0.0])

    # It arrives at 0.2 s, waits for 0.35 s, and is on its way back at the tick after that.
    assert [row.index(1.0) for row in found] == [0, 0, 1, 1, 1, 1, 2, 2]


@pytest.mark.parametrize(
    ("answer", "numbers"),
    [("b", [0.0, 1.0]), ({"a": 2, "b": 0.5}, [2.0, 0.5]), ({}, [0.0, 0.0])],
)
def test_a_function_says_a_choice_or_numbers(answer: object, numbers: list[float]) -> None:
    module = arbiter(["a", "b"], Paradigm.MODULE, module="mine:choose")

    made = deciding(module, lambda _text: lambda reads, time: answer)  # noqa: ARG005  # its shape

    assert made.decide(np.array([1.0]), 0.0).tolist() == numbers


def test_a_function_sees_floats_that_it_cannot_change() -> None:
    module = arbiter(["a", "b"], Paradigm.MODULE, module="mine:choose")

    def spoils(reads: dict[str, float], _time: float) -> str:
        assert {name: type(value) for name, value in reads.items()} == {"x": float}
        reads["x"] = 0.0
        return "a"

    with pytest.raises(UserCodeError, match="does not support item assignment"):
        deciding(module, lambda _text: spoils).decide(np.array([1.0]), 0.0)


@pytest.mark.parametrize("answer", ["c", {"c": 1}, {"a": -1}, {"a": math.nan}, None, 3])
def test_what_is_no_choice_is_told(answer: object) -> None:
    module = arbiter(["a", "b"], Paradigm.MODULE, module="mine:choose")
    made = deciding(module, lambda _text: lambda reads, time: answer)  # noqa: ARG005  # its shape

    with pytest.raises(UserCodeError, match="mine:choose"):
        made.decide(np.array([1.0]), 0.0)


def test_a_class_of_the_right_shape_is_an_arbiter() -> None:
    class Mine:
        def __init__(self, reads: tuple[str, ...], choices: tuple[str, ...]) -> None:
            assert (reads, choices) == (("x",), ("a", "b"))

        def reset(self, seed: int) -> None:
            self.seed = seed

        def decide(self, reads: np.ndarray, time: float) -> list[float]:
            return [float(reads[0]), self.seed + time]

        def learn(self, reward: float) -> None:
            pass

    made = deciding(arbiter(["a", "b"], Paradigm.MODULE, module="mine:Mine"), lambda _text: Mine)

    assert made.decide(np.array([2.0]), 0.5).tolist() == [2.0, 3.5]
    with pytest.raises(UserCodeError, match="numbers of 0 or more"):
        made.decide(np.array([-2.0]), 0.5)
