"""How large a run will be, told before it begins: it keeps everything until its end.

The sizes of single things were measured (64-bit CPython); a test compares the sum with what runs
take.
"""

import math
from typing import Final

from runtime.run import LOOK, cells_of, steps_between_frames
from runtime.scenario import Robot, Scenario

MOST: Final = 4e9
"""Bytes that a run may take while it goes on; a recording of it takes twice to thrice as much."""

OF_STEP: Final = 240.0
"""Bytes at each step, for each robot: how near it is, and what it touches."""
OF_LOOK: Final = 450.0
OF_POSE: Final = 48.0
OF_TICK: Final = 900.0
OF_READING: Final = 350.0
OF_COMMAND: Final = 500.0
OF_CHANNEL: Final = 300.0
OF_NUMBER: Final = 16.0
"""Bytes of a number: as it is gathered, and as it is kept."""
OF_CELL: Final = 8.0
"""Bytes of a cell of a picture of light, as it is gathered, and as it is kept: of half the size."""


def bytes_of(scenario: Scenario, light_every: float | None = None) -> float:
    """About how much memory a run takes while it goes on, the light on the floor included.

    light_every: seconds between two pictures of that light; None for none.
    """
    rate = sum(_of_robot(robot, scenario.step) for robot in scenario.robots)
    world = scenario.world
    movers = len(world.things) + sum(s.count for s in world.scattered) + len(scenario.robots)
    look = max(int(LOOK / scenario.step), 1) * scenario.step
    rate += (OF_LOOK + OF_POSE * movers) / look
    frames = 0.0
    if light_every is not None:
        columns, rows = cells_of(world.arena)
        every = steps_between_frames(scenario, light_every) * scenario.step
        frames = columns * rows * OF_CELL * (scenario.duration / every + 1.0)
    return rate * scenario.duration + frames


def gigabytes(size: float) -> str:
    """So many bytes to two digits, as one says it.

    >>> gigabytes(4e9), gigabytes(2.39e14)
    ('4 GB', '240,000 GB')
    """
    value = float(f"{size / 1e9:.2g}")
    return f"{value:,.0f} GB" if value >= 10.0 else f"{value:g} GB"


def longest(scenario: Scenario) -> float:
    """The longest duration (s) whose run takes no more than it may, to two digits."""
    at_most = scenario.duration * MOST / bytes_of(scenario)
    digit = 10.0 ** (math.floor(math.log10(at_most)) - 1)
    return math.floor(at_most / digit + 1e-9) * digit


def _of_robot(robot: Robot, step: float) -> float:
    """Bytes in a second of simulated time."""
    architecture = robot.architecture
    channels = len(architecture.channels)
    found = OF_STEP / step
    for node in architecture.nodes:
        numbers = len(node.inputs) + len(node.outputs) + len(node.commands)
        found += (OF_TICK + OF_NUMBER * numbers) / node.period
        if node.commands:
            found += (OF_COMMAND + OF_CHANNEL * channels) / node.period
    if any(c.mode == "acceleration" for node in architecture.nodes for c in node.commands):
        found += (OF_COMMAND + OF_CHANNEL * channels) / step
    for sensor in robot.body.sensors:
        found += (OF_READING + OF_NUMBER * len(sensor.readings)) / sensor.every
    return found
