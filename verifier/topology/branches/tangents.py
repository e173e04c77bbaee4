"""How fixed points move with a control: dz/dc = -J⁻¹ dF/dc. k: points; m: axes."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Final

import numpy as np

from runtime.arrays import Array, frozen
from runtime.program import Program
from verifier.topology.features import Portrait
from verifier.topology.slices import cut, jacobians_at, rates_at

STEP: Final = 1e-5
"""Of the difference that stands for a derivative by the control, as a share of its domain."""


def tangents(
    program: Program,
    axes: tuple[str, ...],
    settings: Mapping[str, float],
    control: str,
    seen: Portrait,
) -> Array:
    """By how much each fixed point of the portrait moves per unit of the control, (k, m).

    Not finite where it has no direction, as at a fold.
    """
    if not seen.fixed_points:
        return frozen(np.empty((0, len(axes))))
    view = cut(program, axes, settings)
    names = [each.name for each in program.controls]
    column = names.index(control)
    part = program.controls[column]
    at = np.array([point.at for point in seen.fixed_points])
    step = STEP * (part.high - part.low)
    ends = []
    for side in (-1.0, 1.0):
        u = view.u.copy()
        u[column] = min(max(u[column] + side * step, part.low), part.high)
        ends.append((u[column], rates_at(replace(view, u=frozen(u)), at)))
    (first, before), (last, after) = ends
    J = jacobians_at(view, at) - (np.eye(len(axes)) if view.is_map else 0.0)
    with np.errstate(all="ignore"):
        by_control = (after - before) / (last - first)
        regular = np.isfinite(J).all(axis=(-2, -1)) & (np.abs(np.linalg.det(J)) > 0.0)
        safe = np.where(regular[:, None, None], J, np.eye(len(axes)))
        moved = -np.linalg.solve(safe, by_control[..., None])[..., 0]
        return frozen(np.where(regular[:, None], moved, np.inf))
