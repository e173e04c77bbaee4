"""Where bodies are and how fast, read where the physics keeps it; compiled."""

from runtime.arrays import Array, Integers
from runtime.world.kernels.cache import kernel
from runtime.world.kernels.memory import HEADING, PLACE, TURN, VELOCITY, reals


@kernel
def states(bodies: Integers, found: Array) -> None:
    """Fill `found` (n, 6) of the bodies at these addresses (n,).

    x, y of the origin, heading; velocity of the centre of mass x, y; turn rate.
    """
    for row in range(len(bodies)):
        numbers = reals(bodies[row])
        found[row, 0] = numbers[PLACE]
        found[row, 1] = numbers[PLACE + 1]
        found[row, 2] = numbers[HEADING]
        found[row, 3] = numbers[VELOCITY]
        found[row, 4] = numbers[VELOCITY + 1]
        found[row, 5] = numbers[TURN]


@kernel
def largest_speeds(bodies: Integers) -> tuple[float, float, float]:
    """The largest amount of velocity x, velocity y, and turn rate, each alone."""
    x = y = turn = 0.0
    for body in bodies:
        numbers = reals(body)
        x = max(x, abs(numbers[VELOCITY]))
        y = max(y, abs(numbers[VELOCITY + 1]))
        turn = max(turn, abs(numbers[TURN]))
    return x, y, turn
