"""The law of exclusion over many random architectures: `python -m tests.study.exclusion [CASES]`.

Half of them are plain (conditions, arbiters that remember, two clocks), half at large (combined
behaviors, readings that inhibit, modules, choices of nothing, outputs that may be no number). What
is proved runs 4 times for 60 instants with random readings; what is refuted is replayed. It stops
at the first architecture that breaks the law, made as small as can be.
"""

import sys
from collections import Counter

from hypothesis import HealthCheck, given, seed, settings
from hypothesis import strategies as st

from compiler.architecture.exclusion.decide import decide
from tests.compiler.architecture.at_large import cases_at_large
from tests.compiler.architecture.exclusion_law import Fate, fate_of
from tests.compiler.architecture.exclusions import Case, cases

RUNS, STEPS = 4, 60


def main(count: int = 3000) -> None:
    """Print how many of each kind came to what."""
    kinds = {"plain": cases(), "at large": cases_at_large()}
    print("| architectures | " + " | ".join(Fate) + " |")
    print("|---|" + "---|" * len(Fate))
    for name, drawn in kinds.items():
        found = fates(drawn, count // len(kinds))
        cells = " | ".join(str(found[fate]) for fate in Fate)
        print(f"| {found.total()} {name} | {cells} |", flush=True)


def fates(drawn: st.SearchStrategy[Case], count: int) -> Counter[Fate]:
    """How many architectures came to what."""
    found: Counter[Fate] = Counter()

    @seed(5)
    @settings(
        max_examples=count,
        deadline=None,
        database=None,
        suppress_health_check=list(HealthCheck),
    )
    @given(drawn, st.integers(0, 2**32 - RUNS))
    def law(case: Case, first: int) -> None:
        found[fate_of(case, decide(case.question), range(first, first + RUNS), STEPS)] += 1

    law()
    return found


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
