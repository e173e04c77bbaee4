"""Light that reaches a place past all that stands in its way, compiled.

Sources are rows x, y, height, intensity (cd), a unit direction, the cosine of half the cone (-2:
all round), and the owner that carries the source (-1: none), which does not shade it. A place is
lit as a horizontal surface that looks up: I cos / r^2 (Lambert).
"""

import math

from runtime.arrays import Array
from runtime.kernels.cache import inlined
from runtime.world.kernels.cache import kernel
from runtime.world.kernels.parts import Parts, stands_between

ALL_ROUND = -2.0
"""The cosine of half the width of what has no edges."""


@inlined
def arrives(light: Array, dx: float, dy: float, dz: float) -> float:
    """Lux from one source at a place that is (dx, dy, -dz) away from it, with nothing between."""
    square = dx * dx + dy * dy
    if dz <= 0.0 or dx * light[4] + dy * light[5] < light[6] * math.sqrt(square):
        return 0.0
    square += dz * dz
    return float(light[3] * dz / (square * math.sqrt(square)))


@kernel
def illuminance(
    place: tuple[float, float, float],
    view: tuple[float, float, float, float],
    sources: Array,
    skip: int,
    parts: Parts,
) -> float:
    """Lux at a place (x, y, height), over all sources (l, 8).

    view: a unit direction and the cosine of half the angle from which light is accepted; light
    from right above is accepted always. skip: an owner that shades nothing.
    """
    total = 0.0
    for index in range(len(sources)):
        light = sources[index]
        dx, dy, dz = place[0] - light[0], place[1] - light[1], light[2] - place[2]
        lux = arrives(light, dx, dy, dz)
        if -dx * view[0] - dy * view[1] < view[2] * math.sqrt(dx * dx + dy * dy):
            lux = 0.0
        if lux > 0.0:
            carrier, before, share = int(light[7]), -1, 1.0
            for row in range(len(parts.rows)):
                owner = parts.rows[row, 2]
                if owner in (before, skip, carrier):
                    continue
                way = (dx, dy, -dz)
                if stands_between((light[0], light[1], light[2]), way, parts, row):
                    share *= parts.transmittance[row]
                    before = owner
                    if share == 0.0:
                        break
            lux *= share
        total += lux
    return total
