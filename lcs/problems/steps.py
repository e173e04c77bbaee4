"""Problems of several steps: an action leads to another place, and the goal may be far."""

from dataclasses import dataclass
from typing import Final, Protocol, final

import numpy as np

from lcs.arrays import Array
from lcs.inputs import Input
from lcs.problems.kernels import plane
from lcs.problems.kernels.plane import Square

MOVES: Final = ("move right", "move up", "move left", "move down")
STEP: Final = 0.05
"""How far an action moves, in both worlds here."""
GOAL: Final = 1.9
"""An episode ends where x + y is above it."""
NOISE: Final = 0.01
"""Of the puddle world, in both coordinates (Sutton 1996)."""
PUDDLES: Final = (((0.10, 0.75), (0.45, 0.75)), ((0.45, 0.40), (0.45, 0.80)))
"""The ends of the puddles' middle lines (Sutton 1996)."""
RADIUS: Final = 0.1
DEPTH_COST: Final = 400.0


class World(Protocol):
    """Where an agent acts step by step; all chance comes from who calls."""

    @property
    def actions(self) -> int:
        """How many actions there are."""
        ...

    @property
    def inputs(self) -> int:
        """How many numbers a place has."""
        ...

    def reset(self, chance: np.random.Generator) -> Array:
        """Where an episode begins (n,)."""
        ...

    def step(self, x: Array, action: int, chance: np.random.Generator) -> tuple[Array, float, bool]:
        """Where an action leads (n,), its reward, and whether the episode ends there."""
        ...


@final
@dataclass(frozen=True, eq=False, slots=True)
class Plane:
    """The unit square with four moves, of which kernels know the `square`."""

    name: str
    square: Square

    @property
    def actions(self) -> int:
        """Right, up, left and down, as in `MOVES`."""
        return len(self.square.moves)

    @property
    def inputs(self) -> int:
        """The coordinates x and y."""
        return 2

    @property
    def described(self) -> tuple[Input, ...]:
        """What the coordinates are called, and their range."""
        return tuple(Input(name, low=0.0, high=1.0) for name in ("x", "y"))

    @property
    def labels(self) -> tuple[str, ...]:
        """What each action is called."""
        return MOVES

    def reset(self, chance: np.random.Generator) -> Array:
        """A place that is no goal, uniform (2,)."""
        x = np.zeros(2)
        plane.start_once(self.square, chance, x)
        return x

    def step(self, x: Array, action: int, chance: np.random.Generator) -> tuple[Array, float, bool]:
        """Where an action leads (2,), its reward, and whether the episode ends there."""
        after = np.zeros(2)
        reward, ends = plane.step_once(self.square, x, action, chance, after)
        return after, reward, ends


def gridworld(noise: float = 0.0) -> Plane:
    """The continuous gridworld "Grid(0.05)" of Lanzi et al. (2005): -0.5 a step, 0 at the goal.

    The borders stop whoever would leave. Starts are uniform outside the goal's corner x + y > 1.9.
    """
    return Plane("gridworld", _square(noise, -0.5, 0.0, ()))


def puddle_world(noise: float = NOISE) -> Plane:
    """The puddle world (Boyan and Moore 1995, in Sutton's form of 1996).

    -1 a step, also of the last, and -400 for each unit of depth in a puddle at the place that is
    reached; where puddles overlap the deeper counts.
    """
    return Plane("puddles", _square(noise, -1.0, -1.0, PUDDLES))


def _square(
    noise: float, each: float, at_goal: float, puddles: tuple[tuple[tuple[float, float], ...], ...]
) -> Square:
    return Square(
        moves=STEP * np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]]),
        noise=noise,
        goal=GOAL,
        each=each,
        at_goal=at_goal,
        puddles=np.array(puddles).reshape(-1, 2, 2),
        radius=RADIUS,
        depth_cost=DEPTH_COST,
    )
