"""Refitted gains beside those of the robot: `python -m tests.study.gains [runs]`.

Wall followers, 60 s at 20 Hz, noise of 1 cm and 0.02 rad. Each row refits some numbers, starts of
windows free: the mean over all runs, as a ratio to the robot's own number, with its standard error
(times 1.96), the scatter from run to run, and how many of the 95 % intervals hold the truth.
"""

import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

import specc
from runtime.arrays import Array
from runtime.program import Program
from tests.study.planted import Wall, wall
from verifier.diagnosis.fitting import fit, intervals_of, plain_fit
from verifier.diagnosis.parameters import effect_of, parameters_of
from verifier.diagnosis.scene import Scene, scene_of
from verifier.fidelity.verify import judged

SPEC: Final = Path(__file__).parents[2] / "specs" / "wall_follow.yaml"
TURN, WAY = "gain of the rate of heading", "gain of the rate of distance"
CLOSE: Final = 0.01
"""So far from 1 the mean ratio may be."""


@dataclass(frozen=True)
class Row:
    """What is refitted together, in words; the robot; and the truth of each number."""

    words: str
    robot: Wall
    truth: dict[str, float]


@dataclass(frozen=True)
class Gain:
    """Of one refitted number over N runs: its ratios to the truth (N,), and the intervals."""

    ratios: Array
    held: int

    @property
    def mean(self) -> float:
        """Of all runs."""
        return float(np.mean(self.ratios))

    @property
    def doubt(self) -> float:
        """Half of the mean's own 95 % interval."""
        return 1.96 * float(np.std(self.ratios, ddof=1)) / float(np.sqrt(len(self.ratios)))

    @property
    def is_unbiased(self) -> bool:
        """Whether the mean is 1.00 ± 0.01."""
        return abs(self.mean - 1.0) <= CLOSE


def rows() -> tuple[Row, ...]:
    """One gain, both, the spec's own numbers; of the robot as specified and of others."""
    own = {"speed": 0.4, "stiffness": 2.0, "damping": 2.0}
    other = Wall(speed=0.46, stiffness=2.4, damping=1.6)
    both = {TURN: 1.0, WAY: 1.0}
    moved = {"speed": 0.46, "stiffness": 2.4, "damping": 1.6}
    return (
        Row("one gain", Wall(), {TURN: 1.0}),
        Row("one gain", Wall(), {WAY: 1.0}),
        Row("both gains", Wall(), both),
        Row("both gains, one is 0.8", Wall(gain=0.8), {**both, TURN: 0.8}),
        Row("both gains, one is 1.2", Wall(gain=1.2), {**both, TURN: 1.2}),
        Row("the spec's numbers", Wall(), own),
        Row("the spec's numbers, all moved", other, moved),
    )


def gains_of(program: Program, row: Row, runs: int) -> dict[str, Gain]:
    """Every number of a row, refitted in every run."""
    ratios: dict[str, list[float]] = {label: [] for label in row.truth}
    held = dict.fromkeys(row.truth, 0)
    for seed in range(runs):
        _, study = judged(program, wall(row.robot, seed))
        assert study is not None, "60 s can be judged"
        for label, (value, low, high) in refitted(scene_of(program, study), row).items():
            ratios[label].append(value / row.truth[label])
            held[label] += low <= row.truth[label] <= high
    return {label: Gain(np.array(ratios[label]), held[label]) for label in row.truth}


def refitted(scene: Scene, row: Row) -> dict[str, tuple[float, float, float]]:
    """By label, the fitted value and the ends of its 95 % interval."""
    parameters = [p for p in parameters_of(scene.program, scene.needs) if p.label in row.truth]
    effects = tuple(effect_of(each) for each in parameters)
    base = plain_fit(scene)
    begin = tuple(each.spec for each in parameters)
    found = fit(scene, effects, begin, base.starts, base.sigma)
    intervals = intervals_of(scene, found, 0.95)
    return {
        each.label: (value, interval.low, interval.high)
        for each, value, interval in zip(parameters, found.values, intervals, strict=True)
    }


def _say(line: str) -> None:
    sys.stdout.write(f"{line}\n")
    sys.stdout.flush()


def main(runs: int) -> int:
    """Print the table; 1 where a mean is further than 0.01 from 1."""
    program, biased = specc.load_program(SPEC), 0
    _say(f"{'refitted':30} {'number':29} {'mean ratio':15} {'scatter':>7} {'held by 95 %':>13}")
    for row in rows():
        for label, gain in gains_of(program, row, runs).items():
            mean = f"{gain.mean:.4f} ± {gain.doubt:.4f}"
            share = f"{gain.held} of {runs}"
            scatter = float(np.std(gain.ratios, ddof=1))
            _say(f"{row.words:30} {label:29} {mean:15} {scatter:7.4f} {share:>13}")
            biased += not gain.is_unbiased
    _say(f"{biased} of them biased: more than {CLOSE} from 1")
    return int(biased > 0)


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1]) if len(sys.argv) > 1 else 30))
