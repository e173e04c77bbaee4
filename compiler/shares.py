"""A drawn field taken apart: its vectors, and how much each counts at a place."""

from dataclasses import dataclass
from typing import final

import numpy as np

from compiler.arrows import arrow_shares
from compiler.check import check_behavior
from compiler.grid import grid_shares
from compiler.ranges import scales
from compiler.references import drives_of
from compiler.tabulate import Sampler
from runtime.arrays import Array, frozen
from spec_schema.behavior import BehaviorSpec
from spec_schema.field_forms import Arrows
from spec_schema.field_grid import Grid
from spec_schema.load import Loaded
from spec_schema.places import Path


@final
@dataclass(frozen=True, eq=False, slots=True)
class Shares:
    """Vectors (N, m) in SI that stand inline, and the function from places (P, d) to shares (P, N).

    paths: where each number (N, m) stands. over, drives: the d axes and the m driven states.
    """

    over: tuple[str, ...]
    drives: tuple[str, ...]
    sample: Sampler
    values: Array
    paths: tuple[tuple[Path, ...], ...]


def shares_of(loaded: Loaded) -> Shares | None:
    """The vectors of a field of `arrows` or of an inline `grid`; None for any other field.

    The spec must compile.
    """
    spec = loaded.spec
    if not isinstance(spec, BehaviorSpec):
        return None
    checked = check_behavior(loaded, spec)
    form, declared = spec.field.form, checked.declared
    drives = drives_of(form, declared)
    units = scales(drives, declared)
    match form:
        case Arrows():
            go = frozen([arrow.go for arrow in form.sketch]) * units
            paths = tuple(
                tuple(("field", "arrows", "sketch", k, "go", j) for j in range(len(drives)))
                for k in range(len(form.sketch))
            )
            return Shares(form.over, drives, arrow_shares(form, declared), go, paths)
        case Grid() if form.values is not None:
            shape = form.values[drives[0]].shape
            columns = [frozen(form.values[name].numbers) for name in drives]
            paths = tuple(
                tuple(("field", "grid", "values", name, *index) for name in drives)
                for index in np.ndindex(*shape)
            )
            sample = grid_shares(form, spec, declared, checked.findings)
            return Shares(form.over, drives, sample, np.stack(columns, axis=-1) * units, paths)
        case _:
            return None
