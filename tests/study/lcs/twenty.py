"""The real 20-multiplexer beside xcsf: `python -m tests.study.lcs.twenty`.

Both are told one reward of each input, of an action at random, and are asked fresh problems at
each place; an input that some action has no rule for counts as wrong. Five of the 20 inputs decide
in a rule. An interval of xcsf is covered with each end up to `WIDE` ranges away, so that half of
its inputs are free; with 0.5, as on six inputs, hardly any rule holds for a second input.
"""

import argparse
import time
from typing import Final

import numpy as np

from lcs.alcsr.config import GROWN
from lcs.problems.classes import multiplexer
from tests.bench.lcs import Contender, alcsr
from tests.bench.lcs_peer import OneByOne
from tests.study.lcs.tables import row

PLACES: Final = (5_000, 10_000, 20_000, 50_000, 100_000, 200_000, 300_000)
TASK: Final = multiplexer(4)
FRESH: Final = 20_000
EACH: Final = 1_000
WIDE: Final = 2.0


def made(name: str, seed: int, most: int) -> Contender:
    """A learner that knows nothing yet."""
    if name == "xcsf":
        return OneByOne(TASK.inputs, TASK.classes, seed, most, WIDE)
    return alcsr(GROWN, inputs=TASK.inputs)(seed)


def tell(name: str, seed: int, until: int, most: int) -> None:
    """Print a row for each place."""
    chance = np.random.default_rng([seed, 1])
    fresh, _, asked = TASK.drawn(FRESH, np.random.default_rng([seed, 2]))
    who, seconds, done = made(name, seed, most), 0.0, 0
    for place in [each for each in PLACES if each <= until]:
        while done < place:
            x, rewards, _ = TASK.drawn(EACH, chance)
            actions = chance.integers(0, TASK.classes, EACH)
            begun = time.process_time()
            who.learn(x, rewards, actions)
            seconds += time.process_time() - begun
            done += EACH
        said = who.decide(fresh)
        cells = 100.0 * np.mean(said == asked), 100.0 * np.mean(said < 0)
        shares = [f"{each:.2f}" for each in cells]
        print(row([name, f"{place:,}", *shares, f"{who.rules():,}", f"{seconds:.0f}"]), flush=True)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--who", nargs="+", choices=("ALCSR", "xcsf"), default=["ALCSR", "xcsf"])
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--until", type=int, default=PLACES[-1])
    parser.add_argument("--most", type=int, default=4_000, help="N of xcsf")
    given = parser.parse_args()
    print(row(["who", "tries", "right, %", "undecided, %", "rules", "CPU s"]))
    print(row(["---"] * 6))
    for name in given.who:
        tell(name, given.seed, given.until, given.most)


if __name__ == "__main__":
    main()
