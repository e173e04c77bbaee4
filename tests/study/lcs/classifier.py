"""The classifier beside a decision tree: `python -m tests.study.lcs.classifier`.

Ten parts of each table, drawn so that classes are spread alike; each is tested on once.
"""

import time
from typing import Any, Final

import numpy as np
from sklearn.datasets import load_breast_cancer, load_iris, load_wine, make_moons
from sklearn.model_selection import StratifiedKFold
from sklearn.tree import DecisionTreeClassifier

from lcs.estimator import ALCSRClassifier

FOLDS: Final = 10


def tables() -> dict[str, tuple[Any, Any]]:
    """Rows and labels by name."""
    chance = np.random.default_rng(0)
    rare = chance.random((1_000, 2))
    return {
        "iris": load_iris(return_X_y=True),
        "wine": load_wine(return_X_y=True),
        "breast cancer": load_breast_cancer(return_X_y=True),
        "moons, noise 0.2": make_moons(500, noise=0.2, random_state=0),
        "a square of 2 %": (rare, np.all(rare < 0.15, axis=1).astype(int)),
    }


def row_of(name: str, x: Any, y: Any) -> str:
    """A line of the table."""
    ours, trees, recalls, rules, leaves, seconds = [], [], [], [], [], 0.0
    rarest = np.bincount(y).argmin()
    for learnt, tested in StratifiedKFold(FOLDS, shuffle=True, random_state=0).split(x, y):
        tree = DecisionTreeClassifier(random_state=0).fit(x[learnt], y[learnt])
        started = time.process_time()
        found = ALCSRClassifier(random_state=0).fit(x[learnt], y[learnt])
        seconds += time.process_time() - started
        said = found.predict(x[tested])
        ours.append(np.mean(said == y[tested]))
        trees.append(tree.score(x[tested], y[tested]))
        recalls += (said == y[tested])[y[tested] == rarest].tolist()
        rules.append(len(found.rules_))
        leaves.append(tree.get_n_leaves())
    return (
        f"| {name} | {len(x)} x {x.shape[1]} | {np.mean(ours):.3f} ± {np.std(ours):.3f} "
        f"| {np.mean(trees):.3f} ± {np.std(trees):.3f} | {np.mean(recalls):.2f} "
        f"| {np.mean(rules):.0f} | {np.mean(leaves):.0f} | {seconds / FOLDS:.1f} |"
    )


def main() -> None:
    """Print the table."""
    ALCSRClassifier(examples=2).fit([[0.0], [1.0]], [0, 1]).predict([[0.0]])  # compiles
    print("| table | size | right | tree | rarest class | rules | leaves | s per fit |")
    print("|---|---|---|---|---|---|---|---|")
    for name, (x, y) in tables().items():
        print(row_of(name, x, y), flush=True)


if __name__ == "__main__":
    main()
