"""Why a decision is what it is: who voted, with what share, how sure, and what came next."""

import dataclasses
import math
from dataclasses import dataclass
from typing import Final, final

import numpy as np
import numpy.typing as npt

from lcs.rules.confidence import Confidence, confidence
from lcs.rules.deciding import checked, decide, matches
from lcs.rules.names import Names
from lcs.rules.parts import rules_of
from lcs.rules.readable import readable
from lcs.rules.table import RuleTable
from lcs.rules.words import Sentence, reward_text, sentence

SPOKEN: Final = 3
"""Voters of which a reason says all; the others are counted."""


@final
@dataclass(frozen=True, slots=True)
class Voter:
    """A rule that voted on the action that was decided for; share: of the votes on it."""

    sentence: Sentence
    share: float
    prediction: float
    confidence: Confidence


@final
@dataclass(frozen=True, slots=True)
class Reason:
    """Why an action is the best on one input; action is None where some action is unknown.

    expected: its reward. agreed: the share of the votes on it that expect what most of the vote
    does. voters: the heaviest first. following: the next best action and its expected reward, None
    of one action. unknown: actions of which no rule holds.
    """

    action: str | None
    expected: float
    agreed: float
    voters: tuple[Voter, ...]
    following: tuple[str, float] | None
    unknown: tuple[str, ...]

    def __str__(self) -> str:
        if self.action is None:
            return f"no decision: no rule says what {' or '.join(self.unknown)} would earn here"
        said = "; ".join(_said(voter) for voter in self.voters[:SPOKEN])
        text = f"{self.action}, with {_percent(self.agreed)} of its vote: {said}"
        silent = self.voters[SPOKEN:]
        if silent:
            text += f"; and {len(silent)} more with {_percent(sum(v.share for v in silent))}"
        if self.following is None:
            return text
        other, reward = self.following
        expected, ours = reward_text(reward), reward_text(self.expected)
        return f"{text}; next: {other} ({expected} expected, not {ours})"


def reason_for(table: RuleTable, x: npt.ArrayLike, names: Names) -> Reason:
    """The reason of the decision on one input (n,).

    Raises:
        LearnerError: not n finite numbers.
    """
    given = checked(table, np.asarray(x, np.float64)[None])
    said = decide(table, given)
    expected, best = said.expected[0], int(said.best[0])
    if best < 0:
        unknown = tuple(names.actions[a] for a in np.flatnonzero(np.isnan(expected)))
        return Reason(None, float("nan"), 0.0, (), None, unknown)
    those = np.flatnonzero(matches(table, given)[:, 0] & (table.action == best))
    share = table.weight[those] / table.weight[those].sum()
    levels_of = np.unique(table.prediction)
    short = readable(rules_of(table, those))
    levels, level = np.unique(table.prediction[those], return_inverse=True)
    agreed = np.bincount(level, share, len(levels)).max()
    order = np.argsort(-share, kind="stable")
    voters = tuple(
        Voter(
            dataclasses.replace(sentence(short, int(k), names, levels_of), rule=int(those[k])),
            float(share[k]),
            float(short.prediction[k]),
            confidence(int(short.right[k]), int(short.wrong[k])),
        )
        for k in order
    )
    return Reason(
        names.actions[best],
        float(expected[best]),
        float(agreed),
        voters,
        _following(expected.tolist(), best, names),
        (),
    )


def _following(expected: list[float], best: int, names: Names) -> tuple[str, float] | None:
    others = [a for a in range(len(expected)) if a != best]
    if not others:
        return None
    other = max(others, key=lambda a: (expected[a], -a))
    return names.actions[other], expected[other]


def _said(voter: Voter) -> str:
    """A voter's sentence with its share, and how often it will be right at least."""
    said, sure = voter.sentence, voter.confidence
    least = f", 95 % confidence: in {math.floor(1000.0 * sure.low) / 10.0:g} % or more"
    known = f"{said.evidence}{least if sure.cases > 1 else ''}"
    return f"{_percent(voter.share)} {said.when}: {said.then} ({known})"


def _percent(share: float) -> str:
    """A share in percent, never rounded to 0 or to all of it."""
    if 0.0 < share < 0.01:
        return "under 1 %"
    if 0.99 < share < 1.0:
        return "over 99 %"
    return f"{100.0 * share:.0f} %"
