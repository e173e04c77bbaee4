"""What is found of a claim: how it stands, how that was shown, and where it breaks. All in SI."""

from dataclasses import dataclass
from enum import StrEnum
from typing import final

from runtime.claim import Claim
from verifier.topology.branches.continuation import Change
from verifier.topology.features import Settings


@final
class Ruling(StrEnum):
    """How a claim stands."""

    HOLDS_PROVED = "proved"
    HOLDS_SAMPLED = "holds"
    REFUTED = "refuted"
    UNDECIDED = "undecided"

    @property
    def holds(self) -> bool:
        """Whether nothing speaks against the claim."""
        return self in {Ruling.HOLDS_PROVED, Ruling.HOLDS_SAMPLED}


@final
@dataclass(frozen=True, slots=True)
class Witness:
    """Where a claim breaks: the values of all controls, a place (by state) if there is one."""

    settings: Settings
    place: Settings
    what: str


@final
@dataclass(frozen=True, slots=True)
class Boundary:
    """Where on a control a claim begins or ceases to hold, the other controls at the witness's.

    The claim holds `above` the value or below it; `value` is known to `within`. change: the
    bifurcation there; about: it in words.
    """

    control: str
    value: float
    within: float
    above: bool
    change: Change
    about: str


@final
@dataclass(frozen=True, slots=True)
class Finding:
    """A claim, and what was found of it.

    sentence: the result in words. how: how it was shown. proved_share: of the domain of `over`,
    how much is covered by proof; 1 where the claim is at single values and proved.
    """

    claim: Claim
    ruling: Ruling
    sentence: str
    how: str
    proved_share: float
    witness: Witness | None
    boundaries: tuple[Boundary, ...]
