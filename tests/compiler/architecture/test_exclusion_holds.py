"""The law of exclusion: where it is proved, no run ever tells a conflict."""

from dataclasses import replace

from hypothesis import given, note, settings
from hypothesis import strategies as st

from compiler.architecture.exclusion.answer import Proof
from compiler.architecture.exclusion.decide import decide
from runtime.architecture import Outside
from runtime.code import Code
from runtime.program import Kind, Output, Program
from tests.compiler.architecture.exclusions import (
    SIGNALS,
    TOP,
    Case,
    N,
    arbiter,
    behavior,
    conditions,
    periods,
    random_readings,
    responses,
    rules,
    wired,
)
from tests.runtime.behaviors import NOWHERE, ONE

givings = st.sampled_from(["p", "p", "p abs sqrt", "p sqrt", "p 1 sub sqrt", "1 q div", "p log"])
outsides = st.sampled_from([Outside.CLIP, Outside.INHIBIT])
scales = st.sampled_from([1.0, 1.0, -1.0, 0.5, 1.5, 2.0])


@st.composite
def programs(draw: st.DrawFn) -> Program:
    """What may read an angle, and may have no number to give."""
    made = behavior()
    p, *others = made.states
    if draw(st.integers(0, 2)) == 0:
        low = draw(st.sampled_from([-0.5, 0.0, 0.25]))
        p = replace(p, kind=Kind.PERIODIC, low=low, high=low + 1.0, hold=low)
    told = Output("v", ONE, Code(draw(givings)), "", NOWHERE)
    return replace(made, states=(p, *others), outputs=(told,))


@st.composite
def cases(draw: st.DrawFn) -> Case:
    """Three behaviors, some combined, under an arbiter that may choose nothing."""
    timing = {"period": draw(periods), "response": draw(responses)}
    sources = [*SIGNALS, "choose.choice", "first.v"]

    def node(name: str, *, parts: tuple[str, ...] = ()) -> N:
        same = draw(st.integers(0, 3)) > 0
        other = {"period": draw(periods), "response": draw(responses)}
        mine = timing if same else other
        wires: dict[str, object] = {
            "p": (draw(st.sampled_from(SIGNALS)), draw(scales), draw(outsides)),
            "q": (draw(st.sampled_from(sources)), 1.0, draw(outsides)),
        }
        if draw(st.integers(0, 3)) == 0:
            wires["k"] = (draw(st.sampled_from(SIGNALS)), draw(scales), Outside.INHIBIT)
        when = draw(st.none() | conditions)
        commands = {"x": ("v", "set-point")}
        runs = draw(programs())
        return N(
            name, runs, inputs=wires, acts_when=when, replaces=parts, commands=commands, **mine
        )  # type: ignore[arg-type]

    nodes = [node("first"), node("second"), node("third")]
    parts = draw(st.sampled_from([(), ("first", "second"), ("first", "second", "third")]))
    if parts:
        nodes.append(node("both", parts=parts))
        if draw(st.booleans()):
            nodes.append(node("more", parts=("first", "second")))
    made = arbiter(("x", "y"), draw(st.lists(rules, min_size=1, max_size=2)))
    acts = draw(st.sampled_from([((), ()), (("first",), ("second",)), (("third",), ())]))
    means = {"x": (acts[0], {"both.k": 1.0}) if parts else acts[0], "y": acts[1]}
    reads = {"p": SIGNALS[0], "q": SIGNALS[1]}
    nodes.append(N("choose", made, inputs=reads, choices=means, level=1, **timing))  # type: ignore[arg-type]
    found = wired(nodes)
    ends = {"choose.choice": (-1.0, 1.0), "first.v": (-1e9, 1e9)}
    limits = dict.fromkeys(SIGNALS, (0.0, TOP)) | ends
    board = tuple(
        replace(
            one,
            low=limits.get(one.name, (one.low, one.high))[0],
            high=limits.get(one.name, (one.low, one.high))[1],
        )
        for one in found.wired.board
    )
    return replace(found, wired=replace(found.wired, board=board))


@settings(max_examples=6, deadline=None)
@given(cases(), st.integers(0, 2**32 - 1))
def test_no_run_has_a_conflict_where_exclusion_is_proved(case: Case, seed: int) -> None:
    answer = decide(case.question)
    note(repr(answer))

    if isinstance(answer, Proof):
        for further in range(2):
            assert not case.both_act(random_readings(seed + further, 30), 30)
