"""Delayed rewards: gridworld and puddle world after so many episodes, beside the optimum.

Run it: `python -m tests.study.lcs.steps [seeds]`, or `make study-lcs`. At each mark the best
actions are followed from the same 970 or so starts, at most 500 steps; nothing is learnt by that.
Five seeds take some minutes.
"""

import sys
import time

import numpy as np

from lcs.arrays import Array
from lcs.problems.optimum import optimum
from lcs.problems.steps import GOAL, Plane, gridworld, puddle_world
from lcs.steps.learner import StepsLearner

MARKS = (500, 1_000, 2_500, 5_000, 10_000, 20_000)
SIDE = 32
CELLS = 100
"""Of the optimum's grid; twice as many change the third digit of the return."""


def places() -> Array:
    """The starts (E, 2), one anywhere in each cell of a grid, so that their mean is a fair one."""
    low = np.stack(np.meshgrid(np.arange(SIDE), np.arange(SIDE)), axis=-1).reshape(-1, 2)
    found = (low + np.random.default_rng(99).random(low.shape)) / SIDE
    return np.asarray(found[found.sum(axis=1) <= GOAL])


def learnt(world: Plane, starts: Array, seed: int) -> Array:
    """(K, 4) at each mark: mean steps, mean return, how many missed the goal, and bodies."""
    learner = StepsLearner(world.actions, world.inputs, seed=seed)
    outside, found = np.random.default_rng(1_000 + seed), []
    for before, mark in zip((0, *MARKS), MARKS, strict=False):
        learner.run(world, mark - before, outside)
        went = learner.follow(world, starts, np.random.default_rng(5))
        missed = int((~went.reached).sum())
        found.append((went.steps.mean(), went.returns.mean(), missed, len(learner.bodies.lower)))
    return np.array(found)


def table(world: Plane, seeds: int) -> None:
    """Print a line for each seed and quantity, after the optimum's."""
    starts = places()
    steps, returns = optimum(world, CELLS).follow(starts, np.random.default_rng(5))
    print(f"\n{world.name}: optimum {steps.mean():.2f} steps, return {returns.mean():.2f}")
    print(f"{'episodes':28s}" + "".join(f"{mark:>9,d}" for mark in MARKS), flush=True)
    every = []
    for seed in range(seeds):
        begun = time.process_time()
        every.append(learnt(world, starts, seed))
        _line(f"seed {seed}, mean steps", every[-1][:, 0], 2)
        _line("        mean return", every[-1][:, 1], 2)
        _line("        missed the goal", every[-1][:, 2], 0)
        _line("        bodies", every[-1][:, 3], 0)
        print(f"        {time.process_time() - begun:.0f} s of one core", flush=True)
    _line("all seeds, mean steps", np.mean(every, axis=0)[:, 0], 2)
    _line("           worst steps", np.max(every, axis=0)[:, 0], 2)
    _line("           mean return", np.mean(every, axis=0)[:, 1], 2)
    _line("           worst return", np.min(every, axis=0)[:, 1], 2)


def _line(name: str, values: Array, digits: int) -> None:
    print(f"{name:28s}" + "".join(f"{value:9.{digits}f}" for value in values), flush=True)


if __name__ == "__main__":
    for each in (gridworld(), puddle_world()):
        table(each, int(sys.argv[1]) if len(sys.argv) > 1 else 5)
