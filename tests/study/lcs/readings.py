"""What each open place of the thesis does to section 4.4, read otherwise than by default."""

from collections.abc import Iterable, Sequence
from dataclasses import fields, replace
from pathlib import Path
from typing import Final

from lcs.alcsr.config import Config, Readings
from lcs.alcsr.readings import CorpsesLearn, Generalization, NeighborsAre, RangeIs, SeedingBy
from tests.study.lcs.measures import Measured, measured, spread
from tests.study.lcs.runs import FRESH, Run, Wanted, all_made
from tests.study.lcs.tables import percent, row

CYCLES: Final = 60_000
"""Of a run of the first table, a fifth of the thesis's: past the peak of most populations."""

WIDTHS: Final = (1.15, 1.5)
SHOWN: Final = (1, 2, 3)
"""Which of `measures.PLACES`."""

HEAD: Final = (
    *("experiment 1: at 15k", "35k", "50k", "fresh", "peak rules @ explore", "rules at the end"),
    *("experiment 2: at 15k", "35k", "50k", "fresh", "peak rules @ explore", "rules at the end"),
)


def alternatives() -> dict[str, Config]:
    """The defaults, each member of each reading that is none, and two sprout widths."""
    found = {"defaults": Config()}
    for each in fields(Readings):
        default = getattr(Readings(), each.name)
        for member in type(default):
            if member is not default:
                readings = replace(Readings(), **{each.name: member})
                found[f"{type(default).__name__}.{member.name}"] = Config(readings=readings)
    for width in WIDTHS:
        found[f"sprout_width {width}"] = Config(sprout_width=width)
    return found


def nearest() -> dict[str, Config]:
    """Sprout widths that bring populations near the thesis's."""
    return {f"sprout_width {width}": Config(sprout_width=width) for width in (1.1, 1.15)}


def together() -> dict[str, Config]:
    """Readings that each make populations smaller, without a sprout width."""
    two = Readings(
        range_is=RangeIs.DECLARED,
        generalization=Generalization.HULL_AND_BEYOND,
    )
    four = Readings(
        range_is=RangeIs.DECLARED,
        neighbors_are=NeighborsAre.SUB_SPECIES,
        corpses_learn=CorpsesLearn.HALVED,
        seeding_by=SeedingBy.SUB_SPECIES,
    )
    return {
        "DECLARED, HULL_AND_BEYOND": Config(readings=two),
        "DECLARED, neighbors and seeding by SUB_SPECIES, HALVED": Config(readings=four),
    }


def tell(folder: Path, at_once: int) -> None:
    """Make what is missing in the folder, and print a row for each reading: one seed."""
    print(f"One seed, {CYCLES:,} cycles; performance in % over the last 1,000 tests.\n")
    _print("reading", alternatives(), CYCLES, range(1), folder, at_once)


def tell_nearest(folder: Path, at_once: int) -> None:
    """The same for what comes nearest to the thesis's populations: all cycles."""
    print("300,000 cycles; performance in % over the last 1,000 tests. Five seeds:\n")
    _print("reading", nearest(), 300_000, range(5), folder, at_once)
    print("\nOne seed:\n")
    _print("readings", together(), 300_000, range(1), folder, at_once)


def _print(
    what: str,
    configs: dict[str, Config],
    cycles: int,
    seeds: Sequence[int],
    folder: Path,
    at_once: int,
) -> None:
    wanted = [
        Wanted(name, which, seed, config, cycles)
        for name, config in configs.items()
        for which in (1, 2)
        for seed in seeds
    ]
    runs = list(all_made(wanted, at_once, folder))
    print(row([what, *HEAD]))
    print(row(["---"] * (1 + len(HEAD))))
    for name in configs:
        cells = [_cells(cycles, _of(runs, name, which)) for which in (1, 2)]
        print(row([name, *cells[0], *cells[1]]), flush=True)


def _of(runs: Iterable[Run], name: str, which: int) -> list[Measured]:
    return [measured(run, FRESH) for run in runs if run.name == name and run.experiment == which]


def _cells(cycles: int, runs: Sequence[Measured]) -> list[str]:
    """Of the runs of one experiment: means, and the least, median and most rules at the end."""
    if any(run.cycles < cycles for run in runs):
        stopped = min(run.cycles for run in runs)
        most = max(run.final for run in runs)
        return [*["–"] * 4, f"given up after {stopped:,} cycles", f"{most:,}"]
    count = len(runs)
    at = [sum(run.of_1000[k] for run in runs) / count for k in SHOWN]
    least, median, most_ = spread([run.final for run in runs])
    final = f"{median:,.0f}" if count == 1 else f"{least:,.0f}, {median:,.0f}, {most_:,.0f}"
    peak = sum(run.peak for run in runs) / count
    peak_at = sum(run.peak_at for run in runs) / count
    fresh = sum(run.fresh for run in runs) / count
    return [*map(percent, at), percent(fresh), f"{peak:,.0f} @ {peak_at / 1000:,.0f}k", final]
