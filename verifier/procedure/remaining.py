"""Which runs of a test procedure are still to be driven, where a part was recorded already."""

import numpy as np

from verifier.procedure.model import Procedure
from verifier.report.report import Coverage

MOSTLY = 0.5
"""A run of whose cells recordings went through this share is driven already."""


def remaining_runs(procedure: Procedure, seen: Coverage | None) -> tuple[int, ...]:
    """The numbers, from 0, of the runs that go where no recording has been.

    seen: what recordings cover, all together; None where there are none. Where the spec demands a
    share of a region, each run that goes through a cell that was not seen counts, until that share
    would be reached; else runs most of whose cells were not seen.
    """
    if seen is None or not procedure.drives:
        return tuple(range(len(procedure.drives)))
    have = (seen.samples >= seen.enough).ravel()
    if any(cell >= have.size for drive in procedure.drives for cell in drive.cells):
        return tuple(range(len(procedure.drives)))
    if procedure.required == 0.0:
        return tuple(
            place
            for place, drive in enumerate(procedure.drives)
            if drive.cells and np.mean(have[list(drive.cells)]) < MOSTLY
        )
    found: list[int] = []
    while float(np.mean(have)) < procedure.required:
        new = [int(np.sum(~have[list(drive.cells)])) for drive in procedure.drives]
        best = int(np.argmax(new))
        if not new[best]:
            break
        found.append(best)
        have[list(procedure.drives[best].cells)] = True
    return tuple(sorted(found))
