"""Why nothing can be learnt from what was lived, as a diagnostic."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final

from lcs.faults import LearnerError
from runtime.scenario import Scenario
from specc.faults import fault
from specc.training.episode import training_of

FINITE: Final = "let the reward, and each reading, be a number everywhere: divide by nothing that \
can be 0, and bound what can grow without end"


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
