"""Wiring pictures: every wire of an architecture is drawn from its source to all its targets."""

from functools import cache
from pathlib import Path

import pytest

from compiler.architecture.compile import compile_architecture
from specc.cli import main
from specc.figures.style import rendered
from specc.figures.style_names import Style
from specc.figures.wiring import draw_wiring
from specc.figures.wiring_layout import plan_of
from specc.figures.wiring_plan import Plan
from specc.texts.wiring import summary
from specc.wired import Sort, Wired, wired

ARCHITECTURES = Path(__file__).parents[2] / "specs" / "architectures"


@cache
def architecture(name: str) -> Wired:
    compiled = compile_architecture(ARCHITECTURES / f"{name}.yaml", lambda *_: None)
    return wired(compiled.architecture, compiled.body)


@pytest.fixture(params=["thesis_3_2", "thesis_3_3"])
def shown(request: pytest.FixtureRequest) -> Wired:
    return architecture(request.param)


def reached(plan: Plan, net: int) -> set[tuple[float, float]]:
    return {place for run in plan.runs if run.net == net for place in run.arrows}


def test_every_wire_reaches_all_its_targets(shown: Wired) -> None:
    plan = plan_of(shown)

    for index, net in enumerate(shown.nets):
        wanted = {
            place for (box, _, name), place in plan.ports.items() if (box, name) in net.targets
        }
        assert len(wanted) == len(net.targets)
        assert reached(plan, index) == wanted


def test_no_two_boxes_lie_on_each_other(shown: Wired) -> None:
    plan = plan_of(shown)
    frames = [*plan.boxes.values(), *plan.mouths.values(), *plan.eyes.values()]

    for i, a in enumerate(frames):
        for b in frames[i + 1 :]:
            beside = a.x + a.width <= b.x or b.x + b.width <= a.x
            above = a.y + a.height <= b.y or b.y + b.height <= a.y
            assert beside or above


def test_no_two_nets_share_a_piece_of_a_lane(shown: Wired) -> None:
    plan = plan_of(shown)

    for i, a in enumerate(plan.runs):
        for b in plan.runs[i + 1 :]:
            assert a.y != b.y or a.right < b.left or b.right < a.left


def test_every_text_stands_within_its_box() -> None:
    for name in ("alone/wander", "patrol_hierarchy"):
        shown = architecture(name)
        plan = plan_of(shown)
        figure = draw_wiring(shown)
        axes = figure.axes[0]
        frames = [*plan.boxes.values(), *plan.mouths.values(), *plan.eyes.values()]
        known = {port.name for box in shown.boxes for port in (*box.senses, *box.controls)}
        known |= {box.clock for box in shown.boxes} | {eye.name for eye in shown.eyes}
        inked = [text.get_window_extent() for text in axes.texts if text.get_text() in known]

        assert len(inked) > len(known) / 2
        for box in inked:
            (left, low), (right, high) = axes.transData.inverted().transform(box)
            assert any(
                frame.x <= left
                and right <= frame.x + frame.width
                and frame.y <= low
                and high <= frame.y + frame.height
                for frame in frames
            )


def test_no_two_texts_of_a_sensor_touch() -> None:
    figure = draw_wiring(architecture("alone/wander"))
    inked = {text.get_text(): text.get_window_extent() for text in figure.axes[0].texts}

    for name, said in (("odom", "odometry, unread"), ("gyro", "turn"), ("beacon", "sight, unread")):
        assert inked[name].x1 < inked[said].x0


def test_sensors_that_nobody_reads_are_told() -> None:
    shown = architecture("alone/wander")
    unread = ["ahead", "beacon", "lamp", "bumper", "odom"]

    assert [eye.name for eye in shown.eyes if not eye.readings] == unread
    assert f"sensors that no node reads: {', '.join(unread)}" in summary(shown)
    assert set(plan_of(shown).eyes) == {eye.name for eye in shown.eyes}


@pytest.mark.parametrize("name", ["alone/wander", "tidy_dynamics", "patrol_hierarchy"])
def test_no_reading_leaves_its_sensor_upon_the_lane_of_another(name: str) -> None:
    plan = plan_of(architecture(name))

    for _, y in plan.exits.values():
        assert all(abs(y - run.y) > 0.04 for run in plan.runs)


def test_higher_levels_stand_above_what_they_control() -> None:
    plan = plan_of(architecture("thesis_3_3"))

    assert plan.boxes["mission"].y > plan.boxes["reflex"].y > plan.boxes["avoid"].y
    assert plan.boxes["avoid"].y > plan.mouths["base.turn"].y


def test_three_parallel_behaviors_offer_their_controls_to_nobody() -> None:
    shown = architecture("thesis_3_2")

    assert [box.name for box in shown.boxes] == ["avoid", "seek", "follow"]
    assert {box.level for box in shown.boxes} == {0}
    assert not any(net.sort is Sort.CHOICE for net in shown.nets)
    assert [(p.name, p.note) for p in shown.boxes[1].controls] == [
        ("gain", "1.5 1/s"),
        ("speed", "0.2 m/s"),
    ]


def test_the_text_says_who_sets_what() -> None:
    text = summary(architecture("thesis_3_3"))

    assert "control near from mission.careful or mission.eager (0.4 m or 0.2 m)" in text
    assert "chooses home: seek.acts, seek.speed" in text
    assert "base.turn: priority (avoid, seek, follow); at rest: stop" in text


@pytest.mark.parametrize("style", list(Style))
def test_equal_architectures_give_equal_bytes(style: Style) -> None:
    shown = architecture("thesis_3_3")

    assert rendered(draw_wiring(shown, style), "svg") == rendered(draw_wiring(shown, style), "svg")


def test_the_command_writes_a_picture(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    picture = tmp_path / "wiring.svg"

    status = main(["wiring", str(ARCHITECTURES / "thesis_3_2.yaml"), "-o", str(picture)])

    assert status == 0
    assert picture.read_text(encoding="utf-8").startswith("<?xml")
    assert "base behaviors" in capsys.readouterr().out
