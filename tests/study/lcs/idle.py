"""How many rules of a final population hardly take part, as section 4.5 of the thesis asks."""

from pathlib import Path

import numpy as np

from lcs.alcsr.config import Config
from lcs.alcsr.learner import ALCSR
from lcs.arrays import Array, Integers
from tests.study.lcs.runs import problem
from tests.study.lcs.tables import percent, row


def tell(_: Path, __: int) -> None:
    """Print the shares of idle and of tiny rules after experiment 1, for two sprout widths."""
    print(row(["sprout width", "rules", "never fed", "fed less than 10 times", "volume < 1/1,000"]))
    print(row(["---"] * 5))
    for width in (1.0, 1.15):
        experience, volume = lived(Config(sprout_width=width), 300_000)
        shares = (experience == 0, experience < 10, volume < 1e-3)
        told = [percent(float(np.mean(each))) for each in shares]
        print(row([f"{width}", f"{len(volume):,}", *told]), flush=True)


def lived(config: Config, cycles: int) -> tuple[Integers, Array]:
    """How often each rule was fed, and its volume, after so many cycles of experiment 1; seed 0."""
    task = problem(1)
    x, rewards, _ = task.drawn(cycles, np.random.default_rng([0, 1]))
    learner = ALCSR(task.classes, task.inputs, config, seed=0)
    learner.run(x, rewards)
    rules = learner.population.rules
    living = [(a, slice(0, int(count))) for a, count in enumerate(rules.living)]
    experience = np.concatenate([rules.experience[a, those] for a, those in living])
    return experience, np.concatenate([rules.volume[a, those] for a, those in living])
