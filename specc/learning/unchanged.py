"""Whether the table that an experiment learns from is still the one that it was begun with."""

import dataclasses
from hashlib import sha256
from pathlib import Path

from specc.faults import fault
from specc.learning.experiment import Experiment, is_table


def with_digest(experiment: Experiment) -> Experiment:
    """The experiment with the digest of its table; as it is where it learns from none.

    Raises:
        OSError: the table can't be read.
    """
    if not is_table(experiment.problem):
        return experiment
    return dataclasses.replace(experiment, digest=_digest(Path(experiment.problem)))


def refuse_changed(experiment: Experiment) -> None:
    """Refuse to go on with another table: what was learnt from the first would be mixed with it.

    Raises:
        SpecError: the table is another one (V406).
        OSError: it can't be read.
    """
    if not experiment.digest or _digest(Path(experiment.problem)) == experiment.digest:
        return
    message = "the table has changed since the experiment was begun"
    remedy = "put the first table back; or begin again in another folder"
    raise fault("V406", experiment.problem, message, remedy)


def _digest(path: Path) -> str:
    """Of what is in the file, byte for byte."""
    return sha256(path.read_bytes()).hexdigest()
