"""Runs of section 4.4: one experiment, one seed, all that went on in it, kept in a file."""

import time
from collections.abc import Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Final, final

import numpy as np

from lcs.alcsr.config import Config
from lcs.alcsr.learner import ALCSR
from lcs.alcsr.readings import RangeIs
from lcs.arrays import Integers
from lcs.course import Course
from lcs.curves import Curve, curve_of
from lcs.problems.classes import SKEWED, Classes, multiplexer

FRESH: Final = 10_000
"""Problems that nobody has seen, at the end."""

STEP: Final = 10_000
"""Cycles after which a run looks whether it has too many rules."""

MOST: Final = 12_000
"""Rules at which a run is given up: each cycle looks at all of them."""


@final
@dataclass(frozen=True, slots=True)
class Wanted:
    """A run to be made: experiment 1 or 2 of section 4.4."""

    name: str
    experiment: int
    seed: int
    config: Config
    cycles: int = 300_000


@final
@dataclass(frozen=True, eq=False, slots=True)
class Run:
    """What went on: the course of its T cycles, and the right action of each, right (T,).

    fresh: of `FRESH` problems never seen, how many it got right; an input that some action has no
    rule for counts as wrong. seconds: of one processor.
    """

    name: str
    experiment: int
    seed: int
    course: Course
    right: Integers
    fresh: int
    seconds: float

    @property
    def curve(self) -> Curve:
        """What its tests showed."""
        return curve_of(self.course, self.right)


def problem(experiment: int) -> Classes:
    """The real 6-multiplexer; in experiment 2 its thresholds are 0.25 and 0.75 in turn."""
    return multiplexer(2) if experiment == 1 else multiplexer(2, SKEWED)


def made(wanted: Wanted) -> Run:
    """Run it, until it has too many rules."""
    task = problem(wanted.experiment)
    x, rewards, right = task.drawn(wanted.cycles, np.random.default_rng([wanted.seed, 1]))
    is_declared = wanted.config.readings.range_is is RangeIs.DECLARED
    low, high = (0.0, 1.0) if is_declared else (None, None)
    learner = ALCSR(task.classes, task.inputs, wanted.config, low=low, high=high, seed=wanted.seed)
    begun = time.process_time()
    parts = []
    for at in range(0, wanted.cycles, STEP):
        parts.append(learner.run(x[at : at + STEP], rewards[at : at + STEP]))
        if parts[-1].rules[-1] > MOST:
            break
    seconds = time.process_time() - begun
    course = Course(
        *(np.concatenate([getattr(part, each.name) for part in parts]) for each in fields(Course))
    )
    fresh, _, answers = task.drawn(FRESH, np.random.default_rng([wanted.seed, 2]))
    found = int(np.sum(learner.decide(fresh)[0] == answers))
    done = right[: len(course.kind)]
    return Run(wanted.name, wanted.experiment, wanted.seed, course, done, found, seconds)


def all_made(wanted: Iterable[Wanted], at_once: int, folder: Path | None) -> Iterator[Run]:
    """Each run as soon as it is done, so many at once; kept in a folder, and found there again."""
    known, missing = [], []
    for each in wanted:
        path = None if folder is None else _path(folder, each)
        (known if path is not None and path.exists() else missing).append(each)
    for each in known:
        assert folder is not None
        yield read(_path(folder, each))
    with ProcessPoolExecutor(at_once) as pool:
        for each, run in zip(missing, pool.map(made, missing), strict=True):
            if folder is not None:
                write(run, _path(folder, each))
            yield run


def _path(folder: Path, wanted: Wanted) -> Path:
    name = f"{wanted.name}_{wanted.experiment}_{wanted.seed}_{wanted.cycles // 1000}k.npz"
    return folder / name.replace(" ", "_").replace("/", "_")


def write(run: Run, path: Path) -> None:
    """Keep a run."""
    path.parent.mkdir(parents=True, exist_ok=True)
    course = run.course
    np.savez_compressed(
        path,
        about=np.array([run.name]),
        numbers=np.array([run.experiment, run.seed, run.fresh, run.seconds]),
        kind=course.kind.astype(np.int8),
        action=course.action.astype(np.int8),
        right=run.right.astype(np.int8),
        error=course.error,
        rules=course.rules.astype(np.int32),
        births=course.births.astype(np.int32),
        deaths=course.deaths.astype(np.int32),
    )


def read(path: Path) -> Run:
    """A run that was kept."""
    with np.load(path) as kept:
        experiment, seed, fresh, seconds = kept["numbers"].tolist()
        course = Course(
            *(
                kept[each.name].astype(np.float64 if each.name == "error" else np.int64)
                for each in fields(Course)
            )
        )
        right = kept["right"].astype(np.int64)
        name = str(kept["about"][0])
    return Run(name, int(experiment), int(seed), course, right, int(fresh), seconds)
