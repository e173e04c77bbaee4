"""How channels are resolved, in a recording: found anew from who acts and what each node wants."""

import dataclasses
import io
import itertools
import json
import math
from functools import cache
from pathlib import Path

import pytest
from mcap.reader import make_reader

from compiler.world.scenario import compile_scenario
from runtime.architecture import Channel, Way
from runtime.recording.resolutions import shares_of
from runtime.recording.scenario_run import recorded_run
from runtime.run import Run, run

SCENARIOS = Path(__file__).parents[2] / "specs" / "scenarios"
NAMES = ["light_subsumption", "light_dynamics", "first_light"]
"""A priority, a blend, and an exclusive channel."""


@cache
def run_of(name: str) -> Run:
    scenario = compile_scenario(SCENARIOS / f"{name}.yaml", lambda _w, _d, _o: None).scenario
    return run(dataclasses.replace(scenario, duration=8.0))


@cache
def messages_of(name: str) -> dict[str, list[tuple[float, dict[str, object]]]]:
    """All messages in JSON, by topic: seconds, and what was said."""
    found: dict[str, list[tuple[float, dict[str, object]]]] = {}
    for _, channel, message in make_reader(io.BytesIO(recorded_run(run_of(name)))).iter_messages():
        if channel.message_encoding == "json":
            told = (message.log_time * 1e-9, json.loads(message.data))
            found.setdefault(channel.topic, []).append(told)
    return found


def acting_at(name: str, node: str, time: float) -> float:
    """How strongly a node acts, by its own topic; 0 where it does not."""
    said = [what for at, what in messages_of(name)[f"/r/{node}/acting"] if at <= time + 1e-9]
    return float(str(said[-1]["weight"])) if said and said[-1]["acts"] else 0.0


def wanted_at(name: str, node: int, channel: int, time: float) -> float:
    """What a node wants of a channel: its last command that is in effect."""
    made = run_of(name)
    told = made.scenario.robots[0].architecture.nodes[node]
    ticks = made.robots[0].nodes[node]
    column = [command.channel for command in told.commands].index(channel)
    before = ticks.times + told.response_time <= time + 1e-9
    return float(ticks.commands[before][-1, column])


def expected_at(name: str, place: int, time: float) -> tuple[dict[str, float], float]:
    """The weights and the set-point that the way of a channel gives, worked out here."""
    architecture = run_of(name).scenario.robots[0].architecture
    channel: Channel = architecture.channels[place]
    acting = {
        i: acting_at(name, architecture.nodes[i].name, time) for i in channel.resolution.nodes
    }
    active = {i: weight for i, weight in acting.items() if weight > 0.0}
    if channel.resolution.way is not Way.BLEND:
        active = dict.fromkeys([*active][:1], 1.0)
    total = sum(active.values())
    weights = {architecture.nodes[i].name: weight / total for i, weight in active.items()}
    wants = sum(w / total * wanted_at(name, i, place, time) for i, w in active.items())
    return weights, min(max(wants, channel.low), channel.high)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("place", [0, 1])
def test_who_has_its_way_and_the_set_point_follow_from_acts_and_wants(
    name: str, place: int
) -> None:
    channel = run_of(name).scenario.robots[0].architecture.channels[place]
    told = messages_of(name)[f"/r/{channel.name.replace('.', '/')}/resolved"]
    assert len({what["who"] for _, what in told}) > 1
    for time, what in told:
        weights, value = expected_at(name, place, time)
        said = {key[7:]: each for key, each in what.items() if key.startswith("weight_")}
        assert {node: each for node, each in said.items() if each} == pytest.approx(weights)
        assert what["set_point"] == pytest.approx(value, abs=1e-12)
        assert what["who"] == (", ".join(sorted(weights, key=[*said].index)) or "nobody")
        assert what["way"] == (str(channel.resolution.way) if weights else "rest")
        assert (what["is_limited"], what["is_in_conflict"]) == (False, False)


@pytest.mark.parametrize("name", NAMES)
def test_a_message_is_told_where_something_changes_and_nowhere_else(name: str) -> None:
    for topic, told in messages_of(name).items():
        if topic.endswith("/resolved"):
            assert told[0][0] == 0.0
            assert all(one != other for (_, one), (_, other) in itertools.pairwise(told))
    sets = messages_of(name)["/r/base/channels"]
    for channel in ("base.speed", "base.turn"):
        told = messages_of(name)[f"/r/{channel.replace('.', '/')}/resolved"]
        for time, values in sets:
            last = [what for at, what in told if at <= time + 1e-9][-1]
            assert last["set_point"] == values[channel], "it holds until the next message"


def test_shares_add_up_and_are_the_means_of_weights_over_time() -> None:
    made = run_of("light_dynamics")
    architecture = made.scenario.robots[0].architecture
    found = shares_of(architecture, 0, made.robots[0].resolutions[0], made.duration)

    told = messages_of("light_dynamics")["/r/base/speed/resolved"]
    ends = [*(time for time, _ in told[1:]), made.duration]
    by_hand = {
        node: math.fsum(
            float(str(what[f"weight_{node}"])) * (end - time)
            for (time, what), end in zip(told, ends, strict=True)
        )
        / made.duration
        for node in ("avoid", "seek", "wander")
    }
    assert sum(found.values()) == pytest.approx(1.0)
    assert {node: found[node] for node in by_hand} == pytest.approx(by_hand)
    assert 0.0 < found["nobody"] < 0.05, "before the first decision"
