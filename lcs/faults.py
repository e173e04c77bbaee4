"""What a learner refuses."""

from typing import final


@final
class LearnerError(ValueError):
    """An input, a reward or a file that can't be used; the message says what to give instead."""
