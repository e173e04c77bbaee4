"""A field sketched by arrows: its sampler, and where the sketch does not reach."""

import numpy as np

from compiler.declare import Declarations
from compiler.findings import Findings
from compiler.fitted import Surface, least_squares
from compiler.quantities import rate_text
from compiler.ranges import Range, range_of, scales
from compiler.scattered import SketchError, piecewise_linear, reaches_beyond, thin_plate
from compiler.tabulate import Sampler
from runtime.arrays import Array, frozen
from spec_schema.field_forms import Arrows


def arrows_sampler(
    form: Arrows, declared: Declarations, drives: tuple[str, ...], findings: Findings
) -> Sampler | None:
    """The field of the arrows, with a warning where the sketch does not reach.

    A fit leaves a note on how far it is from them.
    """
    at = frozen([arrow.at for arrow in form.sketch]) * scales(form.over, declared)
    go = frozen([arrow.go for arrow in form.sketch]) * scales(drives, declared)
    ranges = [range_of(name, declared) for name in form.over]
    low, high = frozen([r.low for r in ranges]), frozen([r.high for r in ranges])
    try:
        sample = _filled(form, at, go, ranges)
        if isinstance(sample, Surface):
            _note_misfits(sample, at, go, drives, declared, findings)
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


def arrow_shares(form: Arrows, declared: Declarations) -> Sampler:
    """How much each arrow (N) counts at places (P, d): the field is the sum of share times arrow.

    The arrows must fill, as `arrows_sampler` tests.
    """
    at = frozen([arrow.at for arrow in form.sketch]) * scales(form.over, declared)
    return _filled(form, at, np.eye(len(at)), [range_of(name, declared) for name in form.over])


def _filled(form: Arrows, at: Array, go: Array, ranges: list[Range]) -> Sampler:
    """What is between the arrows `go` (k, m) at `at` (k, d), both in SI; linear in `go`."""
    low, high = frozen([r.low for r in ranges]), frozen([r.high for r in ranges])
    periodic = tuple(span.periodic for span in ranges)
    if form.fill == "least_squares":
        weights = np.array([arrow.weight or 1.0 for arrow in form.sketch])
        return least_squares(at, go, weights, low, high, periodic, form.degree)
    if form.fill == "thin_plate":
        return thin_plate(at, go, low, high, periodic)
    return piecewise_linear(*_wrapped(at, go, ranges))


def _note_misfits(
    surface: Surface,
    at: Array,
    go: Array,
    drives: tuple[str, ...],
    declared: Declarations,
    findings: Findings,
) -> None:
    """How far the fit is from the arrows: on average, and where most."""
    numbers = len(surface.exponents)
    findings.note(
        f"fitted: {len(at)} arrows in least squares by a surface of degree {surface.degree}, "
        f"{numbers} numbers for each rate"
    )
    for i, name in enumerate(drives):
        unit = declared.variable(name).unit
        misfit = np.abs(surface(at)[:, i] - go[:, i]) / unit.scale
        worst = int(misfit.argmax())
        where = findings.origin(("field", "arrows", "sketch", worst))
        findings.note(
            f"fitted {name}: off by {np.sqrt(np.mean(misfit**2)):.3g} {rate_text(unit.text)} on "
            f"average (rms), at most {misfit[worst]:.3g} at the arrow in {where}"
        )


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
