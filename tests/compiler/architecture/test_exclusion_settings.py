"""What choices set in the place of a reading: proved for all of it, and refuted where it matters.

k lies within [0, 2] and is wired to the sensor a, which p reads, too.
"""

import pytest

from compiler.architecture.exclusion.answer import Proof, Witness
from compiler.architecture.exclusion.decide import decide
from runtime.arbiter import Paradigm
from runtime.architecture import Outside
from tests.compiler.architecture.exclusions import (
    INPUTS,
    Case,
    N,
    arbiter,
    behavior,
    random_readings,
    wired,
)

PARTS = ("first", "second")


def node(name: str, when: str | None, k: float | None = None, **more: object) -> N:
    """A behavior whose k is the sensor a's reading, times a number, if one is given."""
    wire = {} if k is None else {"k": ("a.r", k, Outside.INHIBIT)}
    return N(name, behavior(), inputs={**INPUTS, **wire}, acts_when=when, **more)  # type: ignore[arg-type]


def case_of(*nodes: N, sets: dict[str, float]) -> Case:
    """The nodes, and an arbiter that sets these where b reads more than 1."""
    made = arbiter(("x", "y"), [(0, "q 1 gt", None, 0.0), (1, None, None, 0.0)])
    setter = N("choose", made, inputs=INPUTS, choices={"x": ((), sets), "y": ()})  # type: ignore[arg-type]
    return wired([*nodes, setter])


def never_both(case: Case) -> bool:
    return not any(case.both_act(random_readings(seed, 40), 40) for seed in range(6))


SAFE = {
    "what is set keeps it from acting as readings do": case_of(
        node("first", "k 0.5 gt", 1.0), node("second", "p 0.5 le"), sets={"first.k": 0.25}
    ),
    "a reading outside inhibits, and what is set does not let it act": case_of(
        node("first", "k 1.5 lt", 2.0), node("second", "p 1 gt"), sets={"first.k": 1.75}
    ),
    "a combined one whose reading never leaves the domain": case_of(
        node("first", None),
        node("second", None),
        node("both", None, 1.0, replaces=PARTS),
        sets={"both.k": 1.0},
    ),
    "a combined one whose reading is inside where its parts act": case_of(
        node("first", "p 1 le"),
        node("second", None),
        node("both", None, 2.0, replaces=PARTS),
        sets={"both.k": 1.0},
    ),
}
UNSAFE = {
    "what is set lets it act": case_of(
        node("first", "k 0.5 gt", 1.0), node("second", "p 0.5 le"), sets={"first.k": 0.75}
    ),
    "what is set takes the place of a reading outside": case_of(
        node("first", "k 1.5 lt", 2.0), node("second", "p 1 gt"), sets={"first.k": 1.25}
    ),
    "what is set keeps a combined one from acting": case_of(
        node("first", None),
        node("second", None),
        node("both", "k 1 gt", replaces=PARTS),
        sets={"both.k": 0.5},
    ),
    "a reading outside inhibits a combined one, unless it is set": case_of(
        node("first", "p 1.25 le"),
        node("second", None),
        node("both", None, 2.0, replaces=PARTS),
        sets={"both.k": 1.0},
    ),
}


def remembering(value: float) -> Case:
    """A layer that holds while k is below 0.5, beside who acts where p is not."""
    layers = arbiter(("x", "y"), [(0, "k 0.5 lt", "k 0.5 ge", 0.0)], paradigm=Paradigm.SUBSUMPTION)
    inputs = {**INPUTS, "k": ("a.r", 1.0, Outside.CLIP)}
    governor = N("govern", layers, inputs=inputs, choices={"x": ("first",), "y": ()})  # type: ignore[arg-type]
    others = node("first", None), node("second", "p 0.5 ge")
    return case_of(*others, governor, sets={"govern.k": value})


SAFE["a rule that what is set does not let begin"] = remembering(1.0)
UNSAFE["a rule that begins to hold by what is set"] = remembering(0.25)


@pytest.mark.parametrize("name", SAFE)
def test_it_is_proved_whether_or_not_a_choice_sets_it(name: str) -> None:
    assert isinstance(decide(SAFE[name].question), Proof)
    assert never_both(SAFE[name])


@pytest.mark.parametrize("name", UNSAFE)
def test_it_is_not_proved_where_a_setting_or_a_reading_lets_both_act(name: str) -> None:
    assert not isinstance(decide(UNSAFE[name].question), Proof)
    assert not never_both(UNSAFE[name])


def test_a_witness_says_what_a_choice_sets() -> None:
    answer = decide(UNSAFE["what is set lets it act"].question)

    assert isinstance(answer, Witness)
    assert answer.assumed == ("a choice sets first's k to 0.75",)


def test_a_witness_says_where_no_choice_may_set() -> None:
    answer = decide(UNSAFE["a reading outside inhibits a combined one, unless it is set"].question)

    assert isinstance(answer, Witness)
    assert answer.assumed == ("no choice sets both's k then",)
