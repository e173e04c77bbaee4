"""What a combined behavior proves by acting in place of its parts: only if it surely acts."""

from dataclasses import replace
from pathlib import Path

import pytest

from compiler.architecture.exclusion.answer import Answer, Proof, Undecided, Witness
from compiler.architecture.exclusion.decide import decide
from compiler.check import check
from runtime.arbiter import Paradigm
from runtime.architecture import Outside
from runtime.code import Code
from runtime.program import Output, Program, Role
from tests.compiler.architecture.at_large import with_ranges
from tests.compiler.architecture.exclusions import INPUTS, Case, N, acting, arbiter, behavior, wired
from tests.runtime.behaviors import NOWHERE, ONE, formula_program, state

PARTS = ("first", "second")
INHIBITS = Outside.INHIBIT
LOW = {0: [0.25] * 3, 1: [0.25] * 3}


def giving(code: str) -> Program:
    """A behavior whose output `v` is this; p and q lie within [-2, 2]."""
    return replace(behavior(), outputs=(Output("v", ONE, Code(code), "", NOWHERE),))


def combining(runs: Program, **more: object) -> N:
    commands = {"x": ("v", "set-point")} if runs.outputs else {}
    return N("both", runs, inputs=INPUTS, replaces=PARTS, commands=commands, **more)  # type: ignore[arg-type]


def case_of(*nodes: N) -> Case:
    return wired([acting("first"), acting("second"), *nodes])


def answer_of(*nodes: N) -> Answer:
    return decide(case_of(*nodes).question)


@pytest.mark.parametrize("code", ["p 1 sub sqrt", "1 p div", "p log", "p q sub 1e308 mul 2 mul"])
def test_one_that_may_give_no_number_proves_nothing(code: str) -> None:
    answer = answer_of(combining(giving(code)))

    assert isinstance(answer, Undecided)
    assert "'v' of both may be no number" in answer.reason


def test_where_it_gives_no_number_its_parts_do_both_act() -> None:
    assert case_of(combining(giving("p 1 sub sqrt"))).both_act(LOW, 3) == [0, 1, 2]
    assert not case_of(combining(giving("p 1 sub abs sqrt"))).both_act(LOW, 3)


@pytest.mark.parametrize("code", ["p abs sqrt", "1 p 3 sub div", "p", "p sin"])
def test_one_whose_numbers_are_finite_acts_in_their_place(code: str) -> None:
    assert isinstance(answer_of(combining(giving(code))), Proof)


@pytest.mark.parametrize(
    ("rate", "is_proved"), [("y sqrt", False), ("p y sub", True), ("y 1 add", True)]
)
def test_its_rates_are_finite_a_period_on(rate: str, is_proved: bool) -> None:  # noqa: FBT001
    """`y sqrt` has no value below 0, and its own state y may begin at -1."""
    own = replace(state("y", -1.0, 1.0), role=Role.DRIVEN)
    runs = formula_program((*behavior().states[:2], own), {"y": rate}, behavior().controls)

    assert isinstance(answer_of(combining(runs)), Proof) is is_proved


def test_what_it_reads_must_be_a_number() -> None:
    wild = replace(giving("p log"), name="wild")
    teller = N("teller", wild, inputs=INPUTS)
    both = N("both", giving("p"), inputs={**INPUTS, "q": "teller.v"}, replaces=PARTS)

    answer = answer_of(teller, both)

    assert isinstance(answer, Undecided)
    assert "both reads teller.v, which may be no number" in answer.reason


def test_an_arbiter_of_any_choices_may_not_let_it_act() -> None:
    contest = arbiter(("x", "y"), paradigm=Paradigm.MODULE)
    chooser = N("choose", contest, inputs=INPUTS, choices={"x": ("both",), "y": ()})

    assert isinstance(answer_of(combining(giving("p")), chooser), Undecided)


def test_a_control_that_a_choice_may_set_still_inhibits() -> None:
    both = replace(combining(giving("p")), inputs={**INPUTS, "k": ("a.r", 2.0, INHIBITS)})
    rules = [(0, "p 5 gt", None, 0.0), (1, None, None, 0.0)]
    setter = N(
        "choose",
        arbiter(("x", "y"), rules),  # type: ignore[arg-type]
        inputs=INPUTS,
        choices={"x": ((), {"both.k": 1.0}), "y": ()},
    )

    answer = answer_of(both, setter)

    assert not isinstance(answer, Proof)
    assert case_of(both, setter).both_act({0: [2.0] * 3, 1: [0.0] * 3}, 3) == [0, 1, 2]


def test_a_witness_tells_the_reading_that_keeps_it_from_acting() -> None:
    both = replace(combining(giving("p")), inputs={**INPUTS, "k": ("a.r", 2.0, INHIBITS)})

    answer = answer_of(both)

    assert isinstance(answer, Witness)
    assert answer.text == (
        "first and second both act at 0 s: at 0 s a.r is 1.5 (both does not act from 0 s)"
    )
    assert case_of(both).replayed(answer)


def test_what_it_is_told_may_be_outside_only_where_that_is_assumed() -> None:
    teller = N("teller", giving("p 3 mul"), inputs=INPUTS)
    both = replace(combining(giving("p")), inputs={**INPUTS, "q": ("teller.v", 1.0, INHIBITS)})
    nodes = [acting("first"), acting("second"), teller, both]

    answer = decide(with_ranges(wired(nodes), nodes).question)

    assert isinstance(answer, Witness)
    assert len(answer.assumed) == 1
    assert "teller.v is" in answer.assumed[0]


def test_a_choice_of_nothing_keeps_who_reads_it_from_acting(tmp_path: Path) -> None:
    """Where no rule holds, `choice` is -1: outside of the values of whom it is wired to."""
    body, told = (Path(__file__).parents[2] / "golden/bad/parts" / n for n in ("courier", "told"))
    text = (
        "specc: 1\nkind: architecture\nname: tried\nbody: {body}.yaml\nnodes:\n"
        "  one: {{behavior: {seek}.yaml, {sense}}}\n  two: {{behavior: {seek}.yaml, {sense}}}\n"
        "  both: {{behavior: combined.yaml, period: 50 ms, replaces: [one, two],\n"
        "    sense: {{left: {{from: bumper.hit, outside: clip}},\n"
        "      action: {{from: choose.choice, outside: inhibit}}}}}}\n"
        "  choose: {{arbiter: {rules}.yaml, period: 50 ms, sense: {{ahead: ahead.range}},\n"
        "    choices: {{forward: [], turn: []}}}}\n"
    )
    sense = (
        "period: 50 ms, sense: {bearing: beacon.bearing, "
        "distance: {from: beacon.distance, outside: clip}}"
    )
    combined = told.with_suffix(".yaml").read_text(encoding="utf-8").replace("told", "combined")
    combined += "constants: {pace: {value: 0.1, unit: m/s}, spin: {value: 0.1, unit: rad/s}}\n"
    combined += "output: {go: {unit: m/s, is: pace}, turn: {unit: rad/s, is: spin}}\n"
    combined += "realizes: {go: base.speed as set-point, turn: base.turn as set-point}\n"
    (tmp_path / "combined.yaml").write_text(combined, encoding="utf-8")
    unsure = told.with_name("unsure.yaml").read_text(encoding="utf-8")
    (tmp_path / "sure.yaml").write_text(
        unsure.replace("unsure", "sure").replace(", when: ahead > 2 * near", ""), encoding="utf-8"
    )
    tried = tmp_path / "tried.yaml"

    def codes(rules: Path) -> set[str]:
        tried.write_text(
            text.format(body=body, seek=body.with_name("seek"), sense=sense, rules=rules),
            encoding="utf-8",
        )
        return {found.code for found in check(tried) if found.code != "S362"}

    assert codes(told.with_name("unsure")) == {"S345"}
    assert codes(tmp_path / "sure") == set()
