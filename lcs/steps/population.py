"""What the land and its bodies are at first, and as they were saved."""

import numpy as np

from lcs.faults import LearnerError
from lcs.state import Arrays, filled
from lcs.steps.kernels.layout import Bodies, Land


def empty_land(memories: int, inputs: int) -> Land:
    """A land that remembers nothing yet, with room for so many memories."""
    return Land(
        x=np.zeros((memories, inputs)),
        action=np.zeros(memories, np.int64),
        reward=np.zeros(memories),
        after=np.zeros((memories, inputs)),
        ends=np.zeros(memories, np.bool_),
        seen=np.zeros(1, np.int64),
    )


def one_body(actions: int, inputs: int) -> Bodies:
    """One body that holds everything and has eaten nothing."""
    return Bodies(
        lower=np.full((1, inputs), -np.inf),
        upper=np.full((1, inputs), np.inf),
        meals=np.zeros((1, actions), np.int64),
        expected=np.zeros((1, actions)),
        first=np.array([0, 1]),
    )


def restored_land(template: Land, actions: int, arrays: Arrays) -> Land:
    """The land that was saved; it has the room of the template.

    Raises:
        LearnerError: an array is missing, does not fit, or holds what no land does.
    """
    found = filled("land", template, arrays)
    if any(one.shape != other.shape for one, other in zip(found, template, strict=True)):
        raise LearnerError("'land' has not the room that its config says")
    if found.seen[0] < 0 or np.any((found.action < 0) | (found.action >= actions)):
        raise LearnerError("'land' remembers an action that there is not")
    if not all(np.isfinite(each).all() for each in (found.x, found.after, found.reward)):
        raise LearnerError("'land' remembers a number that is not finite")
    return found


def restored_bodies(template: Bodies, arrays: Arrays) -> Bodies:
    """The bodies that were saved; of as many inputs and actions as the template's.

    Raises:
        LearnerError: an array is missing, does not fit, or holds what no bodies do.
    """
    found = filled("bodies", template, arrays)
    count = len(found.lower)
    for given, like in ((found.lower, template.lower), (found.meals, template.meals)):
        if given.shape != (count, like.shape[1]):
            raise LearnerError(f"'bodies' are {count}, and have an array of shape {given.shape}")
    first = found.first
    if first[0] != 0 or first[-1] != count or np.any(np.diff(first) < 1):
        raise LearnerError("'bodies.first' does not tell where families begin")
    return found
