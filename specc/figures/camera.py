"""A box seen from outside: parallel projection of three axes onto the paper.

Places in the box are shares (..., 3), 0 to 1 along each axis. After A. Hertzmann and D. Zorin,
lines that pass in front of others interrupt them: the eye reads depth from the gaps.
"""

import math
from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array

AZIMUTH: Final = math.radians(-58.0)
ELEVATION: Final = math.radians(20.0)


@final
@dataclass(frozen=True, slots=True)
class Camera:
    """Where the box is looked at from, in radians."""

    azimuth: float = AZIMUTH
    elevation: float = ELEVATION

    @property
    def axes(self) -> Array:
        """The directions right, up and towards the eye, as rows (3, 3)."""
        ca, sa = math.cos(self.azimuth), math.sin(self.azimuth)
        ce, se = math.cos(self.elevation), math.sin(self.elevation)
        return np.array([[-sa, ca, 0.0], [-se * ca, -se * sa, ce], [ce * ca, ce * sa, se]])

    def projected(self, shares: Array) -> Array:
        """Places on the paper (..., 2) and how near they are, as a third column."""
        return np.asarray((shares - 0.5) @ self.axes.T)

    @property
    def size(self) -> Array:
        """Width and height (2,) of the projected box."""
        return np.asarray(np.ptp(self.projected(CORNERS), axis=0)[:2])


CORNERS: Final = np.stack(np.meshgrid(*[[0.0, 1.0]] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
