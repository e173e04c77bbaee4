"""Where nodes tell what is no number: what rules remember of it, and who can't act."""

from dataclasses import replace

from compiler.architecture.exclusion.answer import Proof, Witness
from compiler.architecture.exclusion.decide import decide
from runtime.arbiter import Paradigm
from runtime.code import Code
from runtime.program import Output, Program
from tests.compiler.architecture.at_large import with_ranges
from tests.compiler.architecture.exclusions import INPUTS, Case, N, acting, arbiter, behavior, wired
from tests.runtime.behaviors import NOWHERE, ONE


def telling(code: str) -> Program:
    """A behavior whose output `v` is this; p and q lie within [-2, 2]."""
    return replace(behavior(), outputs=(Output("v", ONE, Code(code), "", NOWHERE),))


def latched(code: str) -> Case:
    """A layer that begins to hold where v is below -1, and then goes on."""
    layers = arbiter(("x", "y"), [(0, "p 1 neg lt", "p 3 gt", 0.0)], paradigm=Paradigm.SUBSUMPTION)
    inputs, choices = {"p": "teller.v", "q": "b.r"}, {"x": ("first",), "y": ()}
    nodes = [
        acting("first"),
        acting("second"),
        N("teller", telling(code), inputs=INPUTS),
        N("choose", layers, inputs=inputs, choices=choices),
    ]
    return with_ranges(wired(nodes), nodes)


def test_a_rule_may_begin_to_hold_by_what_is_no_number() -> None:
    """`sqrt(p - 1)` is never below -1; of no number the lowest value is read, which is -2."""
    case = latched("p 1 sub sqrt")

    assert not isinstance(decide(case.question), Proof)
    assert case.both_act({0: [0.5, 0.5, 1.5], 1: [0.0]}, 4) == [2, 3]


def test_of_a_number_it_is_known_where_it_lies() -> None:
    case = latched("p 1 sub abs sqrt")

    assert isinstance(decide(case.question), Proof)
    assert not case.both_act({0: [0.5, 0.5, 1.5], 1: [0.0]}, 4)


def test_a_state_in_which_a_node_may_have_no_number_to_give_is_said_to_assume_one() -> None:
    commands = {"x": ("v", "set-point")}
    rooted = N("first", telling("p 1 sub sqrt"), inputs=INPUTS, commands=commands)

    answer = decide(wired([rooted, acting("second")]).question)

    assert isinstance(answer, Witness)
    assert answer.assumed == ("first can act then ('v' of first may be no number)",)
    assert answer.text.endswith(", if first can act then ('v' of first may be no number)")
