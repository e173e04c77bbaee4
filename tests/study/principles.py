"""The principles of section 2.4 of the thesis: the table, and an hour of artificial load.

Run it: `python -m tests.study.principles [--minutes 60] [--recorded 5] [--beside N]`. It prints the
rows of `docs/principles.md` with their figures, then runs the loaded scenario for so many simulated
minutes in two fresh processes (see `tests/principles/test_load.py`), compares the state hash of
every step and the bytes of a recording, and says how deep things stood in one another in a crowd
that three robots plough for as long.
"""

import argparse
import os
import time
from dataclasses import replace

from tests.principles.loads import busy_processors
from tests.principles.scenes import Started
from tests.principles.table import PRINCIPLES
from tests.principles.test_1c_occupancy import ploughed
from tests.principles.test_load import PONDERS, told, unequal


def under_load(seconds: float, recorded: float, beside: int) -> str:
    """What two processes told, in a sentence."""
    begun = time.perf_counter()
    alone = told(seconds, 0.0, 1, recorded)
    between = time.perf_counter()
    with busy_processors(beside):
        laden = told(seconds, PONDERS, 4, recorded)
    ended = time.perf_counter()
    same = "equal" if alone.recording == laden.recording else "NOT equal"
    return (
        f"{seconds / 60:g} simulated minutes, {len(alone.hashes):,} states: "
        f"{unequal(alone, laden)} hashes differ between {between - begun:.0f} s alone and "
        f"{ended - between:.0f} s beside {beside} busy processes, of which it was held up for "
        f"{laden.burnt:.0f} s at random; recordings of {recorded / 60:g} minutes are byte by byte "
        f"{same} (last hash {laden.hashes[-1]})"
    )


def deepest(seconds: float) -> str:
    """How deep things stood in one another in the crowd, by the world's own audit of every step."""
    started = Started(replace(ploughed(), duration=seconds))
    started.finish()
    audit = started.world.audit()
    return (
        f"{seconds / 60:g} minutes in the crowd: {audit.depth * 1e3:.2f} mm at the deepest "
        f"({audit.pair[0]} and {audit.pair[1]}, at {audit.time:.0f} s)"
    )


def main() -> None:
    """Print it all."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--minutes", type=float, default=60.0)
    parser.add_argument("--recorded", type=float, default=5.0)
    parser.add_argument("--beside", type=int, default=2 * (os.cpu_count() or 1))
    given = parser.parse_args()
    for principle in PRINCIPLES:
        print(f"{principle.letter}  {principle.said}\n    {principle.figure()}", flush=True)
    seconds = 60.0 * given.minutes
    print(f"1c  {deepest(seconds)}", flush=True)
    recorded = min(60.0 * given.recorded, seconds)
    print(f"1f, 2c-2g  {under_load(seconds, recorded, given.beside)}", flush=True)


if __name__ == "__main__":
    main()
