"""Principle 1a: lengths, masses and speeds in the world are those of the real one, to scale."""

from functools import cache

import numpy as np
import pytest

from tests.principles.scenes import GO, PROBE, Started, halt, hashes, robot, scenario, way

IN_METRES = (
    "arena: {box: [4 m, 3 m]}\n"
    "things: {crate: {shape: {box: [0.3 m, 0.2 m]}, at: [2.5 m, 1.55 m, 90 deg], mass: 1 kg}}\n"
    "lights: {bulb: {at: [2 m, 2 m], power: 10 cd, height: 0.6 m}}"
)
IN_OTHERS = (
    "arena: {box: [400 cm, 3000 mm]}\n"
    "things: {crate: {shape: {box: [30 cm, 200 mm]}, at: [250 cm, 155 cm, 90 deg], mass: 1000 g}}\n"
    "lights: {bulb: {at: [200 cm, 2000 mm], power: 10 cd, height: 60 cm}}"
)
IN_MILLIMETRES = {
    "12 cm": "120 mm",
    "20 cm": "200 mm",
    "9 cm": "90 mm",
    "3 kg": "3000 g",
    "0.5 m/s": "50 cm/s",
    "10 ms": "0.01 s",
}


def test_a_world_told_in_centimetres_and_grams_is_the_same_world_bit_for_bit() -> None:
    """1a: the numbers mean lengths, whatever unit they were written in."""
    other = PROBE
    for one, same in IN_MILLIMETRES.items():
        other = other.replace(one, same)

    metres = scenario(robot("[1.5 m, 1.5 m]", go=GO), world=IN_METRES)
    others = scenario(
        robot("[150 cm, 1500 mm]", body=other, go=GO.replace("50 ms", "0.05 s")),
        world=IN_OTHERS,
        duration="2000 ms",
        step="0.005 s",
    )

    assert hashes(Started(metres)) == hashes(Started(others))


@cache
def error_of_way() -> float:
    """Metres by which a robot at 0.4 m/s misses two metres in five seconds, once it is at speed."""
    x = way(scenario(robot("[0.5 m, 1.5 m]", go=GO), duration="6 s"))[:, 0, 0]
    return abs(float(x[1200] - x[200]) - 2.0)


def test_a_metre_that_is_driven_is_a_metre_that_is_sensed_and_a_metre_of_the_arena() -> None:
    """1a: ways, what sensors say of them, and the sizes of things are to one scale."""
    assert error_of_way() < 1e-9

    started = Started(scenario(robot("[0.5 m, 1.5 m]", go=GO), duration="3 s"))
    after = started.finish()[0, 0]

    assert started.world.sample(0, 0)[0] == pytest.approx(4.0 - after - 0.12, abs=1e-9)


def test_light_falls_off_with_the_square_of_metres() -> None:
    """1a: 10 cd are 10 lx at 1 m below; E = I cos / r^2 at the meter, 9 cm above the floor."""
    started = Started(
        scenario(
            robot("[0.5 m, 1.5 m]", halt=halt()),
            world="arena: {box: [4 m, 3 m]}\n"
            "lights: {b: {at: [2 m, 1.5 m], power: 10 cd, height: 1.09 m}}",
        )
    )
    lux = float(started.world.sample(0, 3)[0])

    assert lux == pytest.approx(10.0 * 1.0 / np.hypot(1.0, 1.5) ** 3, rel=1e-9)


@pytest.mark.parametrize(("wider", "passes"), [(1.0, True), (-1.0, False)])
def test_a_gap_lets_a_robot_through_that_is_a_millimetre_narrower_and_no_other(
    wider: float,
    passes: bool,  # noqa: FBT001  # a row of the table above
) -> None:
    """1a: whether it fits is decided by the sizes that were written down."""
    half = 0.5 * (240.0 + wider)
    walls = "".join(
        f"  {name}: {{shape: {{box: [10 cm, 1 m]}}, fixed: true, "
        f"at: [2 m, {1500.0 + side * (half + 500.0)} mm]}}\n"
        for name, side in (("left", 1), ("right", -1))
    )
    made = scenario(
        robot("[1.5 m, 1.5 m]", go=GO),
        world=f"arena: {{box: [4 m, 3 m]}}\nthings:\n{walls}",
        duration="3 s",
    )

    end = float(Started(made).finish()[2, 0])

    assert (end > 2.3) is passes
    if not passes:
        assert end < 2.0
