"""A module of one's own that takes as long as the environment says, at random, in real time."""

import math
import os
import random
import time
from collections.abc import Mapping

PONDERS = "SPECC_PONDERS"
"""The environment variable: seconds that it takes at most; nothing else follows from it."""


def mood(reads: Mapping[str, float], _time: float) -> Mapping[str, float]:
    """Turn one way or the other, by the light and by what is ahead."""
    most = float(os.environ.get(PONDERS, "0"))
    if most:
        until = time.perf_counter() + random.uniform(0.0, most)  # noqa: S311  real time only
        while time.perf_counter() < until:
            pass
    return {"spin": 1.2 * math.sin(reads["light"] + 3.0 * reads["range"])}
