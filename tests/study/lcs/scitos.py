"""A real robot's arbiter, learnt by reward or from labels, beside a decision tree and xcsf.

`python -m tests.study.lcs.scitos` prints the accuracy on 2, 4 and 24 inputs, and the rules that
were found on 2. Three laps are learnt from and the other is tested on: rows in order of time, in
four parts; the last part is the fourth lap. A tree and the classifier are told the action that the
robot took. The others try an action at random and are told 1000 or -1000, `--cycles` times; the
classifier is told as many rewards, which is a quarter of the rows, in whole passes.

Numbers beyond what was learnt from are taken at its end, for all, as `specc learn` and the
classifier do. Where some action has no rule nothing is decided, and that counts as wrong; beside it
stands what comes of deciding anyway, where an action without a rule is taken to earn 0, or by the
classifier's way. With 24 inputs both peers cover so that seven of eight inputs are free: with
intervals as for 2 inputs their rules hold next to nowhere, and 95 % of the rows stay undecided.
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
from lcs.estimator import ALCSRClassifier
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
from tests.study.lcs.tables import row

CYCLES: Final = 50_000
LAPS: Final = 4
SEEDS: Final = range(1, 6)
PEER: Final = Config(bounds=Bounds.UNORDERED, selection=Selection.TOURNAMENT, explore=1.0)
REMEMBERED: Final = 10_000
"""Of the last cycles, what compaction goes by."""

HEAD: Final = (
    *("inputs", "who", "last lap", "four laps", "each lap", "undecided"),
    *("last lap, deciding anyway", "four laps, anyway", "rules"),
)

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


def tested(table: Table) -> Array:
    """The rows to test on, in the range of those to learn from."""
    known = table.x[table.learnt]
    return np.clip(table.x[table.tested], known.min(axis=0), known.max(axis=0))


def tree(table: Table, cycles: int, seed: int) -> dict[str, Score]:  # noqa: ARG001
    """scikit-learn's tree, told every label."""
    found = DecisionTreeClassifier(random_state=seed)
    found.fit(table.x[table.learnt], table.right[table.learnt])
    leaves = int(found.get_n_leaves())
    return {"decision tree": score(found.predict_proba(tested(table)), table, leaves)}


def classifier(table: Table, cycles: int, seed: int) -> dict[str, Score]:
    """Ours, told every label; where no rule holds it takes the class of the nearest."""
    found = ALCSRClassifier(examples=cycles // table.classes, random_state=seed)
    found.fit(table.x[table.learnt], table.right[table.learnt])
    anyway = float(np.mean(found.predict(tested(table)) == asked(table)))
    said = found.set_params(uncovered=-1).predict(tested(table))
    right, undecided = float(np.mean(said == asked(table))), float(np.mean(said < 0))
    return {"ALCSRClassifier": (right, anyway, undecided, len(found.rules_))}


def alcsr(table: Table, cycles: int, seed: int) -> dict[str, Score]:
    """Ours, and its rules after compaction."""
    learner, few = grown(table, cycles, seed)
    x, rules = tested(table), learner.rules()
    return {
        "ALCSR": score(decide(rules, x).expected, table, len(rules)),
        "ALCSR, compacted": score(decide(few, x).expected, table, len(few)),
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
    return {"XCSR": score(decide(rules, tested(table)).expected, table, len(rules))}


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
    expected = np.array(learner.model.predict((tested(table) - low) / (high - low)))
    expected[expected == 0.0] = np.nan  # what it predicts where it has no rule
    return {"xcsf": score(expected, table, learner.rules())}


STUDIES: Final[dict[str, Study]] = {
    "tree": tree,
    "classifier": classifier,
    "alcsr": alcsr,
    "xcsr": xcsr,
    "xcsf": peer,
}


def measured(count: int, laps: Sequence[int], given: "Given") -> Iterator[tuple[str, Array]]:
    """Who learns from so many inputs, and its scores (laps, seeds, 4)."""
    tables = [in_folds(scitos(count), LAPS, lap) for lap in laps]
    for name in given.who:
        runs = [[STUDIES[name](table, given.cycles, s) for s in given.seeds] for table in tables]
        for who in runs[0][0]:
            yield who, np.array([[run[who] for run in of_lap] for of_lap in runs])


def line_of(count: int, who: str, scores: Array) -> str:
    """A row of the table."""
    right, anyway, undecided, rules = np.moveaxis(scores, -1, 0)
    last = 100.0 * right[-1]
    each = " ".join(f"{share:.2f}" for share in 100.0 * right.mean(axis=1))
    cells = [
        f"{count}",
        who,
        f"{last.mean():.2f} ({last.min():.2f} to {last.max():.2f})",
        f"{100.0 * right.mean():.2f}",
        each,
        f"{100.0 * undecided.mean():.2f}",
        f"{100.0 * anyway[-1].mean():.2f}",
        f"{100.0 * anyway.mean():.2f}",
        f"{rules.mean():.0f}",
    ]
    return row(cells)


def said(cycles: int) -> Iterator[str]:
    """The rules on 2 inputs that choose an action, in words."""
    table = in_folds(scitos(2), LAPS, LAPS)
    _, few = grown(table, cycles, SEEDS[0])
    for each in in_words(few, Names(table.described, table.labels), table.x[table.learnt]):
        if not each.then.startswith("not "):
            yield str(each)


@final
@dataclasses.dataclass(frozen=True, slots=True)
class Given:
    """What is asked for on the command line."""

    who: tuple[str, ...]
    cycles: int
    seeds: range


def main() -> None:
    """Print the table, and the rules."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--inputs", type=int, nargs="+", default=[2, 4, 24])
    parser.add_argument("--laps", type=int, nargs="+", default=[1, 2, 3, 4])
    parser.add_argument("--who", nargs="+", choices=STUDIES, default=list(STUDIES))
    parser.add_argument("--cycles", type=int, default=CYCLES)
    parser.add_argument("--seeds", type=int, default=len(SEEDS))
    asked = parser.parse_args()
    given = Given(tuple(asked.who), asked.cycles, SEEDS[: asked.seeds])
    print(f"% right; {given.cycles:,} tries; means of {asked.seeds} seeds (least to most)\n")
    print(row(HEAD))
    print(row(["---"] * len(HEAD)))
    for count in asked.inputs:
        for who, scores in measured(count, asked.laps, given):
            print(line_of(count, who, scores), flush=True)
    print("\nRules on 2 inputs, after compaction, that choose an action:")
    for sentence in said(given.cycles):
        print(f"  {sentence}")


if __name__ == "__main__":
    main()
