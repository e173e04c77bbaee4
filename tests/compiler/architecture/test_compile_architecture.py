"""Architectures from their files: what is named, wired, resolved and ordered."""

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TypeAlias

import pytest

from compiler.architecture.compile import CompiledArchitecture, compile_architecture
from compiler.check import check
from runtime.architecture import Outside, Way
from runtime.architecture_artifact import from_bytes, to_bytes
from runtime.container import ArtifactError
from runtime.progress import in_silence
from spec_schema.diagnostics import SpecError

PARTS = Path(__file__).parents[2] / "golden" / "bad" / "parts"
Make: TypeAlias = Callable[..., Path]

AVOID = "sense: {clearance: {from: ahead.range, outside: clip}}"
SEEK = "sense: {bearing: beacon.bearing, distance: {from: beacon.distance, outside: clip}}"

THREE = "choices: [x, y, z]\nby: {rules: [{choose: x, when: 1 > 2}, {choose: y}, {choose: z}]}\n"


@pytest.fixture(scope="module")
def light() -> CompiledArchitecture:
    return compile_architecture(PARTS / "find_light.yaml", in_silence)


@pytest.fixture
def make(tmp_path: Path) -> Make:
    """A file with nodes and channels for the courier."""

    def write(nodes: dict[str, str], channels: str = "{}") -> Path:
        lines = "".join(f"  {name}: {{{text}}}\n" for name, text in nodes.items())
        path = tmp_path / "tried.yaml"
        path.write_text(
            f"specc: 1\nkind: architecture\nname: tried\nbody: {PARTS}/courier.yaml\n"
            f"nodes:\n{lines}channels: {channels}\n",
            encoding="utf-8",
        )
        return path

    return write


def node(file: str, more: str, period: str = "50 ms") -> str:
    key = "arbiter" if file in {"safe_first", "layers"} else "behavior"
    return f"{key}: {PARTS}/{file}.yaml, period: {period}, {more}"


def codes(path: Path) -> set[str]:
    return {found.code for found in check(path)}


def test_the_board_holds_sensors_first_and_then_what_nodes_tell(
    light: CompiledArchitecture,
) -> None:
    names = [signal.name for signal in light.architecture.board]

    assert names[:2] == ["ahead.range", "lamp.light"]
    assert names[-5:] == ["seek.turn", "seek.aligned", "choose.flee", "choose.go", "choose.choice"]
    for one in light.architecture.nodes:
        own = [names[place].partition(".")[0] for place in one.outputs]
        assert set(own) == {one.name}


def test_every_input_of_a_node_has_a_signal_or_a_value(light: CompiledArchitecture) -> None:
    for one in light.architecture.nodes:
        if one.behavior >= 0:
            program = light.architecture.programs[one.behavior]
            wanted = {s.name for s in program.states if s.role.value != "driven"}
            assert {wire.entry for wire in one.inputs} == wanted | {
                c.name for c in program.controls
            }
    seek = light.architecture.nodes[1]
    by_name = {wire.entry: wire for wire in seek.inputs}
    assert by_name["speed"].value == pytest.approx(0.2)
    assert by_name["gain"].value == pytest.approx(1.5)
    assert by_name["distance"].outside is Outside.CLIP
    assert light.architecture.board[by_name["distance"].signal].name == "beacon.distance"


def test_an_outputs_domain_is_that_of_its_expression(light: CompiledArchitecture) -> None:
    turn = next(s for s in light.architecture.board if s.name == "seek.turn")

    assert turn.low == pytest.approx(-3.0)
    assert turn.high == pytest.approx(3.0)


def test_choices_name_nodes_and_settings_in_si(light: CompiledArchitecture) -> None:
    flee, go = light.architecture.nodes[2].choices

    assert flee.acts == (0,)
    assert go.acts == (1,)
    assert [(one.node, one.entry, one.value) for one in go.sets] == [(1, "gain", 2.0)]
    assert [one.level for one in light.architecture.nodes] == [0, 0, 1]


def test_exclusion_by_one_arbiter_is_proved(light: CompiledArchitecture) -> None:
    for channel in light.architecture.channels:
        assert channel.resolution.way is Way.EXCLUSIVE
        assert channel.resolution.proof


def test_a_behavior_that_two_nodes_run_is_compiled_once(make: Make) -> None:
    path = make(
        {"one": node("avoid", AVOID), "two": node("avoid", f"{AVOID}, set: {{near: 30 cm}}")},
        "{base.speed: {priority: [one, two]}, base.turn: {priority: [two, one]}}",
    )

    found = compile_architecture(path, in_silence).architecture

    assert len(found.programs) == 1
    assert [one.behavior for one in found.nodes] == [0, 0]
    assert [channel.resolution.nodes for channel in found.channels] == [(0, 1), (1, 0)]


def test_nodes_that_take_no_time_stand_before_those_that_they_tell(make: Make) -> None:
    path = make(
        {
            "avoid": node("avoid", f"{AVOID}, set: {{near: {{from: mood.near, outside: clip}}}}"),
            "mood": 'module: "m:f", period: 50 ms, sense: {a: calm.peace}, tells: {near: m}',
            "calm": 'module: "m:g", period: 50 ms, sense: {a: lamp.light}, tells: {peace: "1"}',
        }
    )

    found = compile_architecture(path, in_silence).architecture

    assert found.order == (2, 1, 0)
    assert [one.level for one in found.nodes] == [0, 1, 0]


def test_a_combined_behavior_needs_no_further_resolution(make: Make) -> None:
    nodes = {
        "avoid": node("avoid", AVOID),
        "seek": node("seek", SEEK),
        "both": node("seek", f"{SEEK}, replaces: [avoid, seek]"),
    }

    found = compile_architecture(make(nodes), in_silence).architecture
    del nodes["both"]

    assert found.channels[0].resolution.nodes == (2, 0, 1)
    assert found.nodes[2].replaces == (0, 1)
    assert "S342" in codes(make(nodes))


def test_of_combined_behaviors_the_one_that_holds_the_other_keeps_it_from_acting(
    make: Make,
) -> None:
    nodes = {name: node("seek", SEEK) for name in ("a", "b", "c")}
    nodes["two"] = node("seek", f"{SEEK}, replaces: [a, b]")
    nodes["three"] = node("seek", f"{SEEK}, replaces: [a, b, c]")

    exclusive = "{exclusive: [three, two, a, b, c]}"
    channels = f"{{base.speed: {exclusive}, base.turn: {exclusive}}}"
    assert codes(make(nodes, channels)) == set()
    nodes["three"] = node("seek", f"{SEEK}, replaces: [b, c]")
    assert "S349" in codes(make(nodes, channels))


def test_two_on_one_channel_conflict_whatever_their_variables_are_called(make: Make) -> None:
    """Thesis, section 3.2.2: `heading` of one and `turn` of another both turn the wheels."""
    path = make({"avoid": node("avoid", AVOID), "veer": node("veer", "sense: {heading: 0}")})

    assert "S342" in codes(path)


@pytest.mark.parametrize(
    ("wire", "wrong"),
    [
        ("ahead.range", {"S333"}),
        ("{from: ahead.range, outside: clip}", set()),
        ("{from: ahead.range, outside: inhibit}", set()),
        ("{from: ahead.range, scale: 0.5}", {"S333"}),
        ("{from: lamp.light, outside: clip}", {"S332"}),
        ("{from: bumper.hit, outside: clip}", {"S332"}),
        ("1 m", set()),
        ("100 cm", set()),
        ("2 m", {"S333"}),
        ("1 s", {"S125"}),
        ("ahead", {"S330"}),
        ("ahead.rnage", {"S330"}),
    ],
)
def test_a_wire_is_checked_from_end_to_end(make: Make, wire: str, wrong: set[str]) -> None:
    assert codes(make({"avoid": node("avoid", f"sense: {{clearance: {wire}}}")})) == wrong


def test_an_angle_wraps_where_it_is_wired_to_an_angle(make: Make) -> None:
    assert not codes(make({"veer": node("veer", "sense: {heading: odom.heading}")}))
    assert not codes(
        make({"veer": node("veer", "sense: {heading: {from: beacon.bearing, scale: -1}}")})
    )


def test_a_node_is_late_by_the_rate_of_its_field(make: Make) -> None:
    """avoid: rate 1/s, so period + response_time may be 0.5 s."""
    good = node("avoid", f"{AVOID}, response_time: 0.25 s", "0.25 s")
    late = node("avoid", f"{AVOID}, response_time: 0.26 s", "0.25 s")

    assert not codes(make({"avoid": good}))
    assert codes(make({"avoid": late})) == {"S353"}


def remedies(path: Path, code: str) -> list[str]:
    with pytest.raises(SpecError) as caught:
        compile_architecture(path, in_silence)
    return [found.help for found in caught.value.diagnostics if found.code == code]


@pytest.mark.parametrize(
    ("written", "remedy"),
    [
        ("priority", "write {priority: [avoid, seek]} with your nodes"),
        ("blend", "write {blend: choose} with your arbiter"),
        ("sum [avoid, seek]", "write {sum: [avoid, seek]}"),
        ("pick", "write {exclusive: pick}"),
    ],
)  # fmt: skip
def test_a_way_without_braces_is_answered_by_one_that_can_be_written(
    make: Make, written: str, remedy: str
) -> None:
    path = make({"avoid": node("avoid", AVOID)}, f"{{base.turn: '{written}'}}")

    assert remedies(path, "S103") == [remedy]


def test_exclusive_alone_is_answered_by_nodes_and_by_an_arbiter(make: Make) -> None:
    [remedy] = remedies(make({"avoid": node("avoid", AVOID)}, "{base.turn: exclusive}"), "S103")

    assert "{exclusive: [seek, avoid]}" in remedy
    assert "{exclusive: choose}" in remedy


def test_a_time_that_is_proposed_shares_a_long_step_with_others(make: Make) -> None:
    """0.29 s are left of the 0.5 s of avoid: 290 ms and 210 ms share 10 ms, 250 ms do better."""
    late = node("avoid", f"{AVOID}, response_time: 0.21 s", "0.4 s")

    [remedy] = remedies(make({"avoid": late}), "S353")
    assert remedy.startswith("write 'period: 250 ms' or less")


@pytest.mark.parametrize(
    "times", [{"period": "100"}, {"more": "response_time: 5"}, {"period": "20", "more": ""}]
)
def test_a_long_time_without_a_unit_was_meant_in_milliseconds(
    make: Make, times: dict[str, str]
) -> None:
    more = f", {times['more']}" if times.get("more") else ""
    bare = node("avoid", AVOID + more, times.get("period", "50 ms"))
    meant = times.get("period", "5")

    assert codes(make({"avoid": bare})) == {"S212"}
    assert remedies(make({"avoid": bare}), "S212") == [
        f"write '{meant} ms', or '{meant} s' if that is meant"
    ]


def test_a_time_with_its_unit_or_below_five_is_what_it_says(make: Make) -> None:
    for period in ("100 s", "4.9"):
        assert codes(make({"avoid": node("avoid", AVOID, period)})) == {"S353"}


PLAN = """
specc: 1
kind: behavior
name: settling
state:
  ahead:
    {unit: m, domain: [0, 2], role: both, relates: {agent: front, environment: a wall}}
  doing:
    {kind: discrete, values: [x, y], role: both, relates: {agent: base, environment: a wall}}
control: {k: {unit: 1/s, domain: [1, 900], default: 10}}
constants: {goal: {value: 0.5, unit: m}}
field:
  modes:
    of: doing
    each:
      x: {formula: {ahead: -k * (ahead - goal)}, leave: [{when: ahead <= goal, to: y}]}
      y: {formula: {ahead: -k * (ahead - goal)}}
"""


def test_a_plan_is_late_by_the_rate_of_its_field_as_any_behavior_is(
    make: Make, tmp_path: Path
) -> None:
    """Its rate is 10/s, as no one sets k: so period + response_time may be 50 ms."""
    (tmp_path / "settling.yaml").write_text(PLAN, encoding="utf-8")
    (tmp_path / "planned.yaml").write_text(
        "specc: 1\nkind: arbiter\nname: planned\nreads: {ahead: {unit: m, domain: [0, 2]}}\n"
        "choices: [x, y]\nby: {plan: settling.yaml}\n",
        encoding="utf-8",
    )
    veer = node("veer", "sense: {heading: odom.heading}")
    rest = "sense: {ahead: ahead.range}, choices: {x: [veer], y: []}"

    for period, found in (("50 ms", set()), ("51 ms", {"S353"})):
        plan = f"arbiter: planned.yaml, period: {period}, {rest}"
        assert codes(make({"veer": veer, "plan": plan})) == found


def test_all_mistakes_are_told_at_once_each_in_its_file(make: Make) -> None:
    path = make(
        {
            "avoid": node("avoids", AVOID),
            "seek": node("seek", "sense: {bearing: beacon.baring, distance: 9 m}"),
        },
        "{base.trun: {sum: [seek]}}",
    )

    with pytest.raises(SpecError) as caught:
        compile_architecture(path, in_silence)

    assert [found.code for found in caught.value.diagnostics] == ["S320", "S330", "S333", "S340"]


def test_a_mistake_is_told_without_what_only_follows_from_it(make: Make) -> None:
    no_period = node("avoid", AVOID, "0 s")
    no_file = node("nobody", AVOID)

    assert codes(make({"avoid": no_period})) == {"S212"}
    only_one_left = {"avoid": no_file, "seek": node("seek", SEEK)}
    assert codes(make(only_one_left, "{base.turn: {sum: [avoid, seek]}}")) == {"S320"}


def test_one_arbiter_of_three_is_told_in_one_sentence(make: Make, tmp_path: Path) -> None:
    chosen = f"specc: 1\nkind: arbiter\nname: one\nreads: {{}}\n{THREE}"
    (tmp_path / "one.yaml").write_text(chosen, encoding="utf-8")
    three = {name: node("seek", SEEK) for name in "abc"}
    choose = "arbiter: one.yaml, period: 50 ms, choices: {x: [a], y: [b], z: [c]}"

    made = compile_architecture(
        make(
            {**three, "choose": choose},
            "{base.turn: {exclusive: choose}, base.speed: {exclusive: choose}}",
        ),
        in_silence,
    )

    proofs = {channel.resolution.proof for channel in made.architecture.channels}
    assert proofs == {"choose holds one choice at a time, and none lets two of a, b and c act"}


def test_checking_runs_no_user_code_and_says_what_it_does_not_know_of_it(
    make: Make, tmp_path: Path
) -> None:
    (tmp_path / "bad.py").write_text("raise SystemExit\n", encoding="utf-8")
    (tmp_path / "made.yaml").write_text(
        "specc: 1\nkind: behavior\nname: made\nstate: {x: {unit: m, domain: [0, 1], role: both, "
        'relates: {agent: a, environment: b}}}\nfield: {module: {call: "bad:f"}}\n',
        encoding="utf-8",
    )

    found = check(make({"made": "behavior: made.yaml, period: 50 ms, sense: {x: 0.5}"}))

    assert [one.code for one in found] == ["S354", "S337"]


def test_checking_fills_in_arrows_and_so_finds_a_node_that_answers_too_late(make: Make) -> None:
    node = (
        f"behavior: {PARTS / 'drawn.yaml'}, period: {{}}, sense: {{clearance: "
        "{from: ahead.range, outside: clip}}"
    )

    late = check(make({"keep_off": node.replace("{}", "1 s", 1)}))
    in_time = check(make({"keep_off": node.replace("{}", "50 ms", 1)}))

    assert [one.code for one in late] == ["S353"]
    assert not any(one.code in ("S353", "S354") for one in in_time)


def test_the_artifact_reads_back_and_depends_on_nothing_else(light: CompiledArchitecture) -> None:
    again = compile_architecture(PARTS / "find_light.yaml", in_silence)
    data = to_bytes(light.architecture, light.body)

    assert to_bytes(again.architecture, again.body) == data
    architecture, body = from_bytes(data)
    assert body.sensors == light.body.sensors
    assert architecture.nodes == light.architecture.nodes
    assert architecture.channels == light.architecture.channels
    assert [p.name for p in architecture.programs] == ["avoid", "seek"]


def test_an_artifact_that_was_altered_is_refused(light: CompiledArchitecture) -> None:
    data = to_bytes(light.architecture, light.body)

    for place in range(0, len(data), len(data) // 97):
        altered = bytearray(data)
        altered[place] ^= 1
        with pytest.raises(ArtifactError):
            from_bytes(bytes(altered))
    with pytest.raises(ArtifactError):
        from_bytes(data[:-1])


def test_an_architecture_that_points_to_nothing_is_refused(light: CompiledArchitecture) -> None:
    first, *others = light.architecture.nodes
    wild = replace(first, behavior=7)
    broken = replace(light.architecture, nodes=(wild, *others))

    with pytest.raises(ArtifactError, match="points to what there is not"):
        to_bytes(broken, light.body)


def test_numbers_of_a_body_are_in_si(light: CompiledArchitecture) -> None:
    ahead, *_ = light.body.sensors

    assert light.body.shape.discs[0].radius == pytest.approx(0.12)
    assert ahead.width == pytest.approx(math.radians(60))
    assert ahead.readings[0].noise == pytest.approx(0.01)
    assert light.body.drive.track == pytest.approx(0.2)
