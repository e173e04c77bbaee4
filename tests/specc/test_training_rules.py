"""Learned rules in an arbiter's text: few digits, the same decisions, and all else kept."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from compiler.architecture.arbiters import compile_arbiter
from lcs.policies.decision_list import DecisionList
from lcs.policies.shortened import shortened
from spec_schema.load import load
from specc.training.judging import AsItWas
from specc.training.spelled import with_rules

HEAD = """\
specc: 1
kind: arbiter
name: a
reads:   # two
  ahead: {unit: m, domain: [-2, 2]}   # in front
  door: {kind: discrete, values: [open, ajar, closed]}
choices: [go, "true", wait]
"""
LAYOUTS = {
    "by: {alcsr: {}}  # new\n": "by: # new\n  alcsr:\n    otherwise: wait\n    rules:\n{6}",
    "by:\n  alcsr: {otherwise: go}  # new\n": (
        "by:\n  alcsr: # new\n    otherwise: wait\n    rules:\n{6}"
    ),
    "by:  # a\n  alcsr:  # b\n    otherwise: go  # c\n    rules:  # d\n"
    "      - {choose: go, when: ahead < 1}  # old\n# end\nagreement: {share: 0.9}\n": (
        "by:  # a\n  alcsr:  # b\n    otherwise: wait  # c\n    rules:  # d\n{6}"
        "# end\nagreement: {share: 0.9}\n"
    ),
    "by:\n  xcsr:\n    rules: []\n": "by:\n  alcsr:\n    otherwise: wait\n    rules:\n{6}",
}


def lists(inputs: int = 2) -> st.SearchStrategy[DecisionList]:
    """Lists of some rules with bounds anywhere, of inputs from -2 to 2."""

    @st.composite
    def made(draw: st.DrawFn) -> DecisionList:
        count = draw(st.integers(0, 4))
        chance = np.random.default_rng(draw(st.integers(0, 10_000)))
        ends = np.sort(chance.uniform(-2.0, 2.0, (2, count, inputs)), axis=0)
        asks = chance.random((2, count, inputs)) < 0.6
        lower = np.where(asks[0], ends[0], -np.inf)
        upper = np.where(asks[1], ends[1], np.inf)
        counts = chance.integers(50, size=(2, count))
        action = chance.integers(3, size=count)
        return DecisionList(action, lower, upper, counts[0], counts[1], otherwise=2)

    return made()


@settings(max_examples=60)
@given(lists(3), st.integers(0, 1000))
def test_short_bounds_decide_the_same_wherever_anything_was_lived(
    rules: DecisionList, seed: int
) -> None:
    x = np.random.default_rng(seed).uniform(-2.0, 2.0, (80, 3))
    short = shortened(rules, x)

    assert (short.first(x) == rules.first(x)).all()


def test_a_bound_in_the_rounding_of_one_place_moves_to_beside_it() -> None:
    one = np.array([1])
    lower, upper = np.array([[3.0 - 1e-14]]), np.array([[np.inf]])
    rules = DecisionList(one, lower, upper, one, one, otherwise=0)
    short = shortened(rules, np.array([[1.0], [2.9], [3.0 - 2e-14], [3.0]]))

    assert short.lower.tolist() == [[2.95]]


def test_bounds_get_short_and_those_that_no_place_asks_for_are_dropped() -> None:
    x = np.array([[0.1], [0.28], [0.35], [0.8]])
    bounds = np.array([[0.05123]]), np.array([[0.3123456]])
    one = np.ones(1, np.int64)
    short = shortened(DecisionList(one, *bounds, one, one, 0), x)

    assert short.lower[0, 0] == -np.inf
    assert short.upper[0, 0] == 0.3
    flags = shortened(DecisionList(one, *bounds, one, one, 0), np.array([[0.0], [0.06], [1.0]]))
    assert (flags.lower[0, 0], flags.upper[0, 0]) == (0.03, 0.5)


@settings(max_examples=30)
@given(rules=lists())
def test_a_compiled_copy_decides_as_the_list(
    rules: DecisionList, tmp_path_factory: pytest.TempPathFactory
) -> None:
    path = tmp_path_factory.mktemp("copy") / "a.yaml"
    path.write_text(HEAD + next(iter(LAYOUTS)))
    x = np.random.default_rng(0).uniform(-2.0, 2.0, (60, 2))
    x[:, 1] = np.arange(60) % 3
    rules = shortened(rules, x)
    kept = [r for r in range(len(rules)) if _values(rules, r)]
    rules = replace(rules, **{name: getattr(rules, name)[kept] for name in NAMES})

    bounds = np.concatenate([rules.lower[:, 0], rules.upper[:, 0]])
    at = np.repeat(bounds[np.isfinite(bounds)], 3)
    near = np.stack([at, np.arange(len(at)) % 3], axis=1)
    below = near - [[1e-15, 0.0]]

    path.write_text(with_rules(load(path), compile_arbiter(path).arbiter, "alcsr", rules).text)

    again = AsItWas(compile_arbiter(path).arbiter)
    places = np.concatenate([x, near, below])
    assert (again.decide(places) == rules.decide(places)).all()


NAMES = ("action", "lower", "upper", "right", "wrong")


def _values(rules: DecisionList, rule: int) -> bool:
    """Whether it holds at some value of the door; learned rules do."""
    return any(rules.lower[rule, 1] <= value < rules.upper[rule, 1] for value in range(3))


@pytest.mark.parametrize("by", LAYOUTS, ids=["by", "learner", "in_place", "another"])
def test_comments_and_all_else_are_kept(by: str, tmp_path: Path) -> None:
    path = tmp_path / "a.yaml"
    path.write_text(HEAD + by)
    lower = np.array([[-0.5, -np.inf], [np.nextafter(0.9, 1.0), 1.0]])
    upper = np.array([[np.nextafter(0.25, 1.0), 1.0], [1.5, np.inf]])
    counts = np.array([[4, 5], [0, 1]])
    rules = DecisionList(np.array([1, 0]), lower, upper, counts[0], counts[1], otherwise=2)

    made = with_rules(load(path), compile_arbiter(path).arbiter, "alcsr", rules).text

    first = "ahead >= -0.5 and ahead <= 0.25 and door == 'open'"
    second = "ahead > 0.9 and ahead < 1.5 and door != 'open'"
    lines = (
        f'- {{choose: "true", when: "{first}", right: 4, wrong: 0}}',
        f'- {{choose: go, when: "{second}", right: 5, wrong: 1}}',
    )
    block = "".join(f"      {line}\n" for line in lines)
    wanted = HEAD + LAYOUTS[by].replace("{6}", block)
    assert made.rstrip("\n") == wanted.rstrip("\n")


def test_no_rules_are_an_empty_list(tmp_path: Path) -> None:
    path = tmp_path / "a.yaml"
    path.write_text(HEAD + "by: {alcsr: {}}\n")
    none = np.zeros(0, np.int64)
    rules = DecisionList(none, np.zeros((0, 2)), np.zeros((0, 2)), none, none, 1)

    made = with_rules(load(path), compile_arbiter(path).arbiter, "alcsr", rules).text

    assert made == HEAD + 'by:\n  alcsr:\n    otherwise: "true"\n    rules: []\n'
