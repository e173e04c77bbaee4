"""The errand with learned arbiters beside the one by hand and chance, in the same held-out worlds.

Run it: `python -m tests.study.learned_errand [--out FOLDER] [--seeds 5] [--learners alcsr xcsr]`.
Each training is kept in FOLDER/LEARNER_SEED; one that is there already goes on, or is taken as it
is. Hours of processor: see how long one takes in its summary.txt.
"""

import argparse
import json
import shutil
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Final

import numpy as np

from specc.cli import main as specc
from specc.training.checkpoint import CHECKPOINT, taken_up
from specc.training.folder import RECORD, TRAINING
from tests.study.errand import SCENARIOS, WAYS, Summary, line_of, outcomes, summary

SPECS: Final = SCENARIOS.parent
LEARNED: Final = "errand_learned.yaml"
HELD_OUT: Final = range(1000, 1100)


def trained(folder: Path, learner: str, seed: int, jobs: int) -> None:
    """Train into the folder, unless that is done."""
    if (folder / RECORD).exists():
        return
    given = ["--resume"]
    if not (folder / TRAINING).exists():
        given = [str(SCENARIOS / LEARNED), "--learner", learner, "--seed", str(seed)]
        given += ["--held-out", "0"]
    assert specc(["train", *given, "-o", str(folder), "--jobs", str(jobs)]) == 0


def cost_of(folder: Path) -> str:
    """How many rules, and from how much they were learnt."""
    record = json.loads((folder / RECORD).read_text())
    course = taken_up(folder / CHECKPOINT)
    last = course.generations[-1]
    rules = record["compaction"]["rules"]
    return f"{rules} | {course.episodes:,} | {last.decisions + last.raced:,} |"


def mean_line(learner: str, every: Sequence[Summary]) -> str:
    """The means over seeds, and the range of their shares."""
    share = np.array([each.success for each in every])
    time, touched, flat, late, charged = np.mean(
        [(each.time, each.touched, each.flat, each.late, each.charged) for each in every], axis=0
    )
    return (
        f"| {learner}, mean of {len(every)} | | {share.mean():.0%} (seeds {100 * share.min():.0f} "
        f"to {share.max():.0%}) | {time:.0f} s | {touched:.0%} | {flat:.0%} | {late:.0%} "
        f"| {charged:.0%} | | | |"
    )


def lines(out: Path, learners: list[str], seeds: int, jobs: int) -> Iterator[str]:
    """The table, line by line."""
    titles = "decides", "reached", "share (95 %)", "time", "touched", "flat", "late", "charged"
    costs = "rules", "episodes", "decisions"
    yield f"| {' | '.join((*titles, *costs))} |"
    yield "|---" * len((*titles, *costs)) + "|"
    for way in WAYS:
        found = outcomes(SCENARIOS / f"errand_{way}.yaml", HELD_OUT, jobs)
        yield f"{line_of(way, summary(found))} | | |"
    for learner in learners:
        every: list[Summary] = []
        for seed in range(seeds):
            folder = out / f"{learner}_{seed}"
            trained(folder, learner, seed, jobs)
            with tempfile.TemporaryDirectory() as place:
                copy = Path(place) / "specs"
                shutil.copytree(SPECS, copy, ignore=shutil.ignore_patterns("recordings"))
                shutil.copy(folder / LEARNED, copy / "arbiters" / LEARNED)
                found = outcomes(copy / "scenarios" / LEARNED, HELD_OUT, jobs)
            every.append(summary(found))
            yield f"{line_of(f'{learner}, seed {seed}', every[-1])} {cost_of(folder)}"
        yield mean_line(learner, every)


def main() -> None:
    """Print the table as it comes."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--out", type=Path, default=Path("out/learned_errand"))
    parser.add_argument("--learners", nargs="+", default=["alcsr", "xcsr"])
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--jobs", type=int, default=2)
    given = parser.parse_args()
    for line in lines(given.out, given.learners, given.seeds, given.jobs):
        print(line, flush=True)


if __name__ == "__main__":
    main()
