"""How fast bodies are at most; compiled."""

from runtime.arrays import Array
from runtime.world.kernels.cache import kernel


@kernel
def largest(states: Array) -> tuple[float, float, float]:
    """The largest amounts of the last three columns (x, y, turn) of states (n, 6), each alone."""
    x = y = turn = 0.0
    for row in range(len(states)):
        x = max(x, abs(states[row, 3]))
        y = max(y, abs(states[row, 4]))
        turn = max(turn, abs(states[row, 5]))
    return x, y, turn
