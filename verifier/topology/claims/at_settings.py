"""A claim at one setting of the controls: does it hold there, and what was found instead?"""

from dataclasses import dataclass
from enum import StrEnum
from typing import Final, final

import numpy as np

from runtime.claim import Claim
from verifier.topology.claims.members import CYCLES, POINTS, Fit, Member, members, named
from verifier.topology.ends.shares import share_within
from verifier.topology.features import Completeness, Portrait, Settings
from verifier.topology.hybrid.cycles import CHATTERING
from verifier.topology.scenes import Scenes
from verifier.topology.words import (
    described_cycle,
    described_point,
    listed_features,
    plural,
    share_words,
)

BASIN: Final = "basin"


@final
class Outcome(StrEnum):
    """What a claim is at one setting."""

    HOLDS = "holds"
    FAILS = "fails"
    OPEN = "open"


@final
@dataclass(frozen=True, slots=True)
class Verdict:
    """A claim at one setting. place: of the feature that the sentence speaks of, if there is."""

    outcome: Outcome
    sentence: str
    place: Settings


def needs_cycles(claim: Claim) -> bool:
    """Whether cycles can be among what the claim counts."""
    return claim.feature in CYCLES or claim.feature == BASIN


def verdict_at(
    scenes: Scenes, claim: Claim, above: tuple[Claim, ...], settings: Settings
) -> Verdict:
    """The claim at `settings`; `above` are the claims before it.

    Raises:
        SliceError: nothing moves, or too much.
    """
    if claim.feature == BASIN:
        return _basin(scenes, claim, above, settings)
    seen = scenes.at(settings, cycles=needs_cycles(claim), basins=False)
    found = members(scenes.program, claim, seen, settings)
    if claim.other:
        known = {
            key
            for before in above
            if before.feature != BASIN and before.most != 0
            for key in named(scenes.program, before, seen, settings)
        }
        found = tuple(member for member in found if member.key not in known)
    return _counted(claim, seen, found)


def _counted(claim: Claim, seen: Portrait, found: tuple[Member, ...]) -> Verdict:
    sure = [member for member in found if member.fit is Fit.YES]
    perhaps = [member for member in found if member.fit is Fit.MAYBE]
    unseen = _unseen(claim, seen.completeness)
    least, most = len(sure), len(sure) + len(perhaps) + unseen
    limit = np.inf if claim.most is None else claim.most
    if claim.least <= least and most <= limit:
        outcome = Outcome.HOLDS
    elif most < claim.least or least > limit:
        outcome = Outcome.FAILS
    else:
        outcome = Outcome.OPEN
    sentence = _sentence(claim, seen, found, outcome)
    return Verdict(outcome, sentence, _place(claim, seen, found, outcome))


def _unseen(claim: Claim, completeness: Completeness) -> float:
    """How many more there may be: any number in a box that is not decided."""
    return np.inf if claim.feature in POINTS and completeness.undecided else 0


def _sentence(claim: Claim, seen: Portrait, found: tuple[Member, ...], outcome: Outcome) -> str:
    sure = [member for member in found if member.fit is Fit.YES]
    near = _near_misses(found)
    perhaps = [member for member in found if member.fit is Fit.MAYBE]
    shown = [_described(seen, member, claim.feature) for member in sure[:3]]
    alone = len(sure) == 1 and shown[0].startswith(("at ", "with "))
    text = _so_many(claim, len(sure)) + (
        f"{' ' if alone else ': '}{'; '.join(shown)}" if sure else ""
    )
    if outcome is Outcome.HOLDS:
        return text
    text = f"{_wanted(claim)}, found {text}"
    if outcome is Outcome.OPEN and perhaps:
        return f"{text}; not decided: {_described(seen, perhaps[0])}"
    if outcome is Outcome.OPEN:
        return f"{text}; parts of the domain are not decided"
    if near:
        return f"{text}; {_described(seen, near[0])} does not count: {near[0].why}"
    return text if sure else f"{text}; {_what_there_is(seen)}"


def _what_there_is(seen: Portrait) -> str:
    """What there is instead, and that trajectories chatter: they come to no cycle."""
    chattering = [note for note in seen.notes if note.startswith(CHATTERING)]
    return "; ".join([listed_features(seen), *chattering])


def _near_misses(found: tuple[Member, ...]) -> list[Member]:
    """The features of the right type that do not count, the nearest miss first."""
    near = [member for member in found if member.of_type is not Fit.NO and member.why]
    return sorted(near, key=lambda member: member.off)


def _described(seen: Portrait, member: Member, known_as: str = "") -> str:
    """A feature in words, without the type that is `known_as` already."""
    if member.is_cycle:
        words = described_cycle(seen.axes, seen.cycles[member.index])
    else:
        words = described_point(seen.axes, seen.fixed_points[member.index])
    return words.removeprefix(f"{known_as} ") if known_as else words


def _place(claim: Claim, seen: Portrait, found: tuple[Member, ...], outcome: Outcome) -> Settings:
    """Where a failing claim fails: at a feature too many, or at the one that nearly fits."""
    if outcome is Outcome.HOLDS:
        return ()
    sure = [member for member in found if member.fit is Fit.YES]
    too_many = claim.most is not None and len(sure) > claim.most
    any_point = [member for member in found if not member.is_cycle]
    shown = (sure[-1:] if too_many else ()) or (_near_misses(found) or sure or any_point)[:1]
    if not shown:
        return ()
    [member] = shown
    at = (
        seen.cycles[member.index].points[0]
        if member.is_cycle
        else seen.fixed_points[member.index].at
    )
    return tuple((axis.name, float(value)) for axis, value in zip(seen.axes, at, strict=True))


def _basin(scenes: Scenes, claim: Claim, above: tuple[Claim, ...], settings: Settings) -> Verdict:
    """Whether enough of the domain goes to what the claim means."""
    seen = scenes.at(settings, cycles=True, basins=True)
    meant = [c for c in above if c.feature != BASIN and claim.goes_to in {"", c.called}][-1]
    goal = {m.key for m in members(scenes.program, meant, seen, settings) if m.fit is not Fit.NO}
    name = claim.goes_to or "it"
    wanted_share = claim.share or 0.0
    if not goal:
        nothing = f"{name} is not there: {_what_there_is(seen)}"
        return Verdict(Outcome.FAILS, nothing, ())
    if seen.basins is None:
        nothing = f"nothing attracts; {_what_there_is(seen)}"
        return Verdict(Outcome.FAILS, nothing, ())
    basins = seen.basins
    share = sum(a.share for a in basins.attractors if (a.is_cycle, a.index) in goal)
    reached = [k for k, a in enumerate(basins.attractors) if (a.is_cycle, a.index) in goal]
    room = share_within(np.isin(basins.labels, reached))
    sentence = f"{share_words(share, room)} of the domain goes to {name}"
    if wanted_share <= share - room or (wanted_share == 1.0 and share == 1.0):
        return Verdict(Outcome.HOLDS, sentence, ())
    failing = share + basins.open + room < wanted_share
    sentence += f", less than {100.0 * wanted_share:g} %" if failing else ", too close to tell"
    if basins.leaves >= 0.001:
        sentence += f"; {share_words(basins.leaves, basins.leaves_within)} leaves the domain"
    rest = [a for a in basins.attractors if (a.is_cycle, a.index) not in goal and a.share >= 0.001]
    for attractor in rest[:2]:
        where = (
            described_cycle(seen.axes, seen.cycles[attractor.index])
            if attractor.is_cycle
            else described_point(seen.axes, seen.fixed_points[attractor.index])
        )
        sentence += f"; {share_words(attractor.share, attractor.within)} goes to the {where}"
    outcome = Outcome.FAILS if failing else Outcome.OPEN
    return Verdict(outcome, sentence, _elsewhere(seen, goal))


def _elsewhere(seen: Portrait, goal: set[tuple[bool, int]]) -> Settings:
    """A place that does not go there."""
    basins = seen.basins
    assert basins is not None, "somebody looked for basins"
    reached = [k for k, a in enumerate(basins.attractors) if (a.is_cycle, a.index) in goal]
    elsewhere = np.argwhere(~np.isin(basins.labels, reached))
    if not len(elsewhere):
        return ()
    cell = elsewhere[len(elsewhere) // 2]
    return tuple(
        (axis.name, float(centres[i]))
        for axis, centres, i in zip(seen.axes, basins.centres, cell, strict=True)
    )


def _wanted(claim: Claim) -> str:
    """How many a claim asks for: `expected exactly 1`."""
    if claim.most is None:
        return f"expected at least {claim.least}"
    if claim.least == claim.most:
        return f"expected {'none' if claim.most == 0 else f'exactly {claim.most}'}"
    return f"expected at most {claim.most}"


def _so_many(claim: Claim, count: int) -> str:
    """A number of features: `2 other saddles`."""
    other = "other " if claim.other else ""
    return f"{count or 'no'} {other}{plural(claim.feature, count or 1)}"
