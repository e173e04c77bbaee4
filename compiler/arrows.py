"""A field sketched by arrows: its sampler, and where the sketch does not reach."""

import numpy as np

from compiler.declare import Declarations
from compiler.findings import Findings
from compiler.ranges import Range, range_of, scales
from compiler.scattered import SketchError, piecewise_linear, reaches_beyond, thin_plate
from compiler.tabulate import Sampler
from runtime.arrays import Array, frozen
from spec_schema.field_forms import Arrows


def arrows_sampler(
    form: Arrows, declared: Declarations, drives: tuple[str, ...], findings: Findings
) -> Sampler | None:
    """The field through the arrows, with a warning where the sketch does not reach."""
    at = frozen([arrow.at for arrow in form.sketch]) * scales(form.over, declared)
    go = frozen([arrow.go for arrow in form.sketch]) * scales(drives, declared)
    ranges = [range_of(name, declared) for name in form.over]
    low, high = frozen([r.low for r in ranges]), frozen([r.high for r in ranges])
    periodic = tuple(span.periodic for span in ranges)
    try:
        if form.fill == "thin_plate":
            sample = thin_plate(at, go, low, high, periodic)
        else:
            sample = piecewise_linear(*_wrapped(at, go, ranges))
        beyond = reaches_beyond(*_wrapped(at, go, ranges)[:1], low, high)
    except SketchError as error:
        findings.error("S234", ("field", "arrows", "sketch"), error.message, error.remedy)
        return None
    if beyond is not None:
        findings.warning(
            "S224",
            ("field", "arrows", "sketch"),
            f"the domain of '{form.over[beyond]}' reaches beyond the hull of the sketch, where the "
            "field is a guess",
            "sketch arrows at the corners of the domain, or shrink the domain",
        )
    return sample


def _wrapped(at: Array, go: Array, ranges: list[Range]) -> tuple[Array, Array]:
    """The sketch with a copy on either side of every periodic axis, so that its ends meet."""
    for i, span in enumerate(ranges):
        if span.periodic:
            turn = np.zeros(len(ranges))
            turn[i] = span.high - span.low
            at = np.concatenate([at - turn, at, at + turn])
            go = np.concatenate([go, go, go])
            at, kept = np.unique(at, axis=0, return_index=True)
            go = go[kept]
    return at, go
