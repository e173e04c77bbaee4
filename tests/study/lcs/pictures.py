"""Figures 4.1 to 4.4 of the thesis drawn again, with what it states marked in them."""

from pathlib import Path
from typing import Final

from lcs.alcsr.config import Config
from lcs.curves import tries_of
from specc.figures.learning import draw_learning
from specc.figures.learning_panels import Stated
from specc.figures.learning_population import draw_population
from specc.figures.style import Picture, rendered
from tests.study.lcs.experiments import wanted
from tests.study.lcs.measures import LAST
from tests.study.lcs.runs import Run, all_made

IMG: Final = Path(__file__).parents[3] / "docs" / "img"

THRESHOLDS: Final = {1: "all thresholds 0.5", 2: "thresholds 0.25 and 0.75 in turn"}
PERFORMANCE: Final = {
    1: (
        Stated("thesis: 95 % at 15,000", (15e3, 15e3), (0.95, 0.95)),
        Stated("98 % at 35,000", (35e3, 35e3), (0.98, 0.98)),
    ),
    2: (
        Stated("thesis: 93 % at 10,000", (10e3, 10e3), (0.93, 0.93)),
        Stated("98 % at 50,000", (50e3, 50e3), (0.98, 0.98)),
    ),
}
PEAK: Final = {
    1: Stated("thesis: about 2,000 at 20,000", (20e3, 20e3), (2000.0, 2000.0)),
    2: Stated("thesis: about 2,100 at 27,000", (27e3, 27e3), (2100.0, 2100.0)),
}
FINAL: Final = {1: (452.0, 607.0), 2: (859.0, 1112.0)}


def draw(folder: Path, at_once: int) -> None:
    """Draw both experiments, from the runs in the folder, which are made if need be."""
    runs = list(all_made(wanted(Config()), at_once, folder))
    for which in (1, 2):
        for name, picture in pictures(which, [run for run in runs if run.experiment == which]):
            path = IMG / f"alcsr_experiment_{which}_{name}.svg"
            path.write_bytes(rendered(picture, "svg"))
            (folder / f"{path.stem}.png").write_bytes(rendered(picture, "png"))
            print(path)


def pictures(which: int, runs: list[Run]) -> list[tuple[str, Picture]]:
    """Of one experiment: learning, and population."""
    courses, curves = [run.course for run in runs], [run.curve for run in runs]
    cycles = len(courses[0].kind)
    about = [
        f"Real 6-multiplexer, {THRESHOLDS[which]}; P(explore) 0.9.",
        f"Mean of {len(runs)} runs of {cycles:,} cycles, in the band from lowest to highest.",
    ]
    end = min(float(tries_of(course)[-1]) for course in courses)
    begin = min(float(curve.tries[-LAST:][0]) for curve in curves)
    last = Stated(f"more than 9,970 of the last {LAST:,}", (begin, end), (0.997, 1.0))
    low, high = FINAL[which]
    final = Stated(f"{low:,.0f} to {high:,.0f} at the end", (0.985 * end, end), (low, high))
    learning = draw_learning(
        curves,
        f"Experiment {which}: performance and system error",
        stated=[*PERFORMANCE[which], last],
        about=about,
    )
    population = draw_population(
        courses, f"Experiment {which}: population", stated=[PEAK[which], final], about=about
    )
    return [("learning", learning), ("population", population)]
