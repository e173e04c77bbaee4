"""Architectures drawn at large: what combines, inhibits, chooses nothing, or is a Python function.

The functions at the end are the user's own code of these architectures.
"""

from collections.abc import Mapping
from dataclasses import replace

from hypothesis import strategies as st

from compiler.architecture.codes import range_of_code
from compiler.architecture.signals import box_of
from runtime.arbiter import Arbiter, Paradigm
from runtime.architecture import Outside
from runtime.code import Code
from runtime.program import Kind, Output, Program
from tests.compiler.architecture.exclusions import (
    SIGNALS,
    STEP,
    TOP,
    Case,
    N,
    arbiter,
    behavior,
    conditions,
    periods,
    responses,
    rules,
    thresholds,
    wired,
)
from tests.runtime.behaviors import NOWHERE, ONE

givings = st.sampled_from(["p", "p", "p abs sqrt", "p sqrt", "p 1 sub sqrt", "1 q div", "p log"])
outsides = st.sampled_from([Outside.CLIP, Outside.INHIBIT])
scales = st.sampled_from([1.0, 1.0, -1.0, 0.5, 1.5, 2.0])
TELLERS = ("choose.choice", "first.v", "module.m")


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
def choosers(draw: st.DrawFn) -> Arbiter:
    """Rules, layers, or a Python function that may let both choices hold."""
    how = draw(st.sampled_from([Paradigm.RULES] * 4 + [Paradigm.SUBSUMPTION, Paradigm.MODULE]))
    if how is Paradigm.MODULE:
        return replace(arbiter(("x", "y"), paradigm=how), module=f"{__name__}:by_halves")
    return arbiter(("x", "y"), draw(st.lists(rules, min_size=1, max_size=2)), paradigm=how)


@st.composite
def cases_at_large(draw: st.DrawFn) -> Case:
    """Three behaviors, some combined, under an arbiter, which may stand under another."""
    timing = {"period": draw(periods), "response": draw(responses)}

    def timed() -> dict[str, float]:
        if draw(st.integers(0, 3)) > 0:
            return timing
        return {"period": draw(periods), "response": draw(responses)}

    def wires(*sources: str) -> dict[str, object]:
        return {
            "p": (draw(st.sampled_from(SIGNALS)), draw(scales), draw(outsides)),
            "q": (draw(st.sampled_from(sources)), 1.0, draw(outsides)),
        }

    def node(name: str, channel: str, *, parts: tuple[str, ...] = ()) -> N:
        inputs = wires(*SIGNALS, *SIGNALS, *TELLERS)
        if draw(st.integers(0, 3)) == 0:
            inputs["k"] = (draw(st.sampled_from(SIGNALS)), draw(scales), draw(outsides))
        return N(  # type: ignore[arg-type]
            name,
            draw(programs()),
            inputs=inputs,
            acts_when=draw(st.none() | conditions),
            replaces=parts,
            commands={channel: ("v", "set-point")},
            **timed(),
        )

    tells = {"p": SIGNALS[0], "q": (SIGNALS[1], 1.0, Outside.INHIBIT)}
    module = N("module", f"{__name__}:larger", inputs=tells, tells=("m",), **timed())  # type: ignore[arg-type]
    nodes = [module, node("first", "x"), node("second", "x"), node("third", "y")]
    parts = draw(st.sampled_from([(), ("first", "second"), ("first", "second", "third")]))
    if parts:
        nodes.append(node("both", "x", parts=parts))
        if draw(st.booleans()):
            nodes.append(node("more", "x", parts=("first", "second")))
    acts = draw(
        st.sampled_from(
            [((), ()), (("first",), ("second",)), (("third",), ()), (("first", "module"), ())]
        )
    )
    sets = {"first.k": draw(thresholds)} if draw(st.booleans()) else {}
    if parts:
        sets["both.k"] = draw(thresholds)
    means = {"x": (acts[0], sets), "y": acts[1]}
    reads = draw(st.sampled_from([(), ("first.v", "module.m")]))
    inputs = wires(*SIGNALS, *reads)
    nodes.append(N("choose", draw(choosers()), inputs=inputs, choices=means, level=1, **timed()))  # type: ignore[arg-type]
    if draw(st.integers(0, 3)) == 0:
        above = {"x": ("choose",), "y": draw(st.sampled_from([(), ("second",)]))}
        over = N("top", draw(choosers()), inputs=wires(*SIGNALS), choices=above, level=2, **timed())  # type: ignore[arg-type]
        nodes.append(over)
    nodes = _in_order(nodes)
    return with_ranges(wired(nodes), nodes)


def _in_order(nodes: list[N]) -> list[N]:
    """The nodes; who tells what an earlier one reads, or itself, answers later, as must be."""
    read_before: dict[str, int] = {}
    for place, node in enumerate(nodes):
        for source in node.inputs.values():
            signal = source[0] if isinstance(source, tuple) else str(source)
            read_before.setdefault(signal.partition(".")[0], place)
    return [
        replace(node, response=max(node.response, STEP))
        if read_before.get(node.name, place + 1) <= place
        else node
        for place, node in enumerate(nodes)
    ]


def with_ranges(case: Case, nodes: list[N]) -> Case:
    """The case with the domain of everything that nodes tell."""
    ends = dict.fromkeys(SIGNALS, (0.0, TOP))
    for one in nodes:
        if isinstance(one.runs, Program):
            box = box_of(one.runs)
            for output in one.runs.outputs:
                ends[f"{one.name}.{output.name}"] = range_of_code(output.code, box)
        elif isinstance(one.runs, Arbiter):
            ends[f"{one.name}.choice"] = (-1.0, 1.0)
    board = tuple(
        replace(one, low=ends[one.name][0], high=ends[one.name][1]) if one.name in ends else one
        for one in case.wired.board
    )
    return replace(case, wired=replace(case.wired, board=board))


def larger(reads: Mapping[str, float], time: float) -> dict[str, float]:
    """A module that tells the larger of what it reads."""
    del time
    return {"m": max(reads.values())}


def by_halves(reads: Mapping[str, float], time: float) -> dict[str, float]:
    """An arbiter of which both choices may hold."""
    del time
    return {"x": max(reads["p"], 0.0), "y": max(reads["q"] - 0.5, 0.0)}
