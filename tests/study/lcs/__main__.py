"""The learners of `lcs/` beside what the thesis and others state; see docs/alcsr.md.

Run it: `python -m tests.study.lcs experiments [--out FOLDER] [--at-once N]`, or another name of
`STUDIES`; a run that is found in the folder is not made again.
"""

import argparse
from collections.abc import Callable
from pathlib import Path
from typing import Final

from tests.study.lcs import beyond, experiments, idle, pictures, readings

STUDIES: Final[dict[str, Callable[[Path, int], None]]] = {
    "experiments": experiments.tell,
    "figures": pictures.draw,
    "readings": readings.tell,
    "nearest": readings.tell_nearest,
    "idle": idle.tell,
    "beyond": beyond.tell,
    "switches": beyond.tell_switches,
    "numbers": beyond.tell_numbers,
}


def main() -> None:
    """Print what is asked for."""
    parser = argparse.ArgumentParser()
    parser.add_argument("study", choices=STUDIES)
    parser.add_argument("--out", type=Path, default=Path("build/lcs"))
    parser.add_argument("--at-once", type=int, default=2)
    given = parser.parse_args()
    STUDIES[given.study](given.out, given.at_once)


if __name__ == "__main__":
    main()
