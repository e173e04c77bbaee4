"""The same run whatever the machine does meanwhile: hashes, processes, load (principles 2e-2g)."""

import gc
import subprocess
import sys
import time
import types
from collections.abc import Mapping
from dataclasses import replace

import pytest

from runtime.architecture import Way
from runtime.code import Code
from runtime.program import Noise
from runtime.scheduler.scheduler import Scheduler
from tests.runtime.arbitration.test_paradigms import competing
from tests.runtime.behaviors import NOWHERE, formula_program, state
from tests.runtime.scheduler.plane import (
    STEP,
    N,
    Plain,
    Plane,
    architecture,
    resolution,
    scenario,
)

INSTANTS = 300


def ponder(reads: Mapping[str, float], _time: float) -> Mapping[str, float]:
    """A module of the user's that says where the point is."""
    return {"x": reads["x"]}


def sleepy(reads: Mapping[str, float], time_: float) -> Mapping[str, float]:
    """The same, taking its time."""
    time.sleep(0.004)
    return ponder(reads, time_)


def busy(seed: int, module: str = "ponder", robots: int = 1) -> Scheduler:
    """Robots that roam or go home as a noisy competition says, through a module of their own."""
    home = formula_program((state("x", -99.0, 99.0),), {"x": "x neg"})
    roam = replace(home, noise=(Noise("x", Code("0.4"), NOWHERE),))
    callee = f"{__name__}:{module}"
    nodes = [
        N(
            "choose",
            competing(("0.5 x sub", "x 0.5 sub"), "2", 0.2),
            10 * STEP,
            3 * STEP,
            {"x": "mine.x"},
            choices={"a": ["roam"], "b": ["home"]},
            level=1,
        ),
        N("mine", callee, 5 * STEP, 2 * STEP, {"x": "pos.x"}, tells=("x",)),
        N("roam", roam, 4 * STEP, STEP, {"x": "pos.x"}, {"x": ("x", "rate")}),
        N("home", home, 7 * STEP, 9 * STEP, {"x": "mine.x"}, {"x": ("x", "rate")}),
    ]
    wired = architecture(nodes, ways={"x": resolution(Way.BLEND, 2, 3, arbiter=0)})
    plane = Plane([(0.3, 0.0)] * robots)
    sensors = Plain(plane, [(2, 3)], robots)
    whole = scenario(*[wired] * robots, seed=seed)
    return Scheduler(whole, plane, sensors, allow_code=True)


def hashes(scheduler: Scheduler, instants: int = INSTANTS) -> list[str]:
    """The state hash before the first step and after each."""
    found = [scheduler.state_hash().hex()]
    for _ in range(instants):
        scheduler.step()
        found.append(scheduler.state_hash().hex())
    return found


def test_the_same_seed_gives_the_same_hash_at_every_step_and_another_seed_another() -> None:
    first, again, other = hashes(busy(1)), hashes(busy(1)), hashes(busy(2))

    assert first == again
    assert len(set(first)) == INSTANTS + 1
    assert first[-1] != other[-1]


def test_a_module_that_takes_its_time_changes_nothing() -> None:
    begun = time.monotonic()
    slow = hashes(busy(1, "sleepy"))

    assert time.monotonic() - begun > 60 * 0.004
    assert slow == hashes(busy(1))


def test_looking_at_the_hash_changes_nothing() -> None:
    quiet = busy(1)
    quiet.run(INSTANTS)

    assert quiet.state_hash().hex() == hashes(busy(1))[-1]


def test_two_processes_come_to_the_same() -> None:
    code = f"from {__name__} import busy, hashes; print(*hashes(busy(1)))"

    told = [
        subprocess.run(  # our own line
            [sys.executable, "-c", code], capture_output=True, text=True, check=True
        ).stdout.split()
        for _ in range(2)
    ]

    assert told[0] == told[1] == hashes(busy(1))


def test_one_more_robot_changes_no_other() -> None:
    alone, beside = busy(1), busy(1, robots=3)
    alone.run(INSTANTS)
    beside.run(INSTANTS)

    first, same = (
        [array.tobytes() for array in scheduler.agents[0].state()] for scheduler in (alone, beside)
    )
    assert first == same
    assert beside.agents[1].board.values.tobytes() != beside.agents[0].board.values.tobytes()


def test_what_is_said_and_not_yet_in_effect_is_in_the_hash() -> None:
    late = [busy(1), busy(1)]
    for scheduler in late:
        scheduler.run(100)
    waiting = late[0]._pending  # what a hash must not leave out
    assert waiting
    for *_, said in waiting:
        said.outputs[...] += 1e-9
        said.commands[...] += 1e-9

    assert late[0].state_hash() != late[1].state_hash()


@pytest.mark.parametrize("seed", [1, 2])
def test_the_hash_is_of_the_state_and_not_of_the_way_there(seed: int) -> None:
    one, two = busy(seed), busy(seed)
    one.run(60)
    for _ in range(6):
        two.run(10)

    assert one.state_hash() == two.state_hash()


def reachable(root: object) -> list[object]:
    """Everything that can be got at from an object by following what it holds; no code."""
    code = (type, types.ModuleType, types.FunctionType, types.BuiltinFunctionType)
    seen: dict[int, object] = {}
    waiting = [root]
    while waiting:
        thing = waiting.pop()
        if id(thing) in seen or isinstance(thing, code):
            continue
        seen[id(thing)] = thing
        waiting += gc.get_referents(thing)
    return list(seen.values())


def test_from_a_node_no_part_of_the_world_can_be_reached() -> None:
    scheduler = busy(1)
    scheduler.run(20)
    worlds = ("runtime.world", Plane.__module__)

    for node in scheduler.agents[0].nodes:
        found = {type(thing).__module__ for thing in reachable(node)}
        assert not {module for module in found if module.startswith(worlds)}
    assert {type(thing).__module__ for thing in reachable(scheduler)} & {Plane.__module__}
