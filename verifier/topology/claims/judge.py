"""The judge: each claim of a program proved, refuted with a witness, or left undecided.

A claim at single values of the controls is looked up in the portrait there. One over a domain of
controls is proved box by box where it speaks of fixed points alone, and sampled; where it holds at
one value of a control and fails at another, the boundary is located.
"""

from collections.abc import Iterator
from typing import Final

from runtime.claim import Claim
from runtime.program import Program
from runtime.progress import Progress, in_silence
from verifier.topology.claims.at_settings import Outcome, Verdict, verdict_at
from verifier.topology.claims.findings import Finding, Ruling, Witness
from verifier.topology.claims.over_boxes import covered_by_proof
from verifier.topology.claims.over_controls import judged_over
from verifier.topology.claims.watching import Watch
from verifier.topology.features import Settings
from verifier.topology.scenes import Scenes
from verifier.topology.slices import SliceError
from verifier.topology.words import settings_words

PARTS: Final = 1000
"""Of the work on a claim, for its progress."""


def judge(
    program: Program,
    claims: tuple[Claim, ...] | None = None,
    progress: Progress = in_silence,
) -> tuple[Finding, ...]:
    """What is found of each claim, in their order; those of the program where none are given.

    `progress(what, done, of)` is called on the way.
    """
    return tuple(judged(program, claims, progress))


def judged(
    program: Program,
    claims: tuple[Claim, ...] | None = None,
    progress: Progress = in_silence,
) -> Iterator[Finding]:
    """The same, each as soon as it is decided."""
    asked = program.claims if claims is None else claims
    scenes = Scenes(program)
    for index, claim in enumerate(asked):
        whole = PARTS * len(asked)

        def watch(share: float, text: str = claim.text, done: int = index, of: int = whole) -> None:
            progress(text, round(PARTS * (done + share)), of)

        watch(0.0)
        yield _judged(scenes, claim, asked[:index], watch)


def _judged(scenes: Scenes, claim: Claim, above: tuple[Claim, ...], watch: Watch) -> Finding:
    try:
        if claim.over:
            return judged_over(scenes, claim, above, watch)
        return _judged_at(scenes, claim, above)
    except SliceError as error:
        return Finding(claim, Ruling.UNDECIDED, str(error), "nothing was looked at", 0.0, None, ())


RULINGS: Final = {Outcome.FAILS: Ruling.REFUTED, Outcome.OPEN: Ruling.UNDECIDED}


def _judged_at(scenes: Scenes, claim: Claim, above: tuple[Claim, ...]) -> Finding:
    """A claim at single values of all controls."""
    verdict = verdict_at(scenes, claim, above, claim.settings)
    covered = covered_by_proof(scenes, claim, above)
    proved = covered.share == 1.0 and verdict.outcome is Outcome.HOLDS
    ruling = Ruling.HOLDS_PROVED if proved else Ruling.HOLDS_SAMPLED
    ruling = RULINGS.get(verdict.outcome, ruling)
    return Finding(
        claim=claim,
        ruling=ruling,
        sentence=verdict.sentence,
        how=_how(scenes, claim, covered.how if proved else ""),
        proved_share=float(proved),
        witness=_witness(scenes.program, claim, verdict) if not ruling.holds else None,
        boundaries=(),
    )


def _how(scenes: Scenes, claim: Claim, proof: str) -> str:
    """How it was shown, and at which values."""
    at = settings_words(scenes.program, claim.settings) or "the controls' defaults"
    if not scenes.program.controls and not claim.settings:
        return proof or "computed"
    return f"{proof or 'computed'} at {at}"


def _witness(program: Program, claim: Claim, verdict: Verdict) -> Witness:
    given = dict(claim.settings)
    controls: Settings = tuple(
        (control.name, given.get(control.name, control.default)) for control in program.controls
    )
    held = tuple((name, value) for name, value in claim.settings if name not in dict(controls))
    return Witness((*controls, *held), verdict.place, verdict.sentence)
