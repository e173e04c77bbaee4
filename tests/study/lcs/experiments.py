"""Both experiments of section 4.4, five runs each, beside what the thesis states."""

from pathlib import Path
from typing import Final

import numpy as np

from lcs.alcsr.config import Config
from tests.study.lcs.measures import LAST, NEAR, PLACES, Measured, measured, spread
from tests.study.lcs.runs import FRESH, Wanted, all_made
from tests.study.lcs.tables import percent, row

SEEDS: Final = range(5)

THESIS: Final = {
    1: ("–", "~95", "~98", "–", "> 9,970", "~2,000 @ 20,000", "452, ~535, 607"),
    2: ("~93", "–", "–", "~98", "> 9,970", "~2,100 @ 27,000", "859, ~950, 1,112"),
}

HEAD: Final = (
    "seed",
    *(f"at {place:,}" for place in PLACES),
    f"right of the last {LAST:,}",
    "peak rules @ explore",
    "rules at the end",
    f"{FRESH:,} fresh",
    "births",
    "deaths",
    "CPU s",
)


def wanted(config: Config, name: str = "thesis", cycles: int = 300_000) -> list[Wanted]:
    """Five runs of each experiment."""
    return [Wanted(name, which, seed, config, cycles) for which in (1, 2) for seed in SEEDS]


def tell(folder: Path, at_once: int) -> None:
    """Make what is missing in the folder, and print both tables."""
    found: dict[int, list[tuple[int, Measured]]] = {1: [], 2: []}
    for run in all_made(wanted(Config()), at_once, folder):
        found[run.experiment].append((run.seed, measured(run, FRESH)))
    for which, runs in found.items():
        print(f"\nExperiment {which}: performance in % over the last 1,000 tests\n")
        print(row(HEAD))
        print(row(["---"] * len(HEAD)))
        print(row(["**thesis**", *THESIS[which], "–", "–", "–", "–"]))
        for seed, each in sorted(runs, key=lambda one: one[0]):
            print(row([str(seed), *_cells(each)]))
        print(row(["mean", *_together([each for _, each in runs])]))
        print(row(["mean over the last 50", *_last_fifty([each for _, each in runs])]))
        print(row([f"all tests within {NEAR:,}", *_near([each for _, each in runs])]), flush=True)


def _cells(run: Measured) -> list[str]:
    return [
        *map(percent, run.of_1000),
        f"{run.last:,}",
        f"{run.peak:,} @ {run.peak_at:,}",
        f"{run.final:,}",
        f"{100.0 * run.fresh:.2f}",
        f"{run.births:,}",
        f"{run.deaths:,}",
        f"{run.seconds:.0f}",
    ]


def _together(runs: list[Measured]) -> list[str]:
    def mean(values: list[float]) -> float:
        return float(np.mean(values))

    at = [mean([run.of_1000[k] for run in runs]) for k in range(len(PLACES))]
    final = ", ".join(f"{value:,.0f}" for value in spread([run.final for run in runs]))
    return [
        *map(percent, at),
        f"{mean([run.last for run in runs]):,.0f}",
        f"{mean([run.peak for run in runs]):,.0f} @ {mean([run.peak_at for run in runs]):,.0f}",
        final,
        f"{100.0 * mean([run.fresh for run in runs]):.2f}",
        f"{mean([run.births for run in runs]):,.0f}",
        f"{mean([run.deaths for run in runs]):,.0f}",
        f"{mean([run.seconds for run in runs]):.0f}",
    ]


def _last_fifty(runs: list[Measured]) -> list[str]:
    at = [float(np.mean([run.of_50[k] for run in runs])) for k in range(len(PLACES))]
    return [*map(percent, at), *[""] * 7]


def _near(runs: list[Measured]) -> list[str]:
    """All runs' tests around each place, with half the width of the 95 % interval."""
    cells = []
    for k in range(len(PLACES)):
        right, count = (sum(run.near[k][part] for run in runs) for part in (0, 1))
        share = right / count
        cells.append(f"{percent(share)} ± {percent(1.96 * np.sqrt(share * (1 - share) / count))}")
    return [*cells, *[""] * 7]
