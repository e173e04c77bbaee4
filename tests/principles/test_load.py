"""Principles 1f and 2c to 2g at once: the same run in processes of unlike load, to the last bit.

Two fresh processes run one scenario: one is left alone, with one thread; beside the other a
processor is kept busy, its nodes and its module take random real times, it has four threads and
hashes its sets otherwise. `make study-principles` does the same for an hour, beside more.
"""

import os
import subprocess
import sys
from functools import cache
from pathlib import Path
from typing import NamedTuple

from tests.principles.loads import busy_processors

ROOT = Path(__file__).parents[2]
SECONDS = 1.0
PONDERS = 5e-4
"""Seconds of real time that whatever happens may hold the loaded process up."""


class Told(NamedTuple):
    """burnt: real seconds held up. recording: its digest. hashes: of the state at every step."""

    burnt: float
    recording: str
    hashes: tuple[str, ...]


def told(seconds: float, ponders: float, threads: int, recorded: float) -> Told:
    """What a fresh process tells; so many seconds of it are recorded."""
    several = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "NUMBA_NUM_THREADS")
    environment = {
        **os.environ,
        **dict.fromkeys(several, str(threads)),
        "PYTHONHASHSEED": str(threads),
    }
    command = [sys.executable, "-m", "tests.principles.telling"]
    command += [str(seconds), str(ponders), str(recorded)]
    ran = subprocess.run(
        command, capture_output=True, text=True, check=True, cwd=ROOT, env=environment
    )
    burnt, recording, *hashes = ran.stdout.split()
    return Told(float(burnt), recording, tuple(hashes))


@cache
def both() -> tuple[Told, Told]:
    """Left alone, and under load."""
    alone = told(SECONDS, 0.0, 1, SECONDS)
    with busy_processors(1):
        return alone, told(SECONDS, PONDERS, 4, SECONDS)


def unequal(alone: Told, laden: Told) -> int:
    """Steps at which the states differ."""
    assert len(alone.hashes) == len(laden.hashes)
    return sum(one != other for one, other in zip(alone.hashes, laden.hashes, strict=True))


def test_the_state_is_the_same_at_every_step_whatever_the_processors_have_to_do() -> None:
    """1f, 2c to 2g: no time that a computer takes is in it; it would differ from then on."""
    alone, laden = both()

    assert alone.burnt == 0.0
    assert laden.burnt > 0.05
    assert len(set(alone.hashes)) == len(alone.hashes) == round(240 * SECONDS) + 1
    assert unequal(alone, laden) == 0


def test_the_recordings_are_the_same_byte_by_byte() -> None:
    """1g, 2c to 2g: what is seen of the run and what is judged is the same, too."""
    alone, laden = both()

    assert alone.recording == laden.recording
