"""A field in Python."""

import numpy as np
import numpy.typing as npt


def rates(clearance: npt.NDArray[np.float64]) -> dict[str, npt.NDArray[np.float64]]:
    """Clearance (m) goes back to half a metre."""
    return {"clearance": 0.5 - clearance}
