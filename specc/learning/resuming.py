"""Checkpoints: all of a run in one file, which is whole or as it was before.

What is kept is what can't be told from the experiment: the learner with its own chance, its course,
and how long it took. A run that goes on from it gives the same bits as one that never stopped.
"""

import io
from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any, Final

import numpy as np

from lcs.saving import KINDS, as_bytes, from_bytes
from specc.faults import fault
from specc.files import write_atomically
from specc.kept import UNREADABLE
from specc.learning.courses import Answered, Walked
from specc.learning.run import Run

NARROW: Final = {
    "kind": np.int8,
    "action": np.int32,
    "rules": np.int32,
    "births": np.int32,
    "deaths": np.int32,
    "right": np.int32,
    "steps": np.int32,
    "boxes": np.int32,
}
"""How columns of a course are kept."""

OF_KINDS: Final[Mapping[str, Answered | Walked]] = {"StepsLearner": Walked.none()}
"""The course that a learner of this kind has; of all others `Answered`."""

DAMAGED: Final = "delete it, and its run begins anew"


def keep(run: Run[Any, Any], path: Path, *, is_last: bool) -> None:
    """Write the run; what was kept before is replaced in one step.

    is_last: of this run, so that it is worth the time to make the file small.

    Raises:
        SpecError: it can't be written (V347).
    """
    course = run.so_far()
    columns = {each.name: getattr(course, each.name) for each in fields(course)}
    kept: dict[str, Any] = {
        "learner": np.frombuffer(as_bytes(run.learner.state()), np.uint8),
        "seed": np.array(run.seed),
        "done": np.array(run.done),
        "seconds": np.array(run.seconds),
        **{name: each.astype(NARROW.get(name, each.dtype)) for name, each in columns.items()},
    }
    content = io.BytesIO()
    write = np.savez_compressed if is_last else np.savez
    write(content, **kept)
    write_atomically(path, content.getvalue())


def taken_up(path: Path) -> Run[Any, Any]:
    """The run that was kept there.

    Raises:
        SpecError: the file is damaged, or of another version (V404).
        OSError: it can't be read.
    """
    try:
        with np.load(io.BytesIO(path.read_bytes()), allow_pickle=False) as kept:
            state = from_bytes(kept["learner"].tobytes())
            none: Any = OF_KINDS.get(state.kind, Answered.none())
            columns = {
                each.name: kept[each.name].astype(getattr(none, each.name).dtype)
                for each in fields(none)
            }
            return Run(
                int(kept["seed"]),
                KINDS[state.kind](state),
                none,
                [type(none)(**columns)],
                int(kept["done"]),
                float(kept["seconds"]),
            )
    except UNREADABLE as error:
        raise fault("V404", path, f"this checkpoint can't be read: {error}", DAMAGED) from error
