"""Draws the pictures of docs/paradigms.md: the ways of robots, and how they are wired."""
# ruff: noqa: INP001  a script, no part of a package

import sys
from pathlib import Path
from typing import Final

from specc.cli import main

IMG: Final = Path(__file__).parent / "img"
SPECS: Final = Path(__file__).parents[1] / "specs"
WAYS: Final = ("subsumption", "hierarchy", "dynamics")
SEEN: Final = {"light": ("2001", "40 s"), "tidy": ("2000", "50 s"), "patrol": ("2001", "200 s")}
"""A world of each task, its seed, and how much of the run is drawn."""


def draw(task: str) -> None:
    """Draw what each paradigm did in one world, and its wiring."""
    seed, duration = SEEN[task]
    for way in WAYS:
        name, drawn = f"{task}_{way}", f"paradigm_{task}_{way}"
        scenario = SPECS / "scenarios" / f"{name}.yaml"
        picture = ["--poster", str(IMG / f"{drawn}.svg")]
        main(["simulate", str(scenario), "--seed", seed, "-d", duration, *picture])
        architecture = SPECS / "architectures" / f"{name}.yaml"
        main(["wiring", str(architecture), "-o", str(IMG / f"{drawn}_wiring.svg")])


if __name__ == "__main__":
    for each in sys.argv[1:] or SEEN:
        draw(each)
