"""A run of a scenario: looking changes nothing, and everything has its name, unit and rate."""

import dataclasses
import hashlib
import itertools
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import pytest

from compiler.world.quantities_of_run import quantities_of
from compiler.world.scenario import compile_scenario
from runtime.recording.scenario_run import recorded_run
from runtime.run import LOOK, run
from runtime.scenario import Scenario
from runtime.start import started
from runtime.world.layout import NoRoomError
from tests.runtime.first_light import FILE, first_light, short_run
from tests.verifier.architectures.gathering import Gathered

SCRIPT = """
import hashlib
from tests.runtime.first_light import first_light
from runtime.recording.scenario_run import recorded_run
from runtime.run import run
made = run(first_light(2.0), light_every=1.0)
print(made.digest.hex(), hashlib.sha256(recorded_run(made)).hexdigest())
"""


def test_who_watches_and_what_is_recorded_changes_nothing() -> None:
    scenario = first_light()
    watched = Gathered(scenario.robots[0].architecture, 0, scenario.step)

    plain = run(scenario)
    seen = run(scenario, observer=watched, light_every=0.1)

    assert plain.digest == seen.digest == short_run().digest
    assert watched.records()[0].times.size


def test_another_seed_gives_another_run_and_the_same_one_the_same() -> None:
    one, other = run(first_light(1.0, seed=1)), run(first_light(1.0, seed=2))

    assert one.digest != other.digest
    assert one.digest == run(first_light(1.0, seed=1)).digest


def test_all_that_requirements_may_speak_of_is_there() -> None:
    made = short_run()
    known = quantities_of(made.scenario.world, made.scenario.robots)

    assert made.signals.keys() == known.keys()
    assert all(quantity.times.size for quantity in made.signals.values())
    for quantity in made.signals.values():
        assert (np.diff(quantity.times) > 0.0).all(), quantity.name
        assert quantity.times.shape == quantity.values.shape


def test_each_quantity_has_its_own_rate() -> None:
    made = short_run()
    scenario = made.scenario
    robot = scenario.robots[0]

    sensor = next(s for s in robot.body.sensors if s.name == "ahead")
    assert np.allclose(np.diff(made.signals["r.ahead.range"].times), sensor.every)
    assert np.allclose(np.diff(made.signals["r.clearance"].times), scenario.step)
    assert np.diff(made.signals["r.x"].times).max() <= LOOK + 1e-9
    assert made.signals["r.x"].times[-1] == pytest.approx(scenario.duration)


def test_what_a_node_tells_stands_at_the_time_at_which_it_takes_effect() -> None:
    made = short_run()
    nodes = made.scenario.robots[0].architecture.nodes
    place = next(i for i, node in enumerate(nodes) if node.name == "seek")
    node, ticks = nodes[place], made.robots[0].nodes[place]

    turn = made.signals["r.seek.turn"]

    later = ticks.times + node.response_time
    told = later < made.duration - 0.5 * made.scenario.step
    assert not told.all()
    assert np.array_equal(turn.times, [0.0, *later[told]])
    assert np.array_equal(turn.values, [0.0, *ticks.outputs[told, 0]])
    assert np.array_equal(made.signals["r.seek.bearing"].times, ticks.times)


@pytest.mark.parametrize("duration", [1.0, 1.0021])
@pytest.mark.parametrize("response", [0.05, 0.2, 5.0])
def test_nothing_is_told_after_the_end_and_all_is_known_from_the_beginning(
    duration: float, response: float
) -> None:
    scenario = slow_to_answer(duration, response)
    made = run(scenario)

    for quantity in made.signals.values():
        assert quantity.times[-1] <= made.duration, quantity.name
        assert quantity.times[0] == 0.0, quantity.name
    # What nodes could read at an instant is on their boards, which nobody asked for the quantities.
    board = scenario.robots[0].architecture.board
    begun = started(scenario)
    for _ in range(round(made.duration / scenario.step)):
        begun.scheduler.step()
    left = begun.scheduler.agents[0].board.values
    last = [made.signals[f"r.{signal.name}"].values[-1] for signal in board]
    assert np.array_equal(left, last)


def slow_to_answer(duration: float, response: float) -> Scenario:
    """First light, with nodes that all answer so many seconds late."""
    scenario = first_light(duration)
    robot = scenario.robots[0]
    nodes = [dataclasses.replace(n, response_time=response) for n in robot.architecture.nodes]
    architecture = dataclasses.replace(robot.architecture, nodes=tuple(nodes))
    robots = (dataclasses.replace(robot, architecture=architecture),)
    return dataclasses.replace(scenario, robots=robots)


def test_poses_end_where_speed_and_turn_lead() -> None:
    # An independent way: the recorded motion, integrated by the midpoint of each look.
    made = short_run()
    x, heading = made.signals["r.x"], made.world.poses[:, -1, 2]
    speed = made.signals["r.speed"].values

    ahead = 0.5 * (speed[1:] + speed[:-1])
    middle = 0.5 * (heading[1:] + heading[:-1])
    path = x.values[0] + np.cumsum(ahead * np.cos(middle) * np.diff(x.times))

    assert np.abs(path - x.values[1:]).max() < 2e-3


def test_progress_reaches_the_end() -> None:
    told: list[tuple[int, int]] = []

    run(first_light(1.0), progress=lambda done, of: told.append((done, of)))

    assert told[-1][0] == told[-1][1] > 0
    assert all(one[0] < other[0] for one, other in itertools.pairwise(told))


def test_a_world_without_room_says_so() -> None:
    scenario = first_light()
    crowded = dataclasses.replace(scenario.world.scattered[0], count=400)
    world = dataclasses.replace(scenario.world, scattered=(crowded,))

    with pytest.raises(NoRoomError, match="no room for 'clutter_"):
        run(dataclasses.replace(scenario, world=world))


def test_the_same_run_gives_the_same_bytes_in_a_fresh_process_and_under_load() -> None:
    """Here beside other work; tests/principles/test_load.py compares two fresh processes."""
    fresh = subprocess.Popen(
        [sys.executable, "-c", SCRIPT], stdout=subprocess.PIPE, text=True, cwd=FILE.parents[2]
    )
    stop = threading.Event()
    burner = threading.Thread(target=_burn, args=(stop,))
    burner.start()
    here = run(first_light(2.0), light_every=1.0)
    data = hashlib.sha256(recorded_run(here)).hexdigest()
    stop.set()
    burner.join()

    assert fresh.communicate()[0].split() == [here.digest.hex(), data]


def _burn(stop: threading.Event) -> None:
    while not stop.is_set():
        np.linalg.eigvals(np.ones((200, 200)))


def test_who_reads_a_choice_waits_for_the_first_decision(tmp_path: Path) -> None:
    parts = Path(__file__).parents[1] / "golden" / "bad" / "parts"
    (tmp_path / "waits.yaml").write_text(
        f"specc: 1\nkind: architecture\nname: waits\nbody: {parts}/courier.yaml\nnodes:\n"
        f"  choose: {{arbiter: {parts}/sure.yaml, period: 50 ms, response_time: 120 ms,\n"
        "    sense: {ahead: ahead.range}, choices: {forward: [], turn: []}}\n"
        f"  keep: {{behavior: {parts}/told.yaml, period: 50 ms, sense: {{\n"
        "    left: {from: bumper.hit, outside: clip},\n"
        "    action: {from: choose.choice, outside: inhibit}}}\n",
        encoding="utf-8",
    )
    (tmp_path / "first.yaml").write_text(
        f"specc: 1\nkind: scenario\nname: first\nworld: {parts}/yard.yaml\nduration: 0.5 s\n"
        "robots: {r: {architecture: waits.yaml, at: [1 m, 1 m, 0]}}\n",
        encoding="utf-8",
    )

    made = run(compile_scenario(tmp_path / "first.yaml", lambda *_: None).scenario)

    chosen, keeping = made.signals["r.choose.choice"], made.robots[0].nodes[1]
    assert (chosen.values[0], chosen.times[1]) == (-1.0, pytest.approx(0.12))
    assert keeping.times[keeping.acts].min() == pytest.approx(0.15)
