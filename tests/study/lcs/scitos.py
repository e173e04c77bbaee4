"""A real robot's arbiter, learnt by reward, beside a decision tree and xcsf.

`python -m tests.study.lcs.scitos` prints the accuracy on 2, 4 and 24 inputs, and the rules that
were found on 2. Three laps are learnt from and the other is tested on: rows in order of time, in
four parts; the last part is the fourth lap. A tree is told the action that the robot took. The
others try an action at random and are told 1000 or -1000, `--cycles` times.
"""

import argparse
import dataclasses
from collections.abc import Iterator, Sequence
from typing import Final, Protocol, TypeAlias, final

import numpy as np
from sklearn.tree import DecisionTreeClassifier

from lcs.alcsr.config import GROWN
from lcs.alcsr.learner import ALCSR
from lcs.arrays import Integers
from lcs.problems.scitos import scitos
from lcs.problems.table import Table, in_folds
from lcs.rules.compaction import compact
from lcs.rules.deciding import decide
from lcs.rules.experience import remembered
from lcs.rules.names import Names
from lcs.rules.table import RuleTable
from lcs.rules.words import in_words
from lcs.xcsr.config import Bounds, Config, Selection
from lcs.xcsr.learner import XCSR

CYCLES: Final = 50_000
LAPS: Final = 4
PEER: Final = Config(bounds=Bounds.UNORDERED, selection=Selection.TOURNAMENT, explore=1.0)
REMEMBERED: Final = 10_000
"""Of the last cycles, what compaction goes by."""

Score: TypeAlias = tuple[float, float, int]
"""The shares of rows that were decided right and that were not decided, and how many rules (or
leaves) there were."""


class Study(Protocol):
    """A table, to learn from with so many cycles, and a seed."""

    def __call__(self, table: Table, cycles: int, seed: int) -> dict[str, Score]: ...


def score(actions: Integers, table: Table, rules: int) -> Score:
    """Of the rows to test on; where some action has no rule, none is taken, and that is wrong."""
    right = actions == table.right[table.tested]
    return float(np.mean(right)), float(np.mean(actions < 0)), rules


def tree(table: Table, cycles: int, seed: int) -> dict[str, Score]:  # noqa: ARG001
    """scikit-learn's tree, told every label."""
    found = DecisionTreeClassifier(random_state=seed)
    found.fit(table.x[table.learnt], table.right[table.learnt])
    leaves = int(found.get_n_leaves())
    return {"decision tree": score(found.predict(table.x[table.tested]), table, leaves)}


def alcsr(table: Table, cycles: int, seed: int) -> dict[str, Score]:
    """Ours, and its rules after compaction."""
    learner, few = grown(table, cycles, seed)
    tested = table.x[table.tested]
    return {
        "ALCSR": score(learner.decide(tested)[0], table, len(learner.rules())),
        "ALCSR, compacted": score(decide(few, tested).best, table, len(few)),
    }


def grown(table: Table, cycles: int, seed: int) -> tuple[ALCSR, RuleTable]:
    """A learner that tried so many actions, and few rules that say the same of the last ones."""
    config = dataclasses.replace(GROWN, explore=1.0)
    learner = ALCSR(table.classes, table.inputs, config, seed=seed)
    x, rewards, _ = table.drawn(cycles, np.random.default_rng([seed, 1]))
    action = learner.run(x, rewards).action
    last = np.arange(max(0, cycles - REMEMBERED), cycles)
    seen = remembered(x[last], action[last], rewards[last, action[last]], table.classes)
    return learner, compact(learner.rules(), seen).table


def xcsr(table: Table, cycles: int, seed: int) -> dict[str, Score]:
    """XCSR with the settings of xcsf."""
    low, high = table.x.min(axis=0), table.x.max(axis=0)
    learner = XCSR(table.classes, table.inputs, PEER, low=low, high=high, seed=seed)
    x, rewards, _ = table.drawn(cycles, np.random.default_rng([seed, 1]))
    learner.run(x, rewards)
    actions, _ = learner.decide(table.x[table.tested])
    return {"XCSR": score(actions, table, len(learner.rules()))}


def peer(table: Table, cycles: int, seed: int) -> dict[str, Score]:
    """xcsf, of inputs from 0 to 1."""
    from tests.bench.lcs_peer import OneByOne

    low, high = table.x.min(axis=0), table.x.max(axis=0)
    learner = OneByOne(table.inputs, table.classes, seed)
    chance = np.random.default_rng([seed, 1])
    x, rewards, _ = table.drawn(cycles, chance)
    learner.learn((x - low) / (high - low), rewards, chance.integers(0, table.classes, cycles))
    actions = learner.decide((table.x[table.tested] - low) / (high - low))
    return {"xcsf": score(actions, table, learner.rules())}


STUDIES: Final[dict[str, Study]] = {"tree": tree, "alcsr": alcsr, "xcsr": xcsr, "xcsf": peer}


def measured(count: int, laps: Sequence[int], given: "Given") -> dict[str, list[Score]]:
    """What each reaches with so many inputs, tested on each of these laps."""
    found: dict[str, list[Score]] = {}
    for lap in laps:
        table = in_folds(scitos(count), LAPS, lap)
        for name in given.who:
            for who, each in STUDIES[name](table, given.cycles, lap).items():
                found.setdefault(who, []).append(each)
    return found


def lines_of(count: int, found: dict[str, list[Score]]) -> Iterator[str]:
    """Rows of the table."""
    for who, scores in found.items():
        right, undecided, rules = np.array(scores).T
        each = " ".join(f"{100.0 * share:6.2f}" for share in right)
        yield (
            f"| {count:2} | {who:16} | {100.0 * right[-1]:6.2f} | {100.0 * right.mean():6.2f} "
            f"| {each} | {100.0 * undecided.mean():5.2f} | {rules.mean():5.0f} |"
        )


def said(cycles: int) -> Iterator[str]:
    """The rules on 2 inputs that choose an action, in words."""
    table = in_folds(scitos(2), LAPS, LAPS)
    _, few = grown(table, cycles, LAPS)
    for each in in_words(few, Names(table.described, table.labels), table.x[table.learnt]):
        if not each.then.startswith("not "):
            yield str(each)


@final
@dataclasses.dataclass(frozen=True, slots=True)
class Given:
    """What is asked for on the command line."""

    who: tuple[str, ...]
    cycles: int


def main() -> None:
    """Print the table, and the rules."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--inputs", type=int, nargs="+", default=[2, 4, 24])
    parser.add_argument("--laps", type=int, nargs="+", default=[1, 2, 3, 4])
    parser.add_argument("--who", nargs="+", choices=STUDIES, default=list(STUDIES))
    parser.add_argument("--cycles", type=int, default=CYCLES)
    asked = parser.parse_args()
    given = Given(tuple(asked.who), asked.cycles)
    print("| inputs | who | last lap, % right | mean of laps | each lap | undecided | rules |")
    print("|---|---|---|---|---|---|---|")
    for count in asked.inputs:
        for line in lines_of(count, measured(count, asked.laps, given)):
            print(line, flush=True)
    print("\nRules on 2 inputs, after compaction, that choose an action:")
    for sentence in said(given.cycles):
        print(f"  {sentence}")


if __name__ == "__main__":
    main()
