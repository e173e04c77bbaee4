"""Exclusion proved by structure, conditions, memory and time, or refuted with a state."""

import itertools
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from compiler.architecture.exclusion.answer import Proof, Undecided, Witness
from compiler.architecture.exclusion.decide import decide
from compiler.architecture.exclusion.overlap import instants, timing_of
from compiler.architecture.exclusion.question import (
    Actor,
    Decider,
    Entry,
    How,
    Question,
    Signal,
)
from compiler.check import check
from runtime.arbiter import Paradigm
from runtime.architecture import Outside
from runtime.code import Code
from runtime.program import Unit
from tests.compiler.architecture.exclusions import INPUTS, STEP, Case, N, acting, arbiter, wired

METER = Unit("m", 1.0)
REFUSED = Path(__file__).parents[2] / "golden" / "bad" / "exclusion_of_conditions.yaml"
NEAR, FAR_OFF = "p 0.5 lt", "p 0.5 ge"
FLEE_OR_GO = (("first",), ("second",))


def choosing(
    name: str,
    rules: list[tuple[int, str | None, str | None, float]],
    means: tuple[tuple[str, ...], ...] = FLEE_OR_GO,
    paradigm: Paradigm = Paradigm.RULES,
    **more: float,
) -> N:
    made = arbiter(("flee", "go"), rules, paradigm=paradigm)
    choices = dict(zip(("flee", "go"), means, strict=True))
    return N(name, made, inputs=INPUTS, choices=choices, **more)  # type: ignore[arg-type]


HYSTERESIS: list[tuple[int, str | None, str | None, float]] = [
    (0, "p 0.5 lt", "p 0.75 gt", 3 * STEP),
    (1, None, None, 0.0),
]
LAYERS = {"paradigm": Paradigm.SUBSUMPTION}
APART: dict[str, object] = {"response": 2 * STEP}
ONLY_FLEE, ONLY_GO = (("first",), ()), ((), ("second",))

PROVED: dict[str, Case] = {
    "one arbiter of rules": wired(
        [acting("first"), acting("second"), choosing("choose", HYSTERESIS)]
    ),
    "conditions that exclude each other": wired([acting("first", NEAR), acting("second", FAR_OFF)]),
    "a condition that compares with a control": wired(
        [acting("first", "p k lt"), acting("second", "p k ge")]
    ),
    "layers that exclude each other": wired(
        [
            acting("first"),
            acting("second"),
            choosing("layers", [(0, NEAR, None, 0.0), (1, FAR_OFF, None, 0.0)], **LAYERS),
        ]
    ),
    "hysteresis whose ends leave a gap": wired(
        [
            acting("first"),
            acting("second"),
            choosing(
                "layers", [(0, NEAR, "p 0.75 gt", 0.0), (1, "p 1 gt", "p 1 le", 0.0)], **LAYERS
            ),
        ]
    ),
    "two arbiters that remember the same": wired(
        [
            acting("first"),
            acting("second"),
            choosing("left", HYSTERESIS, ONLY_FLEE),
            choosing("right", HYSTERESIS, ONLY_GO),
        ]
    ),
    "an arbiter above that chooses between two": wired(
        [
            acting("first"),
            acting("second"),
            choosing("left", [(0, NEAR, None, 0.0)], ONLY_FLEE),
            choosing("right", [(1, NEAR, None, 0.0)], ONLY_GO),
            choosing("above", HYSTERESIS, (("left",), ("right",))),
        ]
    ),
    "other periods, and a sensor so slow that both see the same": wired(
        [acting("first", NEAR, period=2 * STEP), acting("second", FAR_OFF)], ((4, 0), (1, 0))
    ),
}
PROVED["a combined behavior in the place of both"] = wired(
    [acting("first", NEAR), acting("second"), acting("both", replaces=("first", "second"))]
)
# A reading beyond the domain keeps the arbiter from deciding, but its rules go on with the edge.
BEYOND = {"p": ("a.r", 1.5, Outside.INHIBIT), "q": "b.r"}


def latched_beyond(when: str) -> Case:
    layers = choosing("layers", [(0, when, "p 0.25 lt", 0.0)], ONLY_FLEE, **LAYERS)
    return wired([acting("first"), acting("second"), replace(layers, inputs=BEYOND)])


PROVED["a rule that would begin only beyond the domain"] = latched_beyond("p 2 gt")
REFUTED: dict[str, Case] = {
    "conditions that touch": wired([acting("first", "p 0.5 le"), acting("second", FAR_OFF)]),
    "other response times": wired([acting("first", NEAR), acting("second", FAR_OFF, **APART)]),
    "other periods": wired([acting("first", NEAR, period=2 * STEP), acting("second", FAR_OFF)]),
    "a node that nothing governs": wired(
        [acting("first"), acting("second"), choosing("choose", HYSTERESIS, ONLY_FLEE)]
    ),
    "a choice that lets both act": wired(
        [
            acting("first"),
            acting("second"),
            choosing("choose", HYSTERESIS, (("first", "second"), ())),
        ]
    ),
    "hysteresis that goes on while the other begins": wired(
        [
            acting("first"),
            acting("second"),
            choosing("layers", [(0, NEAR, "p 0.75 gt", 0.0), (1, FAR_OFF, None, 0.0)], **LAYERS),
        ]
    ),
    "a rule that begins at the edge of the domain": latched_beyond("p 2 eq"),
    "a rule that lasts": wired(
        [
            acting("first"),
            acting("second"),
            choosing("layers", [(0, NEAR, None, 2 * STEP), (1, FAR_OFF, None, 0.0)], **LAYERS),
        ]
    ),
    "two arbiters that remember unlike": wired(
        [
            acting("first"),
            acting("second"),
            choosing("left", HYSTERESIS, ONLY_FLEE),
            choosing("right", [(0, "p 0.5 lt", "p 0.75 gt", 0.0), HYSTERESIS[1]], ONLY_GO),
        ]
    ),
    "a combined behavior that answers later": wired(
        [
            acting("first", NEAR),
            acting("second"),
            acting("both", response=STEP, replaces=("first", "second")),
        ]
    ),
    "a combined behavior that does not always act": wired(
        [
            acting("first", NEAR),
            acting("second"),
            acting("both", "p 0.25 gt", replaces=("first", "second")),
        ]
    ),
    "a combined behavior that looks again while both go on": wired(
        [
            acting("first", "p 0.75 gt", period=2 * STEP, response=0.0),
            acting("second", period=2 * STEP, response=0.0),
            acting("both", "p 0.75 gt", response=0.0, replaces=("first", "second")),
        ]
    ),
    "a combined behavior that looks again while a rule lasts": wired(
        [
            acting("first"),
            acting("second", period=4 * STEP),
            choosing("layers", [(0, "p 0.75 gt", None, 3 * STEP)], ONLY_FLEE, **LAYERS),
            acting("both", "p 0.75 gt", response=0.0, replaces=("first", "second")),
        ]
    ),
    "a combined behavior of three, of which two act": wired(
        [
            acting("first", NEAR),
            acting("second"),
            acting("third", "p 0.25 lt"),
            acting("both", replaces=("first", "second", "third")),
        ]
    ),
    "rules of one arbiter that answer at other times": wired(
        [
            acting("first"),
            acting("second"),
            choosing("left", HYSTERESIS, ONLY_FLEE),
            choosing("right", HYSTERESIS, ONLY_GO, response=STEP),
        ]
    ),
}

REFUTED["one choice for both, of an arbiter that remembers, by a late sensor"] = wired(
    [
        acting("first", response=STEP),
        acting("second", period=2 * STEP, response=STEP),
        choosing("choose", HYSTERESIS, (("first",), ("second", "first")), response=STEP),
    ],
    ((1, 1), (2, 1)),
)


@pytest.mark.parametrize("name", PROVED)
def test_exclusion_is_proved(name: str) -> None:
    assert isinstance(decide(PROVED[name].question), Proof)


@pytest.mark.parametrize("name", REFUTED)
def test_exclusion_is_refuted_with_a_state_that_the_scheduler_reaches(name: str) -> None:
    answer = decide(REFUTED[name].question)

    assert isinstance(answer, Witness)
    assert REFUTED[name].replayed(answer)


@pytest.mark.parametrize("late", range(4))
def test_a_sensor_may_be_as_late_as_it_likes_where_one_choice_lets_both_act(late: int) -> None:
    known = REFUTED["one choice for both, of an arbiter that remembers, by a late sensor"]
    case = replace(known, sensors=((1, late), (2, late)))

    answer = decide(case.question)

    assert isinstance(answer, Witness)
    assert answer.text == (
        "first and second both act at 0.01 s: at 0 s a.r is 1 (choose chooses go from 0.01 s)"
    )
    assert "let choice go of choose name one of them" in answer.help
    assert case.replayed(answer)


def test_one_choice_for_both_is_named_even_where_no_run_to_it_is_found() -> None:
    rules: list[tuple[int, str | None, str | None, float]] = [
        (0, "p 0.5 ge", None, 0.0),
        (1, "p 1 gt", "p 1.5 gt", 0.0),
    ]
    choose = choosing("choose", rules, (("first",), ("second", "first")))

    answer = decide(wired([acting("first"), acting("second"), choose], ((8, 0), (1, 0))).question)

    assert isinstance(answer, Undecided)
    assert answer.reason.endswith("between any two ticks, which a.r and b.r do not")
    assert "let choice go of choose name one of them" in answer.help


def test_weights_exclude_where_no_point_has_both_above_zero() -> None:
    def weighed(flee: str, go: str) -> Case:
        made = arbiter(("flee", "go"), weights=(flee, go), paradigm=Paradigm.WEIGHTS)
        choices = {"flee": ("first",), "go": ("second",)}
        return wired(
            [acting("first"), acting("second"), N("blend", made, inputs=INPUTS, choices=choices)]
        )

    assert isinstance(decide(weighed("1 p sub", "p 1 sub").question), Proof)
    assert isinstance(decide(weighed("1 p sub", "p 0.9 sub").question), Witness)


def test_what_a_function_chooses_is_nobodys_to_know() -> None:
    made = arbiter(("flee", "go"), paradigm=Paradigm.MODULE)
    choices = {"flee": ("first",), "go": ("second",)}
    nodes = [acting("first"), acting("second"), N("learned", made, inputs=INPUTS, choices=choices)]

    answer = decide(wired(nodes).question)

    assert isinstance(answer, Undecided)
    assert "learned is a Python function" in answer.reason


def test_a_refused_architecture_is_proved_once_both_answer_as_quickly(tmp_path: Path) -> None:
    text = REFUSED.read_text(encoding="utf-8").replace("parts/", f"{REFUSED.parent / 'parts'}/")
    path = tmp_path / "tried.yaml"
    path.write_text(text, encoding="utf-8")
    assert [found.code for found in check(path)] == ["S345"]

    path.write_text(text.replace("response_time: 50 ms, ", ""), encoding="utf-8")

    assert not check(path)


def sensed(name: str, when: str, period: float, response: float) -> Decider:
    entry = Entry("c", METER, 0.0, 2.0, 0)
    codes = (Code(when),)
    return Decider(name, "", How.CONDITION, period, response, (entry,), ("acts",), codes=codes)


def asked(*deciders: Decider, every: float = 0.0, delay: float = 0.0) -> Question:
    signals = (Signal("clearance", METER, 0.0, 2.0, (), every, delay),)
    actors = [Actor(one.name, (((i, 0),),)) for i, one in enumerate(deciders)]
    return Question(signals, deciders, actors[0], actors[1])


def test_a_witness_is_told_in_one_sentence_with_units_and_times() -> None:
    question = asked(sensed("avoid", "c 0.3 lt", 0.1, 0.05), sensed("seek", "c 0.3 ge", 0.05, 0.05))

    answer = decide(question)

    assert isinstance(answer, Witness)
    assert answer.text == (
        "avoid and seek both act at 0.1 s: at 0 s clearance is 0.1 m (avoid acts until 0.15 s), "
        "at 0.05 s clearance is 1 m (seek acts from 0.1 s)"
    )
    assert "the same period and response_time" in answer.help


def test_a_witness_tells_why_a_combined_behavior_does_not_act_instead() -> None:
    case = REFUTED["a combined behavior that looks again while both go on"]

    answer = decide(case.question)

    assert isinstance(answer, Witness)
    assert answer.text == (
        "first and second both act at 0.01 s: at 0 s a.r is 1 (first acts until 0.02 s), "
        "at 0.01 s a.r is 0.4 (both does not act from 0.01 s)"
    )


def test_what_a_node_keeps_by_itself_is_said_to_be_assumed() -> None:
    mood = Entry("mood", METER, 0.0, 1.0)
    code = (Code("mood 0.5 gt"),)
    keeps = Decider("rest", "", How.CONDITION, 0.1, 0.0, (mood,), ("acts",), codes=code)

    answer = decide(asked(keeps, sensed("seek", "c 1 lt", 0.1, 0.0)))

    assert isinstance(answer, Witness)
    assert "rest's mood is" in answer.text
    assert answer.assumed


times = st.integers(1, 6)


@settings(max_examples=60)
@given(times, times, st.integers(0, 9), st.integers(0, 9), st.integers(0, 4), st.integers(0, 3))
def test_samples_in_effect_together_are_those_of_two_clocks_run_for_long(
    first: int, second: int, late: int, later: int, every: int, delay: int
) -> None:
    question = asked(
        sensed("a", "c", first * 0.01, late * 0.01),
        sensed("b", "c", second * 0.01, later * 0.01),
        every=every * 0.01,
        delay=delay * 0.01 if every else 0.0,
    )

    found = {_agree(one.samples, every, delay) for one in _steps(question)}

    # Two clocks that run, and a sensor that does.
    expected = set()
    held: list[int | None] = [None, None]
    for now in range(400):
        for i, (period, response) in enumerate(((first, late), (second, later))):
            if now >= response and (now - response) % period == 0:
                held[i] = now - response
        expected.add(_agree(tuple(held), every, delay))
    assert found | {(False, False)} == expected | {(False, False)}


def _steps(question: Question) -> list:  # type: ignore[type-arg]
    timing = timing_of(question)
    scale = round(float(timing.step) / 0.01)
    assert scale >= 1
    many = list(instants(question, timing))
    return [
        type(one)(one.at * scale, tuple(None if s is None else s * scale for s in one.samples))
        for one in many
    ]


def _agree(samples: tuple[int | None, ...], every: int, delay: int) -> tuple[bool, bool]:
    """Whether both were sampled, and saw the same version of the signal."""
    if None in samples:
        return (False, False)
    versions = [max((s - delay) // every, 0) if every else s for s in samples if s is not None]
    return (True, all(a == b for a, b in itertools.pairwise(versions)))
