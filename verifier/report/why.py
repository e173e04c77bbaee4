"""How a diagnosis is told: its title, its sentences, and the explanations in their order."""

from verifier.report.diagnosis import Candidate, Diagnosis, Told
from verifier.report.report import Standing
from verifier.report.switching import Switching


def why(diagnosis: Diagnosis, switching: Switching | None) -> tuple[str, tuple[str, ...]]:
    """Title and sentences. That nothing departs within the modes is no answer to late switches."""
    is_late = switching is not None and switching.standing is Standing.EXCEEDED
    if switching is None or not is_late or diagnosis.told is not Told.NO_DIFFERENCE:
        return str(diagnosis.told), diagnosis.sentences
    mode = switching.mode
    sentence = (
        f"while {mode} stays as it is, the robot does what the spec says: it is the changes of"
        f" {mode} that depart"
    )
    return f"the changes of {mode}", (sentence,)


def ranked(diagnosis: Diagnosis) -> list[Candidate]:
    """Those that the diagnosis names, in the order in which they were taken in; then the others."""
    return [each for each in diagnosis.candidates if each.is_taken] + untaken(diagnosis)


def untaken(diagnosis: Diagnosis) -> list[Candidate]:
    """The explanations that are not named, the one that explains most first."""
    others = [each for each in diagnosis.candidates if not each.is_taken]
    return sorted(others, key=lambda each: -each.evidence.share)
