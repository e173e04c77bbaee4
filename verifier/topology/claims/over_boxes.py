"""Claims about fixed points, proved for whole boxes of controls.

All zeros of the field are enclosed for all controls of a box at once (`prove`). Where the number of
those that a claim counts is the same for the whole box, the claim is decided there; otherwise the
box is halved. Whether a point turns is decided by its Jacobian's discriminant. k: zeros; m: axes.
"""

import math
from collections import deque
from dataclasses import dataclass
from itertools import product
from typing import Final, final

import numpy as np

from runtime.arrays import Array
from runtime.claim import Claim
from runtime.intervals import Interval, add, common, exactly, multiply, square, subtract
from runtime.jet_machine import run_over_boxes
from runtime.jets import SURE, Jet, constant
from runtime.program import Program
from verifier.topology.claims.at_settings import BASIN, Outcome
from verifier.topology.claims.members import POINTS, Fit
from verifier.topology.claims.watching import Watch, unwatched
from verifier.topology.claims.zero_bounds import Moving, zero_within
from verifier.topology.features import PointKind, Settings
from verifier.topology.scenes import Scenes
from verifier.topology.slices import Slice, cut
from verifier.topology.zeros.proof import SMALLEST as STATES_FINEST
from verifier.topology.zeros.proof import Proof, prove

PIECES: Final = {1: 16, 2: 8, 3: 4, 4: 3}
"""Pieces per control that a domain is cut into at first, by the number of controls; else 2.

A box that is too wide takes ten times as long as one in which all zeros are found.
"""

WORK: Final = 400
"""What may be spent on one claim: 1 for a box in which all zeros are found, 10 for others."""

MOST_CUTS: Final = 64
"""Into so many pieces a box of controls is cut at most to see where a zero is."""

FINEST: Final = 2.0**-10
"""Where nothing is decided in boxes of this share of the states' domain, the controls are halved:
within such a box they move the zeros further."""

SMALLEST: Final = 2.0**-14
"""Boxes of this share of the claim's domain are not halved any more."""


@final
@dataclass(frozen=True, slots=True)
class Covered:
    """How much of a claim's domain is covered by proof, and how.

    failing: settings in the middle of boxes in which the claim is proved to fail.
    """

    share: float
    how: str
    failing: tuple[Settings, ...]


@final
@dataclass(frozen=True, slots=True)
class _Box:
    """A box of controls: their lowest and highest values, of those in `names`."""

    low: tuple[float, ...]
    high: tuple[float, ...]
    share: float


NOTHING: Final = Covered(0.0, "", ())


def covered_by_proof(
    scenes: Scenes, claim: Claim, above: tuple[Claim, ...], watch: Watch = unwatched
) -> Covered:
    """The share of the claim's domain on which it is proved; 1 or 0 where it has no `over`.

    `watch(share)` is called with the share of the work that is done.

    With modes the zeros of each are those at which it is not left.

    Raises:
        SliceError: nothing moves, or too much.
    """
    if not is_provable(claim):
        return NOTHING
    waiting, proved, tried, about, work = deque(_pieces(claim)), 0.0, 0, "", 0
    while waiting and work < WORK:
        box = waiting.popleft()
        provers = [_Prover(scenes, claim, box, mode) for mode in _modes(scenes.program)]
        tried, work = tried + 1, work + sum(prover.work for prover in provers)
        outcome = _outcome(provers, claim, above)
        watch(max(work / WORK, proved))
        about = provers[0].about
        if outcome is Outcome.HOLDS:
            proved += box.share
        elif outcome is Outcome.FAILS:
            return Covered(proved, _how(about, claim, proved, tried), (provers[0].middle,))
        elif claim.over and box.share > SMALLEST:
            waiting.extend(_halves(claim, box))
    share = 1.0 if not waiting and proved > 1.0 - SMALLEST / 2 else min(proved, 1.0 - SMALLEST)
    return Covered(share, _how(about, claim, share, tried), ())


def _modes(program: Program) -> tuple[int | None, ...]:
    """The modes of a field that switches; else None alone."""
    if not program.field.guards:
        return (None,)
    values = next(s.values for s in program.states if s.name == program.field.mode)
    return tuple(range(len(values)))


def _outcome(provers: "list[_Prover]", claim: Claim, above: tuple[Claim, ...]) -> Outcome:
    """The claim on a box: whether it holds, or fails, for all controls in it, in all modes."""
    fits = [fit for prover in provers for fit in prover.fits(above)]
    least = fits.count(Fit.YES)
    unseen = 0.0 if all(prover.complete for prover in provers) else np.inf
    most = least + fits.count(Fit.MAYBE) + unseen
    limit = np.inf if claim.most is None else claim.most
    if claim.least <= least and most <= limit:
        return Outcome.HOLDS
    cycles_count = claim.feature in {"attractor", "repeller"}
    if least > limit or (most < claim.least and not cycles_count):
        return Outcome.FAILS
    return Outcome.OPEN


def _pieces(claim: Claim) -> list[_Box]:
    """The domain of the claim in boxes, one where it has no `over`."""
    d = len(claim.over)
    count = PIECES.get(d, 2)
    edges = [np.linspace(span.low, span.high, count + 1).tolist() for span in claim.over]
    return [
        _Box(
            tuple(e[i] for e, i in zip(edges, index, strict=True)),
            tuple(e[i + 1] for e, i in zip(edges, index, strict=True)),
            float(count) ** -d,
        )
        for index in product(range(count), repeat=d)
    ]


def is_provable(claim: Claim) -> bool:
    """Whether bounds of the field's zeros can decide the claim.

    Attractors and repellers may be cycles, too, and more of them never do harm to an `at least`.
    """
    if claim.feature not in POINTS or claim.feature in {BASIN, "center"}:
        return False
    return claim.feature not in {"attractor", "repeller"} or (
        claim.most is None and not claim.other
    )


def _how(about: str, claim: Claim, share: float, tried: int) -> str:
    if share == 0.0:
        return ""
    by = f"proved by interval arithmetic for {about}"
    if not claim.over:
        return by
    names = ", ".join(span.control for span in claim.over)
    part = "all" if share == 1.0 else f"{math.floor(1000.0 * share) / 10.0:g} %"
    return f"{by}, for {part} of the domain of {names}, in {tried} pieces"


def _halves(claim: Claim, box: _Box) -> list[_Box]:
    """The box, cut in two across its widest side, as a share of the claim's domain."""
    widths = [
        (high - low) / (span.high - span.low)
        for low, high, span in zip(box.low, box.high, claim.over, strict=True)
    ]
    i = widths.index(max(widths))
    middle = 0.5 * (box.low[i] + box.high[i])
    lower = (*box.high[:i], middle, *box.high[i + 1 :])
    upper = (*box.low[:i], middle, *box.low[i + 1 :])
    return [_Box(box.low, lower, box.share / 2), _Box(upper, box.high, box.share / 2)]


@final
class _Prover:
    """All zeros of the field, or of one mode of it, over one box of controls, beside a claim."""

    def __init__(self, scenes: Scenes, claim: Claim, box: _Box, mode: int | None = None) -> None:
        self._claim = claim
        self._mode = mode
        self._program: Program = scenes.program
        names = [span.control for span in claim.over]
        middle = [0.5 * (a + b) for a, b in zip(box.low, box.high, strict=True)]
        self.middle: Settings = (*claim.settings, *zip(names, middle, strict=True))
        self._view: Slice = cut(self._program, scenes.axes(claim.settings), self._held())
        self._controls = np.stack([self._view.u, self._view.u])
        columns = [control.name for control in self._program.controls]
        for name, low, high in zip(names, box.low, box.high, strict=True):
            self._controls[:, columns.index(name)] = low, high
        finest = FINEST if claim.over else STATES_FINEST
        self._proof: Proof = prove(self._view, self._controls, smallest=finest)
        self.about = self._proof.about + (" of each mode" if mode is not None else "")
        self.complete = self._proof.complete
        self.work = 1 if self.complete else 10

    def fits(self, above: tuple[Claim, ...]) -> list[Fit]:
        """Of each zero, whether the claim counts it for all controls in the box."""
        known = [
            claim
            for claim in above
            if self._claim.other and claim.feature != BASIN and claim.most != 0
        ]
        fits = []
        for i in range(len(self._proof.zeros)):
            fit = self._fit(self._claim, i)
            others = [self._fit(claim, i) for claim in known]
            if Fit.YES in others:
                fit = Fit.NO
            elif Fit.MAYBE in others:
                fit = min(fit, Fit.MAYBE)
            fits.append(min(fit, self._stays(i)))
        return fits

    def _held(self) -> dict[str, float]:
        held = dict(self.middle)
        if self._mode is not None:
            held[self._program.field.mode] = float(self._mode)
        return held

    def _stays(self, i: int) -> Fit:
        """Whether the mode is not left at zero i: its guards are shut there."""
        guards = [g for g in self._program.field.guards if g.mode == self._mode]
        if not guards:
            return Fit.YES
        register = self._register(self._controls, ())
        for state, value in zip(self._view.program.states, self._view.x, strict=True):
            register[state.name] = constant(exactly(np.array([value])))
        zero, radius = self._proof.zeros[i], self._proof.radii[i]
        for axis, low, high in zip(self._view.axes, zero - radius, zero + radius, strict=True):
            register[axis.name] = constant(Interval(np.array([low]), np.array([high])))
        fit = Fit.YES
        for jet in run_over_boxes([guard.condition for guard in guards], register):
            if np.all(jet.sure) and float(jet.value.low[0]) >= 0.0:
                return Fit.NO
            if not (np.all(jet.sure) and float(jet.value.high[0]) < 0.0):
                fit = Fit.MAYBE
        return fit

    def _fit(self, claim: Claim, i: int) -> Fit:
        """Whether zero i is one of those that a claim speaks of, for all controls of the box."""
        of_type = self._type(claim, i)
        return of_type if of_type is Fit.NO else min(of_type, self._place(claim, i))

    def _type(self, claim: Claim, i: int) -> Fit:
        wanted = POINTS.get(claim.feature, frozenset())
        if claim.feature == "fixed point":
            return Fit.YES
        possible = self._kinds(i)
        if possible <= wanted:
            return Fit.YES
        return Fit.MAYBE if possible & wanted else Fit.NO

    def _kinds(self, i: int) -> frozenset[PointKind]:
        """The types that zero i may have."""
        grows = self._proof.unstable[i]
        m = self._proof.zeros.shape[1]
        if grows is None:
            return frozenset(PointKind)
        if 0 < grows < m:
            return frozenset({PointKind.SADDLE} | ({PointKind.UNSTABLE_FOCUS} if m > 2 else set()))
        turns = _turns(self._proof.slopes, i)
        node, focus = (
            (PointKind.STABLE_NODE, PointKind.STABLE_FOCUS)
            if grows == 0
            else (PointKind.UNSTABLE_NODE, PointKind.UNSTABLE_FOCUS)
        )
        if turns is None:
            return frozenset({node, focus})
        return frozenset({focus if turns else node})

    def _place(self, claim: Claim, i: int) -> Fit:
        """Whether zero i is at the claim's place for all controls of the box.

        The place and the zero move with the controls, so the box is cut until it is clear.
        """
        if not claim.places:
            return Fit.YES
        zero, radius = self._proof.zeros[i], self._proof.radii[i]
        resting = Moving.resting(zero - radius, zero + radius)
        clear = self._placed(claim, self._controls, resting)
        if clear is not Fit.MAYBE:
            return clear
        waiting = deque([(self._controls, zero - radius, zero + radius)])
        fits: set[Fit] = set()
        for _ in range(MOST_CUTS):
            controls, low, high = waiting.popleft()
            moving = zero_within(self._view, controls, low, high)
            fit = self._placed(claim, controls, moving)
            if fit is Fit.MAYBE and not self._claim.over:
                return fit
            if fit is Fit.MAYBE:
                low, high = moving.bounds.low, moving.bounds.high
                waiting.extend((half, low, high) for half in self._cut(controls))
            else:
                fits.add(fit)
            if len(fits) > 1 or not waiting:
                break
        return fits.pop() if len(fits) == 1 and not waiting else Fit.MAYBE

    def _placed(self, claim: Claim, controls: Array, moving: Moving) -> Fit:
        """Whether a zero is at the claim's place, wherever both go with the controls."""
        fit = Fit.YES
        names = [axis.name for axis in self._view.axes]
        codes = [place.at for place in claim.places]
        jets = run_over_boxes(codes, self._register(controls, moving.controls))
        middle = 0.5 * controls[0] + 0.5 * controls[1]
        middle[[c.name in moving.controls for c in self._program.controls]] = moving.middle
        still = run_over_boxes(codes, self._register(np.stack([middle, middle]), ()))
        for place, jet, there in zip(claim.places, jets, still, strict=True):
            j = names.index(place.state)
            axis = self._view.axes[j]
            off = _apart(moving, j, jet, there)
            first, last = float(np.min(off.low)), float(np.max(off.high))
            if axis.periodic:
                turns = axis.width * round(0.5 * (first + last) / axis.width)
                first, last = first - turns, last - turns
            # An ulp of the subtraction is far below what anybody asks for.
            if first > place.within or last < -place.within:
                return Fit.NO
            if not (np.all(jet.sure) and -place.within <= first and last <= place.within):
                fit = Fit.MAYBE
        return fit

    def _cut(self, controls: Array) -> list[Array]:
        """The box of controls in two, across its widest side as a share of the whole box."""
        whole = self._controls[1] - self._controls[0]
        widths = np.where(whole > 0.0, controls[1] - controls[0], 0.0) / np.where(whole, whole, 1.0)
        i = int(np.argmax(widths))
        middle = 0.5 * (controls[0, i] + controls[1, i])
        lower, upper = controls.copy(), controls.copy()
        lower[1, i] = upper[0, i] = middle
        return [lower, upper]

    def _register(self, controls: Array, moves: tuple[str, ...]) -> dict[str, Jet]:
        """The controls between (2, p) low and high, and the constants; `moves` have slopes."""
        units = dict(zip(moves, np.eye(len(moves))[:, :, None], strict=True))
        between = {
            control.name: Jet(
                Interval(np.array([low]), np.array([high])),
                exactly(units[control.name]) if control.name in units else None,
                SURE,
            )
            for control, low, high in zip(self._program.controls, *controls, strict=True)
        }
        given = {c.name: constant(exactly(np.array([c.value]))) for c in self._program.constants}
        return {**between, **given}


def _apart(moving: Moving, j: int, place: Jet, middle: Jet) -> Interval:
    """How far the zero is from a place on axis j: as they are, and by how both move.

    place: for all controls; middle: at the middle of the controls.
    """
    bounds = Interval(moving.bounds.low[j : j + 1], moving.bounds.high[j : j + 1])
    plainly = subtract(bounds, place.value)
    off = subtract(exactly(moving.centre[j : j + 1]), middle.value)
    off = add(off, Interval(moving.rest.low[j : j + 1], moving.rest.high[j : j + 1]))
    for d in range(len(moving.controls)):
        motion = exactly(moving.slopes[j, d : d + 1])
        if place.slopes is not None:
            motion = subtract(motion, Interval(place.slopes.low[d], place.slopes.high[d]))
        span = Interval(moving.off.low[d : d + 1], moving.off.high[d : d + 1])
        off = add(off, multiply(motion, span))
    return common(plainly, off)


def _turns(slopes: Interval, i: int) -> bool | None:
    """Whether the eigenvalues of zero i are complex; None where that is not certain."""
    low, high = slopes.low[i], slopes.high[i]
    if len(low) == 1:
        return False
    if len(low) > 2:
        return None

    def entry(row: int, column: int) -> Interval:
        return Interval(np.array([low[row, column]]), np.array([high[row, column]]))

    # (a - d)² + 4 b c < 0.
    skew = multiply(exactly(np.array([4.0])), multiply(entry(0, 1), entry(1, 0)))
    discriminant = add(square(subtract(entry(0, 0), entry(1, 1))), skew)
    if float(discriminant.high[0]) < 0.0:
        return True
    return False if float(discriminant.low[0]) >= 0.0 else None
