"""A claim over a domain of controls: proved on boxes of it, sampled in it, its boundaries located.

d: number of controls that take all values.
"""

from collections.abc import Callable, Iterable
from itertools import product
from typing import Final, TypeAlias, final

import numpy as np

from runtime.arrays import Array
from runtime.claim import Claim, Span
from verifier.topology.branches.boundaries import CLOSE, COARSE, Bracket, explained, narrowed
from verifier.topology.claims.at_settings import BASIN, Outcome, Verdict, needs_cycles, verdict_at
from verifier.topology.claims.findings import Boundary, Finding, Ruling, Witness
from verifier.topology.claims.over_boxes import Covered, covered_by_proof
from verifier.topology.claims.watching import Watch, part, unwatched
from verifier.topology.features import Portrait, Settings
from verifier.topology.paths.seeds import GENERATORS
from verifier.topology.scenes import Scenes
from verifier.topology.words import settings_words

MOST_CORNERS: Final = 4
"""The corners of a domain of more controls than this are not all looked at."""

SAMPLES: Final = {"points": 33, "cycles": 17, "basins": 7}
"""How many values of one control are looked at."""

MORE_SAMPLES: Final = {"points": 48, "cycles": 16, "basins": 6}
"""How many settings inside a domain of several controls, beside corners and default."""

LINE: Final = 9
"""How many values of one control are looked at for a boundary beside a witness."""

At: TypeAlias = Callable[[float], Settings]

NUDGE: Final = 0.00314
"""How far a sample is moved that falls on a bifurcation, as a share of the interval."""


LOOKING: Final = 0.5
"""The share of the work on a claim until all samples are looked at."""


def judged_over(
    scenes: Scenes, claim: Claim, above: tuple[Claim, ...], watch: Watch = unwatched
) -> Finding:
    """What is found of a claim that holds over a domain of controls, or does not.

    `watch(share)` is called with the share of the work that is done.
    """
    look = _Look(scenes, claim, above)
    settings = look.samples()
    looking = part(watch, 0.0, LOOKING)
    for index, one in enumerate(settings):
        look.at(one)
        looking((index + 1) / len(settings))
    failing = look.those(settings, Outcome.FAILS)
    if failing:
        return _refuted(look, failing, len(settings))
    covered = covered_by_proof(scenes, claim, above, part(watch, LOOKING, 1.0))
    sentence = f"{look.example_words()}: {look.at(look.default()).sentence}"
    if covered.share == 1.0:
        return Finding(claim, Ruling.HOLDS_PROVED, sentence, covered.how, 1.0, None, ())
    failing = look.those(covered.failing, Outcome.FAILS)
    if failing:
        return _refuted(look, failing, len(settings) + 1)
    undecided = look.those(settings, Outcome.OPEN)
    if undecided:
        return _undecided(look, covered, undecided, len(settings))
    how = _sampled(claim, covered, len(settings))
    return Finding(claim, Ruling.HOLDS_SAMPLED, sentence, how, covered.share, None, ())


def _refuted(look: "_Look", failing: list[Settings], of: int) -> Finding:
    witness = failing[0]
    verdict = look.at(witness)
    return Finding(
        claim=look.claim,
        ruling=Ruling.REFUTED,
        sentence=verdict.sentence,
        how=f"it fails at {len(failing)} of {of} settings looked at",
        proved_share=0.0,
        witness=Witness(look.every_control(witness), verdict.place, verdict.sentence),
        boundaries=look.boundaries(witness),
    )


def _undecided(look: "_Look", covered: Covered, where: list[Settings], of: int) -> Finding:
    verdict = look.at(where[0])
    return Finding(
        claim=look.claim,
        ruling=Ruling.UNDECIDED,
        sentence=verdict.sentence,
        how=f"{len(where)} of {of} settings looked at are not decided",
        proved_share=covered.share,
        witness=Witness(look.every_control(where[0]), verdict.place, verdict.sentence),
        boundaries=(),
    )


def _sampled(claim: Claim, covered: Covered, count: int) -> str:
    names = ", ".join(span.control for span in claim.over)
    sampled = f"computed at {count} settings of {names}"
    if covered.share > 0.0:
        return f"{covered.how}; the rest {sampled}"
    return f"{sampled}, not proved between them"


@final
class _Look:
    """One claim, looked at anywhere in its domain."""

    def __init__(self, scenes: Scenes, claim: Claim, above: tuple[Claim, ...]) -> None:
        self.claim = claim
        self._scenes = scenes
        self._above = above
        self._seen: dict[Settings, Verdict] = {}
        controls = {control.name: control for control in scenes.program.controls}
        self._controls = controls
        kind = "points"
        if needs_cycles(claim):
            kind = "basins" if claim.feature == BASIN else "cycles"
        self._kind = kind

    def at(self, settings: Settings) -> Verdict:
        """The claim at a setting; just beside it where it can't be decided there."""
        if settings not in self._seen:
            verdict = verdict_at(self._scenes, self.claim, self._above, settings)
            if verdict.outcome is Outcome.OPEN:
                beside = verdict_at(self._scenes, self.claim, self._above, self._nudged(settings))
                verdict = verdict if beside.outcome is Outcome.OPEN else beside
            self._seen[settings] = verdict
        return self._seen[settings]

    def those(self, settings: Iterable[Settings], outcome: Outcome) -> list[Settings]:
        """The settings at which the claim has this outcome."""
        return [one for one in settings if self.at(one).outcome is outcome]

    def default(self) -> Settings:
        """The defaults of the controls, as far as they lie in the claim's domain."""
        return self._settings(
            [
                min(max(self._controls[span.control].default, span.low), span.high)
                for span in self.claim.over
            ]
        )

    def example_words(self) -> str:
        """Where the example is that a sentence gives: `at the defaults`."""
        settings = self.default()
        if all(
            value == self._controls[name].default
            for name, value in settings
            if name in self._controls
        ):
            return "at the defaults"
        return f"at {settings_words(self._scenes.program, settings)}"

    def samples(self) -> list[Settings]:
        """Where the claim is looked at: the default first, then ends and corners, then between."""
        spans = self.claim.over
        if len(spans) == 1:
            shares = np.linspace(0.0, 1.0, SAMPLES[self._kind])[:, None]
        else:
            corners = list(product((0.0, 1.0), repeat=len(spans)))[: 2**MOST_CORNERS]
            shares = np.vstack([corners, _spread(len(spans), MORE_SAMPLES[self._kind])])
        low = np.array([span.low for span in spans])
        high = np.array([span.high for span in spans])
        values = np.clip(low + shares * (high - low), low, high)
        found = [self.default(), *(self._settings(row) for row in values.tolist())]
        return list(dict.fromkeys(found))

    def boundaries(self, witness: Settings) -> tuple[Boundary, ...]:
        """Where the claim begins or ceases to hold, on a line along each control."""
        found = [b for span in self.claim.over for b in self._on_line(span, dict(witness))]
        return tuple(found)

    def every_control(self, settings: Settings) -> Settings:
        """The values of all controls, and of the states that are held."""
        given = dict(settings)
        controls = tuple((c.name, given.get(c.name, c.default)) for c in self._controls.values())
        return (*controls, *((n, v) for n, v in settings if n not in self._controls))

    def _on_line(self, span: Span, witness: dict[str, float]) -> list[Boundary]:
        count = SAMPLES[self._kind] if len(self.claim.over) == 1 else LINE
        values = sorted({*np.linspace(span.low, span.high, count).tolist(), witness[span.control]})

        def at(value: float) -> Settings:
            return self._settings(
                [{**witness, span.control: value}[s.control] for s in self.claim.over]
            )

        outcomes = [self.at(at(value)).outcome for value in values]
        found = []
        for i in range(len(values) - 1):
            if {outcomes[i], outcomes[i + 1]} == {Outcome.HOLDS, Outcome.FAILS}:
                bracket = Bracket(values[i], values[i + 1])
                found.append(self._boundary(span, bracket, at))
        return found

    def _boundary(self, span: Span, bracket: Bracket, at: At) -> Boundary:
        control = self._controls[span.control]
        width = control.high - control.low
        fine = CLOSE if self._kind == "points" else COARSE
        narrow = narrowed(bracket, lambda value: self.at(at(value)).outcome, fine * width)
        above = self.at(at(narrow.high)).outcome is Outcome.HOLDS
        failing = self.at(at(narrow.low if above else narrow.high))

        def inside(value: float) -> Settings:
            return at(min(max(value, control.low), control.high))

        def points(value: float) -> Portrait:
            return self._scenes.at(inside(value), cycles=False, basins=False)

        def everything(value: float) -> Portrait:
            return self._scenes.at(inside(value), cycles=needs_cycles(self.claim), basins=False)

        located, why = explained(narrow, width, points, everything)
        about = failing.sentence if why.is_none else why.about
        return Boundary(
            control=span.control,
            value=located.middle,
            within=0.5 * (located.high - located.low),
            above=above,
            change=why.change,
            about=about,
        )

    def _settings(self, values: list[float]) -> Settings:
        over = tuple((s.control, float(v)) for s, v in zip(self.claim.over, values, strict=True))
        return (*self.claim.settings, *over)

    def _nudged(self, settings: Settings) -> Settings:
        """Beside a setting: inwards along each control."""
        given = dict(settings)
        moved = []
        for span in self.claim.over:
            step = NUDGE * (span.high - span.low)
            value = given[span.control]
            moved.append(value + step if value + step <= span.high else value - step)
        return self._settings(moved)


def _spread(d: int, count: int) -> Array:
    """Shares (count, d) that fill the unit box evenly (M. Roberts 2018)."""
    root = GENERATORS.get(d) or 1.0 + 1.0 / (d + 1)
    steps = root ** -np.arange(1.0, d + 1.0)
    return np.asarray(np.mod(0.5 + np.outer(np.arange(count), steps), 1.0))
