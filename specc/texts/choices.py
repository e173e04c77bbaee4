"""How much of a recording each choice had, and which rules made it."""

from dataclasses import dataclass
from typing import Any, final

from specc.explaining import Explained
from specc.texts.arbiter_portraits import choice_name
from specc.texts.arbiters import word_of
from verifier.deciding.stretches import Stretch
from verifier.report.layout import INDENT, table
from verifier.report.wording import percents


@final
@dataclass(frozen=True, slots=True)
class Share:
    """Of one choice: its part of all decisions, the stretches that it had, the rules behind it.

    rules: numbers of those that decide so by the spec, where the robot agreed.
    """

    choice: str
    part: float
    stretches: int
    rules: tuple[int, ...]


def shares_of(found: Explained) -> list[Share]:
    """Of each choice that the robot made in these stretches, that with most decisions first."""
    total = sum(each.decisions for each in found.stretches)
    by_choice: dict[int, list[Stretch]] = {}
    for stretch in found.stretches:
        by_choice.setdefault(stretch.chosen, []).append(stretch)
    shares = [
        Share(
            choice_name(found.arbiter, chosen),
            sum(each.decisions for each in alike) / total,
            len(alike),
            tuple(sorted({each.place + 1 for each in alike if each.agrees and each.place >= 0})),
        )
        for chosen, alike in by_choice.items()
    ]
    return sorted(shares, key=lambda share: -share.part)


def shares_text(found: Explained) -> str:
    """A line for each choice, below a title."""
    shares = shares_of(found)
    rows = [("choice", "decisions", "stretches", f"by {word_of(found.arbiter)}")]
    for each, part in zip(shares, percents([each.part for each in shares]), strict=True):
        by = ", ".join(map(str, each.rules))
        rows.append((each.choice, part, f"{each.stretches:,}", by))
    is_by_rules = any(each.rules for each in shares)
    return table(rows if is_by_rules else [row[:-1] for row in rows], INDENT)


def shares_record(found: Explained) -> list[dict[str, Any]]:
    """The same for programs."""
    return [
        {
            "choice": each.choice,
            "share": each.part,
            "stretches": each.stretches,
            "rules": list(each.rules),
        }
        for each in shares_of(found)
    ]
