"""Every node of an architecture judged by its own spec, while others act."""

from dataclasses import replace
from pathlib import Path
from typing import TypeAlias

import numpy as np
import pytest

from compiler.architecture.arbiters import compile_arbiter
from runtime.arbiter import Arbiter
from runtime.architecture import Architecture, Outside, Way
from runtime.program import Program
from runtime.scheduler.scheduler import Scheduler
from specc.loading import load_program
from specc.verifying.architecture import How, NodeVerdict, examine_nodes
from tests.runtime.scheduler.plane import STEP, N, Plain, Plane, architecture, resolution, scenario
from tests.verifier.architectures.gathering import Gathered
from verifier.architectures.nodes import (
    NodeRecord,
    examine_behavior,
    examine_decisions,
    held_back,
)
from verifier.architectures.way import has_its_way
from verifier.report.arbitration import ThresholdStanding
from verifier.report.report import Verdict

BEHAVIOR = """
specc: 1
kind: behavior
name: {name}
state:
  x: {{unit: "1", domain: [-5, 5], role: both, relates: {{agent: point, environment: origin}}}}
field: {{formula: {{x: {rate}}}}}
fidelity: {{tolerance: {{x: 0.05}}, horizon: 0.5 s}}
"""
ARBITER = """
specc: 1
kind: arbiter
name: choose
reads: {{x: {{unit: "1", domain: [-5, 5]}}}}
choices: [home, away]
by:
  rules:
    - {{choose: home, when: x > {far}, until: x < 0.3}}
    - {{choose: away}}
agreement: {{share: 0.95}}
"""


def behavior(folder: Path, name: str, rate: str) -> Program:
    """A behavior on a line."""
    path = folder / f"{name}.yaml"
    path.write_text(BEHAVIOR.format(name=name, rate=rate))
    return load_program(path)


def arbiter(folder: Path, far: float) -> Arbiter:
    """Home from `far` on, and away again near home."""
    path = folder / f"choose_{far}.yaml"
    path.write_text(ARBITER.format(far=far))
    return compile_arbiter(path).arbiter


Recorded: TypeAlias = tuple[Architecture, tuple[NodeRecord, ...]]


class Weak(Plane):
    """A point whose drive reaches only seven tenths of what it is told."""

    def command(self, robot: int, channels: np.ndarray, driven: np.ndarray) -> None:
        super().command(robot, 0.7 * channels, driven)


def wired(folder: Path) -> Architecture:
    """Home and away in turns."""
    nodes = [
        N("home", behavior(folder, "home", "-0.8 * x"), 0.05, STEP, {"x": "pos.x"}, RATE),
        N("away", behavior(folder, "away", "0.5"), 0.05, STEP, {"x": "pos.x"}, RATE),
        N(
            "choose",
            arbiter(folder, 2.0),
            0.1,
            STEP,
            {"x": "pos.x"},
            choices={"home": ["home"], "away": ["away"]},
            level=1,
        ),
    ]
    return architecture(nodes, ways={"x": resolution(Way.EXCLUSIVE, 0, 1, arbiter=2)})


RATE = {"x": ("x", "rate")}


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Recorded:
    """Two minutes of a robot that does as it is told."""
    return run(tmp_path_factory.mktemp("recorded"), Plane())


def run(folder: Path, plane: Plane) -> Recorded:
    """Two minutes."""
    whole = wired(folder)
    gathered = Gathered(whole, 0, STEP)
    Scheduler(scenario(whole), plane, Plain(plane), observer=gathered).run(12_000)
    return whole, gathered.records()


def test_behaviors_are_judged_only_where_they_have_their_way(recorded: Recorded) -> None:
    whole, (home, away, _) = recorded

    for record, program in zip((home, away), whole.programs, strict=True):
        assert 0.1 < record.free.mean() < 0.9
        made = examine_behavior(program, record, "run", depth="verdict")
        assert made.examination.report.verdict is Verdict.PASS
        everywhere = replace(record, held_back={})
        blamed = examine_behavior(program, everywhere, "run", depth="verdict")
        assert blamed.examination.report.verdict is Verdict.FAIL


def test_a_drive_that_is_too_weak_fails_the_behaviors_that_use_it(tmp_path: Path) -> None:
    whole, (home, away, _) = run(tmp_path, Weak())

    for record, program in zip((home, away), whole.programs, strict=True):
        made = examine_behavior(program, record, "run", depth="verdict")
        assert made.examination.report.verdict is Verdict.FAIL


def test_an_arbiter_is_judged_by_what_it_sampled_and_chose(
    tmp_path: Path, recorded: Recorded
) -> None:
    whole, (*_, choose) = recorded

    right = examine_decisions(whole.arbiters[0], choose, "run")
    assert right.arbitration is not None
    assert right.arbitration.share.value == 1.0

    other = examine_decisions(arbiter(tmp_path, 1.5), choose, "run")
    assert other.report.verdict is Verdict.FAIL
    assert other.arbitration is not None
    far = next(t for t in other.arbitration.thresholds if "> 1.5" in t.comparison)
    assert far.standing is ThresholdStanding.MOVED
    assert far.interval.low <= 2.0 <= far.interval.high


@pytest.mark.parametrize(
    ("way", "expected"),
    [
        (Way.PRIORITY, [True, False, True]),
        (Way.EXCLUSIVE, [True, False, True]),
        (Way.SUM, [False, False, True]),
        (Way.BLEND, [False, False, True]),
    ],
)
def test_who_is_suppressed_or_blended_has_not_its_way(
    tmp_path: Path, way: Way, expected: list[bool]
) -> None:
    whole = wired(tmp_path)
    channel = replace(whole.channels[0], resolution=resolution(way, 0, 1))
    whole = replace(whole, channels=(channel, *whole.channels[1:]))

    both = np.array([[True, True, True], [False, True, True], [False, False, False]])
    found = has_its_way(whole, both, both.astype(float))

    assert found[0].tolist() == expected
    assert found[1].tolist() == [False, True, True]
    assert not found[2].any()


def test_in_a_blend_who_has_nearly_all_of_the_weight_has_its_way(tmp_path: Path) -> None:
    whole = wired(tmp_path)
    channel = replace(whole.channels[0], resolution=resolution(Way.BLEND, 0, 1, arbiter=2))
    whole = replace(whole, channels=(channel, *whole.channels[1:]))

    acts = np.ones((3, 3), dtype=np.bool_)
    weights = np.array([[0.995, 0.005, 0.0], [0.9, 0.1, 0.0], [0.0, 1.0, 0.0]])
    found = has_its_way(whole, acts, weights)

    assert found[:, :2].tolist() == [[True, False], [False, False], [False, True]]


def test_every_node_is_judged_by_its_own_spec(recorded: Recorded) -> None:
    whole, records = recorded

    found = examine_nodes(whole, records, "run", How(None, depth="verdict"))

    assert [each.name for each in found if isinstance(each, NodeVerdict)] == [
        "home",
        "away",
        "choose",
    ]


def test_readings_at_an_edge_that_they_may_be_beyond_are_not_judged(recorded: Recorded) -> None:
    whole, _ = recorded
    node = whole.nodes[0]
    wide = tuple(replace(s, low=-9.0, high=9.0) for s in whole.board)
    clipping = replace(node, inputs=tuple(replace(i, outside=Outside.CLIP) for i in node.inputs))
    wired = replace(whole, board=wide, nodes=(clipping, *whole.nodes[1:]))
    columns = {"x": np.array([4.9, 5.0, -5.0, 0.0])}
    acts = np.ones(4, dtype=np.bool_)

    back = held_back(wired, 0, columns, acts, acts)

    assert back["x beyond its domain (clipped)"].tolist() == [False, True, True, False]
    narrow = tuple(replace(s, low=-5.0, high=5.0) for s in whole.board)
    unclipped = held_back(replace(wired, board=narrow), 0, columns, acts, acts)
    assert not unclipped["x beyond its domain (clipped)"].any()
