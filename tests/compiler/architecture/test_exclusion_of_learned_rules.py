"""Exclusion is proved and refuted on learned rules as on those written by hand, over two reads."""

from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from compiler.architecture.compile import compile_architecture
from compiler.check import check
from spec_schema.diagnostics import Diagnostic, SpecError

PARTS = Path(__file__).parents[2] / "golden" / "bad" / "parts"
READS = "reads: {ahead: {unit: m, domain: [0, 2]}, light: {unit: lx, domain: [0, 100]}}\n"
SENSE = "sense: {ahead: ahead.range, light: {from: lamp.light, outside: clip}}"
CONSTANTS = (
    "constants: {a: {value: 0.3, unit: m}, b: {value: 8, unit: lx}, c: {value: 0.25, unit: m}}\n"
)
NEAR = "ahead < {a} and light < {b}"
"""In the box flee is chosen: by `choose`, and by `pace`, which lets seek act elsewhere."""


def arbiter(path: Path, by: str) -> None:
    head = f"specc: 1\nkind: arbiter\nname: {path.stem}\n{READS}"
    path.write_text(f"{head}{CONSTANTS}choices: [flee, go]\nby: {by}\n", encoding="utf-8")


def learned(*boxes: str) -> str:
    rules = ", ".join(f'{{choose: flee, when: "{box}"}}' for box in boxes)
    return f"{{alcsr: {{otherwise: go, rules: [{rules}]}}}}"


def by_hand(*boxes: str) -> str:
    rules = ", ".join(f'{{choose: flee, when: "{box}"}}' for box in boxes)
    return f"{{rules: [{rules}, {{choose: go}}]}}"


def two_arbiters(folder: Path, choose: str, pace: str, times: str = "period: 50 ms") -> Path:
    """`choose` lets avoid act where it flees, `pace` seek where it goes, on the same channels."""
    arbiter(folder / "choose.yaml", choose)
    arbiter(folder / "pace.yaml", pace)
    path = folder / "tried.yaml"
    path.write_text(
        "specc: 1\nkind: architecture\nname: tried\n"
        f"body: {PARTS}/courier.yaml\nnodes:\n"
        f"  avoid: {{behavior: {PARTS}/avoid.yaml, period: 50 ms, "
        "sense: {clearance: {from: ahead.range, outside: clip}}}\n"
        f"  seek: {{behavior: {PARTS}/seek.yaml, period: 50 ms, sense: {{bearing: beacon.bearing, "
        "distance: {from: beacon.distance, outside: clip}}}\n"
        f"  choose: {{arbiter: choose.yaml, period: 50 ms, {SENSE}, "
        "choices: {flee: avoid, go: []}}\n"
        f"  pace: {{arbiter: pace.yaml, {times}, {SENSE}, choices: {{flee: [], go: seek}}}}\n"
        "channels: {base.speed: {exclusive: choose}, base.turn: {exclusive: choose}}\n",
        encoding="utf-8",
    )
    return path


def silent(_what: str, _done: int, _of: int) -> None:
    """Nobody watches."""


def refused(path: Path) -> list[Diagnostic]:
    return [one for one in check(path) if one.code == "S345"]


SI = {"a": "0.3", "b": "8", "c": "0.25"}
NAMES = {key: key for key in SI}


def test_two_learned_arbiters_of_the_same_box_are_proved_to_exclude_each_other(
    tmp_path: Path,
) -> None:
    box = NEAR.format(**SI)
    made = compile_architecture(two_arbiters(tmp_path, learned(box), learned(box)), silent)

    proofs = [channel.resolution.proof for channel in made.architecture.channels]
    assert len(proofs) == 2
    assert all(proofs)


def test_a_box_cut_into_rules_is_the_box(tmp_path: Path) -> None:
    """The second covers it by three rules, one of which reaches beyond what an earlier one left."""
    parts = learned(
        "ahead < 0.3 and light < 3",
        "ahead < 0.1 and 3 <= light < 8",
        "0.1 <= ahead < 0.3 and light >= 3 and light < 8",
    )

    assert not refused(two_arbiters(tmp_path, learned(NEAR.format(**SI)), parts))


def test_a_state_in_which_both_act_is_told_as_of_rules_by_hand(tmp_path: Path) -> None:
    told = []
    for written, names in ((learned, SI), (by_hand, NAMES)):
        smaller = f"ahead < {names['c']} and light < {names['b']}"
        path = two_arbiters(tmp_path, written(NEAR.format(**names)), written(smaller))
        told.append([(one.message, one.help) for one in refused(path)])
        with pytest.raises(SpecError):
            compile_architecture(path, silent)

    assert told[0] == told[1]
    message, _ = told[0][0]
    assert message.startswith("avoid and seek both act at 0 s: at 0 s ahead.range is ")
    assert "lamp.light is " in message
    assert message.endswith("(choose chooses flee from 0 s and pace chooses go from 0 s)")


def test_at_other_times_the_same_boxes_exclude_nothing(tmp_path: Path) -> None:
    box, late = NEAR.format(**SI), "period: 50 ms, response_time: 50 ms"

    assert refused(two_arbiters(tmp_path, learned(box), learned(box), late))


EDGES = st.sampled_from([0.0, 0.3, 0.5, 1.0, 2.0])
BOXES = st.tuples(EDGES, EDGES, EDGES, EDGES)


def text_of(box: tuple[float, float, float, float], scale: float = 50.0) -> str:
    a, b, c, d = box
    return f"{a} <= ahead <= {b} and {c * scale} < light and light < {d * scale}"


@settings(
    max_examples=15, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(st.lists(BOXES, min_size=1, max_size=2), st.lists(BOXES, min_size=1, max_size=2))
def test_it_is_refuted_exactly_where_a_point_of_one_box_lies_in_none_of_the_other(
    tmp_path: Path,
    mine: list[tuple[float, float, float, float]],
    other: list[tuple[float, float, float, float]],
) -> None:
    """By counting points, in place of the solver: both act where one flees and the other goes."""
    path = two_arbiters(tmp_path, learned(*map(text_of, mine)), learned(*map(text_of, other)))
    grid = [0.0, 0.1, 0.3, 0.4, 0.5, 0.7, 1.0, 1.5, 2.0]
    both = any(
        inside(mine, ahead, light) and not inside(other, ahead, light)
        for ahead in grid
        for light in grid
    )

    assert bool(refused(path)) == both


def inside(boxes: list[tuple[float, float, float, float]], ahead: float, light: float) -> bool:
    return any(a <= ahead <= b and c < light < d for a, b, c, d in boxes)
