"""How fast bodies are at most; compiled."""

from runtime.arrays import Array
from runtime.world.kernels.cache import kernel


@kernel
def largest(speeds: Array) -> tuple[float, float, float]:
    """The largest amount of each column (x, y, turn) of speeds (n, 3), each alone."""
    x = y = turn = 0.0
    for row in range(len(speeds)):
        x = max(x, abs(speeds[row, 0]))
        y = max(y, abs(speeds[row, 1]))
        turn = max(turn, abs(speeds[row, 2]))
    return x, y, turn
