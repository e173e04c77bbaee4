"""What can be told of a spec without tabulating it and without running anything of the author's."""

from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final, final

from compiler.check_behavior import Checked, check_behavior
from spec_schema.behavior import BehaviorSpec
from spec_schema.diagnostics import Diagnostic, Severity, SpecError
from spec_schema.load import Examined, examine
from spec_schema.source import Span

if TYPE_CHECKING:
    from compiler.check_kinds import Wired

__all__ = ["Checked", "CheckedFile", "check", "check_behavior", "check_examined", "check_file"]

BY_DOMAINS: Final = ("S25", "S26")
"""Modes and sketches: what is told of them may follow from the domain of a variable."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class CheckedFile:
    """What is told of a file; made: what it is, of a sound architecture, scenario or arbiter."""

    diagnostics: tuple[Diagnostic, ...]
    made: "Wired | None" = None


def check(path: Path | str) -> tuple[Diagnostic, ...]:
    """Every mistake in the spec at `path`, and every doubt."""
    return check_file(path).diagnostics


def check_file(path: Path | str) -> CheckedFile:
    """The same, and what an architecture, a scenario or an arbiter is."""
    try:
        return _checked(examine(Path(path)))
    except SpecError as error:
        return CheckedFile(error.diagnostics)


def check_examined(examined: Examined) -> tuple[Diagnostic, ...]:
    """The mistakes in the spec's shape, and what the passes say of the rest of it."""
    return _checked(examined).diagnostics


def _checked(examined: Examined) -> CheckedFile:
    loaded = examined.loaded
    made: Wired | None = None
    if loaded is None:
        return CheckedFile(examined.mistakes)
    if isinstance(loaded.spec, BehaviorSpec):
        found = check_behavior(loaded, loaded.spec).findings.diagnostics
    else:
        # Jacobians and graphs take half a second to load; a behavior's check does without them.
        from compiler.check_kinds import check_kind  # noqa: PLC0415

        found, made = check_kind(loaded)
    told = {mistake.span for mistake in examined.mistakes}
    news = (d for d in found if _is_news(d, examined.lost, told))
    return CheckedFile((*examined.mistakes, *news), None if examined.mistakes else made)


def _is_news(found: Diagnostic, lost: Collection[str], told: Collection[Span | None]) -> bool:
    """Whether a finding is no mere consequence of a mistake that is told already.

    Warnings wait until the mistakes are mended.
    """
    if told and found.severity is Severity.WARNING:
        return False
    if lost and found.code.startswith(BY_DOMAINS):
        return False
    return found.span not in told and not any(f"'{name}'" in found.message for name in lost)
