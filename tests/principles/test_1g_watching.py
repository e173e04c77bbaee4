"""Principle 1g: behaviors can be watched as they could be in the real world."""

import math
from functools import cache

import numpy as np
from matplotlib.patches import PathPatch

from runtime.arrays import Array
from runtime.recording.scenario_run import recorded_run
from runtime.run import Run, run
from specc.figures.world import draw_world
from specc.scenarios.pictured import pictured
from tests.principles.scenes import GO, PROBE, SPIN, robot, scenario
from tests.specc.test_simulating_recording import drawn

LENGTH = 0.24


@cache
def made() -> Run:
    """A round robot goes round and pushes a crate, for three seconds."""
    return run(
        scenario(
            robot("[1 m, 1 m]", go=GO, spin=SPIN, body=PROBE),
            world="arena: {box: [4 m, 3 m]}\n"
            "things: {crate: {shape: {box: [0.3, 0.2]}, at: [1.8, 1.2], mass: 0.5 kg}}",
            duration="3 s",
        )
    )


@cache
def watched() -> tuple[Array, Array]:
    """What somebody sees who has the recording alone: times (n,), and x, y, heading (n, 3)."""
    times, rows = [], []
    for time, message in drawn(recorded_run(made()), "/tf"):
        frame = next(one for one in message.transforms if one.child_frame_id == "r0")
        heading = 2.0 * math.atan2(frame.rotation.z, frame.rotation.w)
        times.append(time)
        rows.append((frame.translation.x, frame.translation.y, heading))
    return np.array(times), np.array(rows)


@cache
def misseen() -> tuple[float, float]:
    """m/s and rad/s by which speed and turn, as told from the pictures, miss what was driven."""
    times, rows = watched()
    speed = np.hypot(*np.diff(rows[:, :2], axis=0).T) / np.diff(times)
    turn = np.remainder(np.diff(rows[:, 2]) + np.pi, 2 * np.pi) - np.pi
    driven = made().signals["r0.speed"].values, made().signals["r0.turn"].values
    steady = slice(15, 45)  # at speed, and before the crate
    middle = [0.5 * (v[1:] + v[:-1])[steady] for v in driven]
    return (
        float(np.abs(speed[steady] - middle[0]).max()),
        float(np.abs((turn / np.diff(times))[steady] - middle[1]).max()),
    )


def test_who_watches_the_recording_alone_sees_what_the_robot_does() -> None:
    """1g: its speed and turn can be measured on the pictures, as on a film of a real one."""
    speed, turn = misseen()

    assert speed < 1e-3
    assert turn < 1e-2


@cache
def between_pictures() -> float:
    """The most that the robot moves from picture to picture, in percent of its length."""
    _, rows = watched()
    return 100.0 * float(np.hypot(*np.diff(rows[:, :2], axis=0).T).max()) / LENGTH


def test_nothing_happens_between_two_pictures() -> None:
    """1g: it is seen at least 50 times a second, as smoothly as a film shows anything."""
    times, _ = watched()

    assert np.diff(times).max() <= 0.02 + 1e-9
    assert between_pictures() < 5.0


def test_all_that_there_is_is_seen_in_its_true_shape() -> None:
    """1g: crate, robot and walls have the sizes in the picture that they have in the world."""
    [(_, scene)] = drawn(recorded_run(made()), "/world/scene")
    seen = {entity.id: entity for entity in scene.entities}

    assert seen["r0"].cylinders[0].size.x == LENGTH
    crate = np.array([(p.x, p.y) for p in seen["crate"].triangles[0].points])
    assert np.allclose(np.ptp(crate, axis=0), (0.3, 0.2))
    assert len(seen["walls"].cubes) == 4


def test_a_poster_shows_the_robot_where_it_was_first_and_last() -> None:
    """1g: outlines stand where the bodies stood, and a metre up is a metre aside."""
    figure = draw_world(*pictured(made(), ()))
    axes = figure.axes[0]
    outlines = [p.get_path().get_extents() for p in axes.patches if isinstance(p, PathPatch)]
    middles = {(round((b.x0 + b.x1) / 2, 2), round((b.y0 + b.y1) / 2, 2)) for b in outlines}
    poses = made().world.poses[:, -1]

    assert axes.get_aspect() == 1.0
    for x, y, _ in poses[[0, -1]]:
        assert any(abs(x - u) < 0.011 and abs(y - v) < 0.011 for u, v in middles)
