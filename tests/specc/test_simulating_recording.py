"""The recording of a scenario, opened by readers that know nothing of how it was written."""

import dataclasses
import io
import json
import math
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from google.protobuf import descriptor_pb2, descriptor_pool, message_factory
from mcap.reader import make_reader

from runtime import architecture_artifact
from runtime.arrays import Array
from runtime.recording.scenario_run import recorded_run
from runtime.run import Run, run
from specc.cli import main
from specc.verifying.standard import carried_by
from tests.runtime.first_light import first_light, short_run
from tests.verifier.architectures.gathering import Gathered
from verifier.architectures.log import open_run
from verifier.architectures.recorded import records_of, topics_of_nodes


@pytest.fixture(scope="module")
def recording() -> bytes:
    """Three seconds of the first light."""
    return recorded_run(short_run())


@pytest.fixture(scope="module")
def file(recording: bytes, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The same as a file."""
    path = tmp_path_factory.mktemp("recordings") / "run.mcap"
    path.write_bytes(recording)
    return path


def drawn(recording: bytes, topic: str) -> Iterator[tuple[float, Any]]:
    """Messages decoded by the schema that the file carries, and by nothing else."""
    for schema, _, message in make_reader(io.BytesIO(recording)).iter_messages(topics=[topic]):
        assert schema is not None
        pool = descriptor_pool.DescriptorPool()
        for one in descriptor_pb2.FileDescriptorSet.FromString(schema.data).file:
            pool.Add(one)
        kind = message_factory.GetMessageClass(pool.FindMessageTypeByName(schema.name))
        yield message.log_time / 1e9, kind.FromString(message.data)


def said(recording: bytes, topic: str) -> list[tuple[float, dict[str, Any]]]:
    """JSON messages."""
    found = make_reader(io.BytesIO(recording)).iter_messages(topics=[topic])
    return [(message.log_time / 1e9, json.loads(message.data)) for _, _, message in found]


def test_every_topic_has_what_the_run_has(recording: bytes) -> None:
    made = short_run()
    counts: Counter[str] = Counter()
    for _, channel, _ in make_reader(io.BytesIO(recording)).iter_messages():
        counts[channel.topic] += 1

    robot, track = made.scenario.robots[0], made.robots[0]
    for node, ticks in zip(robot.architecture.nodes, track.nodes, strict=True):
        for what in ("reads", "choice") if node.arbiter >= 0 else ("state", "control", "output"):
            assert counts[f"/r/{node.name}/{what}"] == ticks.times.size
    for sensor, readings in zip(robot.body.sensors, track.sensors, strict=True):
        assert counts[f"/r/{sensor.name}/readings"] == readings.times.size
    assert counts["/tf"] == counts["/world/poses"] == made.world.times.size
    assert counts["/world/light"] == counts["/world/light_image"] == 4
    assert counts["/world/scene"] == 1


def test_frames_are_where_the_things_are(recording: bytes) -> None:
    made = short_run()
    place = made.world.names.index("r")
    seen = list(drawn(recording, "/tf"))

    for (time, message), expected, (x, y, heading) in zip(
        seen, made.world.times, made.world.poses[:, place], strict=True
    ):
        robot = next(t for t in message.transforms if t.child_frame_id == "r")
        assert time == pytest.approx(expected)
        assert robot.timestamp.seconds + robot.timestamp.nanos / 1e9 == pytest.approx(expected)
        assert (robot.translation.x, robot.translation.y) == (x, y)
        turned = 2.0 * math.atan2(robot.rotation.z, robot.rotation.w)
        assert math.remainder(turned - heading, math.tau) == pytest.approx(0.0, abs=1e-12)


def test_the_scene_has_all_things_in_frames_that_move_where_they_may(recording: bytes) -> None:
    made = short_run()
    [(_, scene)] = drawn(recording, "/world/scene")
    frames = {entity.id: entity.frame_id for entity in scene.entities}

    for thing in made.layout.things:
        assert frames[thing.name] == ("world" if thing.is_fixed else thing.name)
    assert frames["r"] == "r"
    assert frames["walls"] == "world"
    assert "light bulb" in frames
    crate = next(entity for entity in scene.entities if entity.id == "crate")
    points = np.array([(p.x, p.y, p.z) for p in crate.triangles[0].points])
    assert np.allclose(points.max(axis=0), [0.15, 0.1, 0.18])
    assert np.allclose(points.min(axis=0), [-0.15, -0.1, 0.0])
    assert len(points) % 3 == 0
    # A closed body: its volume by the divergence theorem, with all faces turned outwards.
    a, b, c = points.reshape(-1, 3, 3).transpose(1, 0, 2)
    volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6.0
    assert volume == pytest.approx(0.3 * 0.2 * 0.18)


def test_the_grid_holds_the_light_in_lux(recording: bytes) -> None:
    floor = short_run().floor
    assert floor is not None
    _, grid = next(drawn(recording, "/world/light"))
    lux = np.frombuffer(grid.data, dtype="<f4").reshape(-1, grid.column_count)

    assert np.allclose(lux, floor.lux[0], rtol=1e-6)
    assert grid.pose.position.x == pytest.approx(0.0, abs=1e-9)
    assert lux.shape[1] * grid.cell_size.x == pytest.approx(4.0)


def test_an_echo_is_as_far_as_the_sensor_says(recording: bytes) -> None:
    ranges = dict(said(recording, "/r/ahead/readings"))
    for time, scan in drawn(recording, "/r/ahead/scan"):
        assert set(scan.ranges) == {ranges[time]["range"]}
    for time, cloud in drawn(recording, "/r/ahead/points"):
        points = np.frombuffer(cloud.data, dtype="<f4").reshape(-1, 3)
        assert np.allclose(np.hypot(*points[:, :2].T), ranges[time]["range"], rtol=1e-6)


def test_what_was_said_is_in_the_units_of_the_specs_and_with_the_names_of_choices(
    recording: bytes,
) -> None:
    made = short_run()
    choices = said(recording, "/r/choose/choice")
    index = made.signals["r.choose.choice"]

    # A recording has what was said; a quantity what of it took effect, and that first nothing did.
    in_effect = [index.labels[int(value)] for value in index.values[1:]]
    assert index.values[0] == -1.0
    assert [row["choice"] for _, row in choices][: len(in_effect)] == in_effect
    turns = [row["turn"] for _, row in said(recording, "/r/seek/output")]
    turned = made.signals["r.seek.turn"].values[1:].tolist()
    assert turns[: len(turned)] == turned
    assert len(turns) - len(turned) <= 2


def test_the_attachments_are_the_scenario_and_the_architecture(recording: bytes) -> None:
    robot = short_run().scenario.robots[0]
    attached = {
        each.name: each.data for each in make_reader(io.BytesIO(recording)).iter_attachments()
    }

    document = json.loads(attached["first_light.scenario.json"])
    assert document["seed"] == 3
    assert [one["text"] for one in document["requirements"]] == [
        one.text for one in short_run().scenario.requirements
    ]
    assert attached["r.specc"] == architecture_artifact.to_bytes(robot.architecture, robot.body)


def test_records_read_from_the_file_are_those_gathered_in_the_run(file: Path) -> None:
    scenario = first_light()
    gathered = Gathered(scenario.robots[0].architecture, 0, scenario.step)
    run(scenario, observer=gathered)

    carried = carried_by(file)
    assert carried is not None
    robots = {robot.name: robot.architecture for robot in carried.robots}
    log = open_run(file, topics_of_nodes(robots), scenario.step)
    read = records_of(log, robots)["r"]

    for one, other in zip(read, gathered.records(), strict=True):
        assert np.array_equal(one.times, other.times)
        assert one.columns.keys() == other.columns.keys()
        for name, column in one.columns.items():
            assert np.allclose(column, other.columns[name], rtol=1e-12), name
        assert np.array_equal(one.free, other.free)
        if other.chosen is None:
            assert one.chosen is None
        else:
            assert np.array_equal(one.chosen, other.chosen)


def test_verify_judges_each_node_by_its_own_spec(
    file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["verify", str(file), "--quick", "--format", "json"]) in {0, 1, 4}
    found = json.loads(capsys.readouterr().out)

    specs = [each["spec"]["name"] for each in found["runs"]]
    assert specs == ["first_light", "back_off", "seek_light", "safe_first"]


def test_a_recording_that_lies_about_its_choices_fails(recording: bytes, tmp_path: Path) -> None:
    # Another file, in which the arbiter chose otherwise than its rules say.
    made = short_run()
    place = next(
        i for i, n in enumerate(made.scenario.robots[0].architecture.nodes) if n.name == "choose"
    )
    outputs = made.robots[0].nodes[place].outputs.copy()
    outputs[:, -1] = 1.0 - outputs[:, -1]
    lying = _with_outputs(made, place, outputs)
    path = tmp_path / "lies.mcap"
    path.write_bytes(recorded_run(lying))

    assert recorded_run(lying) != recording
    assert main(["verify", str(path), "--quick"]) == 1


def _with_outputs(made: Run, place: int, outputs: Array) -> Run:
    robot = made.robots[0]
    nodes = list(robot.nodes)
    nodes[place] = dataclasses.replace(nodes[place], outputs=outputs)
    return dataclasses.replace(made, robots=(dataclasses.replace(robot, nodes=tuple(nodes)),))
