"""How far a deviating robot truly departs from its spec, by integration without any noise."""

from collections.abc import Callable

import numpy as np

from tests.study.robots import CLOCK, Array, Robot, advanced, drive

SECONDS = 60.0
RUNS = 24


def departures(robot: Robot, deviation: float) -> list[Array]:
    """Measured minus predicted at the horizon over its tolerance, per mode (windows, variables)."""
    drives = drive(robot, RUNS, SECONDS, deviation, 0.0, seed=99)
    ahead, stride = round(robot.horizon / CLOCK), round(robot.horizon / CLOCK) // 2
    begins = np.arange(0, len(drives.times) - ahead, stride)
    start = drives.states[:, begins].reshape(-1, len(robot.states))
    end = drives.states[:, begins + ahead].reshape(start.shape)
    state = start
    for step in range(ahead):
        inputs = drives.inputs[:, begins + step].reshape(len(start), -1)
        state = advanced(robot, state, inputs, 0.0)
    columns = [robot.states.index(name) for name in robot.judged]
    errors = (end - state)[:, columns] / np.array(list(robot.judged.values()))
    if not robot.mode:
        return [errors]
    mode = robot.states.index(robot.mode)
    stays = start[:, mode] == end[:, mode]
    return [errors[stays & (start[:, mode] == value)] for value in np.unique(start[:, mode])]


def size(robot: Robot, deviation: float) -> float:
    """The largest root mean square of a variable in a mode, in tolerances."""
    return max(
        float(np.sqrt(np.mean(errors**2, axis=0)).max()) for errors in departures(robot, deviation)
    )


def largest(robot: Robot, deviation: float) -> float:
    """The largest departure anywhere, in tolerances."""
    return max(float(np.abs(errors).max()) for errors in departures(robot, deviation))


def deviation_of(
    robot: Robot, wanted: float, measure: Callable[[Robot, float], float] = size
) -> float:
    """The deviation whose departure, so measured, is `wanted` tolerances (secant method)."""
    if wanted == 0.0:
        return 0.0
    before, now = 0.0, 1e-3
    reached = 0.0
    for _ in range(12):
        found = measure(robot, now)
        slope = (found - reached) / (now - before)
        before, reached, now = now, found, now + (wanted - found) / slope
        if abs(found - wanted) < 1e-3 * wanted:
            break
    return now
