"""A real robot's arbiter, learnt by reward, beside a decision tree and xcsf.

`python -m tests.study.lcs.scitos` prints the accuracy on 2, 4 and 24 inputs, and the rules that
were found on 2. Three laps are learnt from and the other is tested on: rows in order of time, in
four parts; the last part is the fourth lap. A tree is told the action that the robot took. The
others try an action at random and are told 1000 or -1000, `--cycles` times.

Where some action has no rule nothing is decided, and that counts as wrong; beside it stands what
comes of deciding anyway, where an action without a rule is taken to earn 0. With 24 inputs both
peers cover so that seven of eight inputs are free: with intervals as for 2 inputs their rules hold
next to nowhere, and 95 % of the rows stay undecided.
"""

import argparse
import dataclasses
from collections.abc import Iterator, Sequence
from typing import Final, Protocol, TypeAlias, final

import numpy as np
from sklearn.tree import DecisionTreeClassifier

from lcs.alcsr.config import GROWN
from lcs.alcsr.learner import ALCSR
from lcs.arrays import Array, Integers
from lcs.problems.scitos import ALL, scitos
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

Score: TypeAlias = tuple[float, float, float, int]
"""The shares of rows that were decided right, right if one decides anyway, and not decided; and how
many rules (or leaves) there were."""


class Study(Protocol):
    """A table, to learn from with so many cycles, and a seed."""

    def __call__(self, table: Table, cycles: int, seed: int) -> dict[str, Score]: ...


def score(expected: Array, table: Table, rules: int) -> Score:
    """Of the rows to test on, by expected rewards (T, A), NaN of an action that has no rule."""
    known = np.isfinite(expected).all(axis=1)
    right = np.where(np.isfinite(expected), expected, 0.0).argmax(axis=1) == asked(table)
    return float(np.mean(right & known)), float(np.mean(right)), float(np.mean(~known)), rules


def asked(table: Table) -> Integers:
    """What is right of the rows to test on."""
    return table.right[table.tested]


def tree(table: Table, cycles: int, seed: int) -> dict[str, Score]:  # noqa: ARG001
    """scikit-learn's tree, told every label."""
    found = DecisionTreeClassifier(random_state=seed)
    found.fit(table.x[table.learnt], table.right[table.learnt])
    leaves = int(found.get_n_leaves())
    shares = found.predict_proba(table.x[table.tested])
    return {"decision tree": score(shares, table, leaves)}


def alcsr(table: Table, cycles: int, seed: int) -> dict[str, Score]:
    """Ours, and its rules after compaction."""
    learner, few = grown(table, cycles, seed)
    tested = table.x[table.tested]
    return {
        "ALCSR": score(decide(learner.rules(), tested).expected, table, len(learner.rules())),
        "ALCSR, compacted": score(decide(few, tested).expected, table, len(few)),
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
    config = dataclasses.replace(PEER, P_hash=0.875 if table.inputs == ALL else 0.0)
    learner = XCSR(table.classes, table.inputs, config, low=low, high=high, seed=seed)
    x, rewards, _ = table.drawn(cycles, np.random.default_rng([seed, 1]))
    learner.run(x, rewards)
    rules = learner.rules()
    return {"XCSR": score(decide(rules, table.x[table.tested]).expected, table, len(rules))}


def peer(table: Table, cycles: int, seed: int) -> dict[str, Score]:
    """xcsf, of inputs from 0 to 1."""
    from tests.bench.lcs_peer import OneByOne

    low, high = table.x.min(axis=0), table.x.max(axis=0)
    # An end of an interval that is drawn from 0 to 8 away leaves the range seven times of eight.
    learner = OneByOne(
        table.inputs, table.classes, seed, spread=8.0 if table.inputs == ALL else 1.0
    )
    chance = np.random.default_rng([seed, 1])
    x, rewards, _ = table.drawn(cycles, chance)
    learner.learn((x - low) / (high - low), rewards, chance.integers(0, table.classes, cycles))
    expected = np.array(learner.model.predict((table.x[table.tested] - low) / (high - low)))
    expected[expected == 0.0] = np.nan  # what it predicts where it has no rule
    return {"xcsf": score(expected, table, learner.rules())}


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
        right, anyway, undecided, rules = np.array(scores).T
        each = " ".join(f"{100.0 * share:6.2f}" for share in right)
        yield (
            f"| {count:2} | {who:16} | {100.0 * right[-1]:6.2f} | {100.0 * right.mean():6.2f} "
            f"| {each} | {100.0 * undecided.mean():5.2f} | {100.0 * anyway.mean():6.2f} "
            f"| {rules.mean():5.0f} |"
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
    print("| inputs | who | last lap, % right | mean | each lap | undecided | anyway | rules |")
    print("|---|---|---|---|---|---|---|---|")
    for count in asked.inputs:
        for line in lines_of(count, measured(count, asked.laps, given)):
            print(line, flush=True)
    print("\nRules on 2 inputs, after compaction, that choose an action:")
    for sentence in said(given.cycles):
        print(f"  {sentence}")


if __name__ == "__main__":
    main()
