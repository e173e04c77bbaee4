"""The field of specs/circling.yaml: the normal form of a Hopf bifurcation, scaled to a radius."""

import numpy as np

TURN = 0.6  # rad/s around the landmark
PULL = 0.8  # 1/s towards the circle


def circling(x: np.ndarray, y: np.ndarray, radius: np.ndarray) -> dict[str, np.ndarray]:
    """Rates in m/s at positions in m; every argument is an array (N,)."""
    pull = PULL * (1.0 - (x**2 + y**2) / radius**2)
    return {"x": pull * x - TURN * y, "y": TURN * x + pull * y}
