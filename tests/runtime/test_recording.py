"""Recordings, read back by the MCAP library's own reader."""

import io
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from mcap.reader import make_reader

from runtime.artifact import from_bytes, to_bytes
from runtime.code import Code
from runtime.program import Binding, Kind, Program, Role, Unit
from runtime.recording.behavior import record, recorded, self_bound
from runtime.rollout import Rollout
from runtime.simulate import simulate
from tests.runtime.behaviors import NOWHERE, state, tabulated_van_der_pol, van_der_pol


def program() -> Program:
    """Van der Pol in centimetres with a discrete state, and outputs with an awkward one."""
    plain = van_der_pol()
    x = replace(plain.states[0], unit=Unit("cm", 0.01), about="where it is")
    mode = replace(
        state("mode", 0.0, 1.0),
        role=Role.SENSED,
        kind=Kind.DISCRETE,
        values=("off", "on"),
        hold=1.0,
    )
    pole = replace(plain.outputs[0], name="pole", code=Code("1 x 2 sub div"))
    button = Binding("button", "/joy.b", x.unit, 0.0, 1.0, 0.0, None, (), NOWHERE)
    return replace(
        plain,
        name="swing",
        states=(x, plain.states[1], mode),
        outputs=(*plain.outputs, pole),
        bindings=(button,),
        judge_when=Code("button x 0 gt and"),
    )


@pytest.fixture(scope="module")
def run() -> Rollout:
    return simulate(program(), {"x": 2.0}, 2.0, every=0.25)


@pytest.fixture(scope="module")
def data(run: Rollout) -> bytes:
    return recorded(run, program())


def messages(data: bytes) -> dict[str, list[tuple[int, dict[str, object]]]]:
    found: dict[str, list[tuple[int, dict[str, object]]]] = {}
    for schema, channel, message in make_reader(io.BytesIO(data)).iter_messages():
        assert schema is not None
        assert (schema.encoding, channel.message_encoding) == ("jsonschema", "json")
        properties = json.loads(schema.data)["properties"]
        values = json.loads(message.data)
        assert list(values) == list(properties)
        assert message.log_time == message.publish_time
        found.setdefault(channel.topic, []).append((message.log_time, values))
    return found


def test_every_sample_is_there_in_the_units_of_the_spec(run: Rollout, data: bytes) -> None:
    topics = messages(data)
    assert set(topics) == {"/swing/state", "/swing/control", "/swing/output"}
    for samples in topics.values():
        assert [time for time, _ in samples] == [250_000_000 * i for i in range(9)]
    states = [values for _, values in topics["/swing/state"]]
    assert [values["x"] for values in states] == (run.states[:, 0] / 0.01).tolist()
    assert [values["v"] for values in states] == run.states[:, 1].tolist()
    assert {values["mode"] for values in states} == {"on"}
    assert {values["mu"] for _, values in topics["/swing/control"]} == {1.0}
    outputs = [values for _, values in topics["/swing/output"]]
    assert [values["energy"] for values in outputs] == run.outputs[:, 0].tolist()
    assert outputs[0]["pole"] is None, "JSON has no infinity"


def test_schemas_say_the_unit_and_the_values(data: bytes) -> None:
    summary = make_reader(io.BytesIO(data)).get_summary()
    assert summary is not None
    schema = next(s for s in summary.schemas.values() if s.name == "swing/state")
    properties = json.loads(schema.data)["properties"]

    assert properties["x"] == {"type": "number", "description": "where it is; unit: cm"}
    assert properties["mode"] == {"type": "string", "enum": ["off", "on"], "description": ""}


def test_the_attached_spec_binds_its_variables_to_the_recording(data: bytes) -> None:
    attachment = next(make_reader(io.BytesIO(data)).iter_attachments())
    assert (attachment.name, attachment.media_type) == ("swing.specc", "application/vnd.specc")

    found = from_bytes(attachment.data)

    assert attachment.data == to_bytes(self_bound(program()))
    topics = messages(data)
    for binding in found.bindings:
        topic, field = binding.path.split(".")
        assert field in topics[topic][0][1]
    assert [b.name for b in found.bindings] == ["x", "v", "mode", "mu"]
    assert found.bindings[0].unit == Unit("cm", 0.01)
    assert found.bindings[2].values == (("off", 0), ("on", 1))
    assert found.judge_when is None, "the recording has no button"
    kept = replace(program(), judge_when=Code("x 0 gt"))
    assert self_bound(kept).judge_when == Code("x 0 gt")


def test_the_metadata_name_the_behavior_the_spec_and_the_ending(data: bytes) -> None:
    metadata = next(make_reader(io.BytesIO(data)).iter_metadata())

    assert metadata.name == "specc"
    assert metadata.metadata == {
        "behavior": "swing",
        "spec_sha256": "0" * 64,
        "ending": "completed",
        "ended_at": "2.0",
    }


def test_the_same_run_gives_the_same_bytes(run: Rollout, data: bytes, tmp_path: Path) -> None:
    record(tmp_path / "swing.mcap", run, program())

    assert recorded(run, program()) == data
    assert (tmp_path / "swing.mcap").read_bytes() == data


def test_a_run_that_ended_early_is_recorded_up_to_its_end() -> None:
    behavior = tabulated_van_der_pol()
    run = simulate(behavior, {"x": 0.0, "v": 3.9}, 2.0, every=0.01)
    assert run.ended_at < 2.0
    states = messages(recorded(run, behavior))["/behavior/state"]

    assert len(states) == np.isfinite(run.states[:, 0]).sum()
    assert states[-1][0] <= float(run.ended_at) * 1e9


def test_a_batch_or_the_run_of_another_program_is_refused(run: Rollout) -> None:
    batch = simulate(program(), {"x": np.array([1.0, 2.0])}, 1.0)

    with pytest.raises(ValueError, match="one run of 'swing' \\(got 2 of 'swing'\\)"):
        recorded(batch, program())
    with pytest.raises(ValueError, match="one run of 'behavior'"):
        recorded(run, van_der_pol())
