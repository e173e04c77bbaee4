"""A rate that is commanded with the wrong sign: told where a sight falls as the body moves."""

from pathlib import Path

import pytest

from compiler.check import check

PARTS = Path(__file__).parents[2] / "golden" / "bad" / "parts"
BODY = """\
specc: 1
kind: body
name: mule
shape: {circle: 12 cm}
mass: 3 kg
drive: {DRIVE: {MORE speed: 0.5 m/s, turn: 3 rad/s}}
sensors:
  cam: {senses: sight, of: [light], reach: 6 m, at: [0, 0, ANGLE]}
  odom: {senses: odometry}
"""
WHEELS, ANYWHERE = ("differential", "track: 20 cm,"), ("holonomic", "")


def said(
    folder: Path,
    realizes: str,
    sense: str,
    angle: str = "0 deg",
    drive: tuple[str, str] = WHEELS,
) -> list[str]:
    """What is said of signs, of a behavior that faces a light and comes near it."""
    text = (PARTS / "wrong_way.yaml").read_text(encoding="utf-8").partition("realizes:")[0]
    (folder / "way.yaml").write_text(f"{text}realizes: {{{realizes}}}\n", encoding="utf-8")
    body = BODY.replace("DRIVE", drive[0]).replace("MORE", drive[1]).replace("ANGLE", angle)
    (folder / "mule.yaml").write_text(body, encoding="utf-8")
    path = folder / "tried.yaml"
    path.write_text(
        "specc: 1\nkind: architecture\nname: tried\nbody: mule.yaml\nnodes:\n"
        f"  seek: {{behavior: way.yaml, period: 50 ms, sense: {{{sense}}}}}\n",
        encoding="utf-8",
    )
    found = check(path)
    assert {one.code for one in found} <= {"S364"}
    return [f"{one.message}; {one.help}" for one in found]


SIGHT = "aim: cam.bearing, gap: cam.distance"
MIRRORED = "aim: {from: cam.bearing, scale: -1}, gap: cam.distance"


@pytest.mark.parametrize(
    ("realizes", "sense", "wrong"),
    [
        ("aim: base.turn as rate", SIGHT, True),
        ("aim: -base.turn as rate", SIGHT, False),
        ("aim: base.turn as rate", MIRRORED, False),
        ("aim: -base.turn as rate", MIRRORED, True),
        ("aim: base.turn as rate", "aim: odom.heading, gap: cam.distance", False),
        ("gap: base.speed as rate", SIGHT, True),
        ("gap: -base.speed as rate", SIGHT, False),
        ("gap: base.speed as rate", "aim: cam.bearing, gap: 1 m", False),
    ],
)
def test_the_sign_of_the_command_and_of_the_wire_count_together(
    tmp_path: Path,
    realizes: str,
    sense: str,
    wrong: bool,  # noqa: FBT001
) -> None:
    assert len(said(tmp_path, realizes, sense)) == wrong


def test_who_turns_a_mirrored_bearing_is_told_the_other_sign(tmp_path: Path) -> None:
    (text,) = said(tmp_path, "aim: -base.turn as rate", MIRRORED)

    assert "'aim' is -1 * cam.bearing" in text
    assert "write 'aim: base.turn as rate'" in text


@pytest.mark.parametrize(("angle", "wrong"), [("80 deg", True), ("-100 deg", False)])
def test_what_a_sensor_that_looks_back_sees_is_left_behind(
    tmp_path: Path,
    angle: str,
    wrong: bool,  # noqa: FBT001
) -> None:
    assert len(said(tmp_path, "gap: base.speed as rate", SIGHT, angle)) == wrong


@pytest.mark.parametrize(("channel", "wrong"), [("base.forward", True), ("base.left", False)])
def test_a_body_that_drives_to_all_sides_comes_near_by_driving_ahead(
    tmp_path: Path,
    channel: str,
    wrong: bool,  # noqa: FBT001
) -> None:
    found = said(tmp_path, f"gap: {channel} as rate", SIGHT, drive=ANYWHERE)

    assert len(found) == wrong
