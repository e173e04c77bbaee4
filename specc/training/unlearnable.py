"""Why nothing can be learnt from what was lived, as a diagnostic."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Final

from lcs.faults import LearnerError
from runtime.scenario import Scenario
from specc.faults import fault
from specc.training.episode import Episode, training_of

FINITE: Final = "let the reward, and each reading, be a number everywhere: divide by nothing that \
can be 0, and bound what can grow without end"

BEGINS: Final = "let `ends_when` be false where a run begins"
SOON: Final = 2.5
"""Steps of the world: the first after a decision is the second."""


@contextmanager
def told_unlearnable(scenario: Scenario) -> Iterator[None]:
    """Within it a reading or a reward that is not finite is told.

    Raises:
        SpecError: there was one (V416).
    """
    try:
        yield
    except LearnerError as error:
        message = f"{training_of(scenario).arbiter} can't learn from this: {error}"
        raise fault("V416", scenario.source.file, message, FINITE) from error


def refuse_decided(scenario: Scenario, episodes: Sequence[Episode]) -> None:
    """Stop where all episodes are over before a choice can have effect.

    Raises:
        SpecError: they are (V418).
    """
    soon = SOON * scenario.step
    if all(each.steps.ends[-1:].all() and each.seconds <= soon for each in episodes):
        message = f"each of {len(episodes)} episodes was over as it began"
        raise fault("V418", scenario.source.file, message, BEGINS)
