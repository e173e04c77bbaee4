"""Which departure was planted, and which was named: `python -m tests.study.diagnosis [seeds]`.

A row counts as right where what was planted is named first, or told to be the same thing in other
words or as good an explanation as the first. Where the trace can't tell, right is to name nothing.
"""

import sys
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

import specc
from runtime.program import Program
from tests.study import planted
from tests.study.planted import Drive, Wall
from verifier.diagnosis.diagnose import diagnose
from verifier.fidelity.verify import judged
from verifier.report.diagnosis import Diagnosis, Told
from verifier.traces.trace import Trace

ROOT = Path(__file__).parents[2]
FOLLOW, SWING, DRIVE = "wall_follow.yaml", "van_der_pol.yaml", "drive"
DEGREES = 180.0 / np.pi


@dataclass(frozen=True)
class Row:
    """What is planted, in words; how the trace is made; which labels name it (none: nothing)."""

    planted: str
    spec: str
    made: Callable[[int], Trace]
    named: tuple[str, ...]


def rows() -> tuple[Row, ...]:
    """All departures."""
    return (*_nothing(), *_of_wall(), *_of_drive(), *_of_swing())


def _wall(robot: Wall, *named: str, words: str) -> Row:
    return Row(words, FOLLOW, lambda seed: planted.wall(robot, seed), named)


def _drive(robot: Drive, *named: str, words: str) -> Row:
    return Row(words, DRIVE, lambda seed: planted.drive(robot, seed), named)


def _swing(mu: float, pace: float, offset: float, *named: str, words: str) -> Row:
    return Row(words, SWING, lambda s: planted.oscillator(mu, pace, offset, s), named)


def _misread(spec: str, change: Callable[[Trace], Trace], *named: str, words: str) -> Row:
    """A faithful robot whose log says something else."""
    if spec == FOLLOW:
        return Row(words, spec, lambda seed: change(planted.wall(Wall(), seed)), named)
    return Row(words, spec, lambda seed: change(planted.drive(Drive(), seed)), named)


def _nothing() -> tuple[Row, ...]:
    return (
        _wall(Wall(), words="nothing"),
        _drive(Drive(), words="nothing"),
        _swing(1.0, 1.0, 0.0, words="nothing"),
        _wall(Wall(gain=1.001), words="gain 1.001, below the noise"),
    )


def _of_wall() -> tuple[Row, ...]:
    turning = "the rate of heading"
    p = planted
    return (
        _wall(Wall(speed=0.46), "speed", words="speed 0.46 for 0.4"),
        _wall(Wall(stiffness=2.4), "stiffness", words="stiffness 2.4 for 2"),
        _wall(Wall(damping=1.6), "damping", words="damping 1.6 for 2"),
        _wall(Wall(gain=1.2), f"gain of {turning}", words="gain of the rate 1.2"),
        _wall(Wall(offset=0.1), f"offset of {turning}", words="offset of the rate 0.1"),
        _wall(Wall(zone=0.04), "dead zone of distance - wanted", words="dead zone 4 cm"),
        _wall(Wall(limit=0.3), f"saturation of {turning}", words="saturation 0.3 rad/s"),
        _wall(Wall(late=0.3), f"dead time of {turning}", words="dead time 0.3 s"),
        _wall(Wall(lag=0.3), f"lag of {turning}", words="lag 0.3 s"),
        _wall(Wall(logged_late=0.3), "wanted logged late", words="command logged 0.3 s late"),
        _wall(
            Wall(patch=0.4),
            f"offset of {turning} at large distance",
            words="turns 0.4 rad/s more beyond 0.85 m",
        ),
        _misread(
            FOLLOW,
            lambda t: p.scaled(t, "heading", -1.0),
            "sign of heading",
            words="heading of wrong sign",
        ),
        _misread(
            FOLLOW,
            lambda t: p.scaled(t, "heading", DEGREES),
            "degrees for radians in heading",
            words="heading in degrees",
        ),
        _misread(
            FOLLOW,
            lambda t: p.scaled(t, "distance", 1e3),
            "millimetres for metres in distance",
            words="distance in millimetres",
        ),
    )


def _of_drive() -> tuple[Row, ...]:
    offsets = ("offset of turn", "offset of the rate of heading")
    lags = ("lag of turn", "lag of the rate of heading")
    gains = ("gain of turn", "gain of the rate of heading")
    p = planted
    return (
        _drive(Drive(gain=0.9), *gains, words="gain of turn 0.9"),
        _drive(Drive(bias=0.03), *offsets, words="bias of turn 0.03 rad/s"),
        _drive(Drive(limit=0.4), "saturation of turn", words="saturation of turn 0.4"),
        _drive(Drive(zone=0.1), "dead zone of turn", words="dead zone of turn 0.1"),
        _drive(Drive(late=0.3), "dead time of turn", words="dead time of turn 0.3 s"),
        _drive(Drive(lag=0.3), *lags, words="lag of turn 0.3 s"),
        _drive(Drive(pose_late=0.3), "clock of /gps", words="clock of x, y 0.3 s late"),
        _misread(
            DRIVE,
            lambda t: p.shifted(t, "turn", 0.3),
            "turn logged late",
            words="turn logged 0.3 s late",
        ),
        _misread(
            DRIVE, lambda t: p.scaled(t, "turn", -1.0), "sign of turn", words="turn of wrong sign"
        ),
        _misread(
            DRIVE,
            lambda t: p.scaled(t, "turn", DEGREES),
            "degrees for radians in turn",
            words="turn in degrees",
        ),
        _misread(
            DRIVE,
            lambda t: p.scaled(t, "speed", 1e3),
            "millimetres for metres in speed",
            words="speed in mm/s",
        ),
        _misread(
            DRIVE, lambda t: p.swapped(t, "x", "y"), "x and y swapped", words="x and y swapped"
        ),
    )


def _of_swing() -> tuple[Row, ...]:
    return (
        _swing(1.15, 1.0, 0.0, "mu", words="mu 1.15 for 1"),
        _swing(1.0, 1.1, 0.0, "time scale of all rates", words="all 1.1 times as fast"),
        _swing(1.0, 1.0, 0.1, "offset of x", words="x seen 0.1 too high"),
    )


def program_of(spec: str) -> Program:
    """A spec of the library; `drive` is the Husky's, its numbers and log made plain."""
    if spec != DRIVE:
        return specc.load_program(ROOT / "specs" / spec)
    text = (ROOT / "specs" / "husky_drive.yaml").read_text(encoding="utf-8")
    plain = text[: text.index("\ntrace:")].replace(
        "turn_scale: {value: 0.944", "turn_scale: {value: 1"
    )
    plain += """
trace:
  x: /gps.x
  y: /gps.y
  heading: /imu.yaw
  speed: /cmd.speed
  turn: /cmd.turn
"""
    return _loaded(plain)


def _loaded(text: str) -> Program:
    with TemporaryDirectory() as folder:
        path = Path(folder) / "drive.yaml"
        path.write_text(text, encoding="utf-8")
        return specc.load_program(path)


def diagnosed(program: Program, trace: Trace) -> Diagnosis:
    """The diagnosis alone."""
    report, study = judged(program, trace)
    return diagnose(program, trace, study, report)


def named(found: Diagnosis) -> tuple[str, ...]:
    """What the diagnosis names first, with what is the same or as good."""
    taken = [each for each in found.candidates if each.is_taken]
    return (taken[0].label, *taken[0].alike) if taken else ()


def is_right(row: Row, found: Diagnosis) -> bool:
    """Whether what was planted is named first, or nothing where nothing was."""
    if not row.named:
        return found.told is Told.NO_DIFFERENCE
    return bool(set(row.named) & set(named(found)))


def _say(line: str) -> None:
    sys.stdout.write(f"{line}\n")
    sys.stdout.flush()


def main(seeds: int) -> None:
    """Print the table."""
    programs = {row.spec: program_of(row.spec) for row in rows()}
    right = total = 0
    _say(f"{'planted':34} {'in':18} {'right':>9}  named first")
    for row in rows():
        found = [diagnosed(programs[row.spec], row.made(seed)) for seed in range(seeds)]
        hits = sum(is_right(row, each) for each in found)
        firsts = Counter((named(each) or (str(each.told),))[0] for each in found)
        told = ", ".join(f"{name} {count}" for name, count in firsts.most_common(3))
        _say(f"{row.planted:34} {row.spec:18} {hits:4}/{seeds:<4}  {told}")
        right, total = right + hits, total + seeds
    _say(f"right: {right} of {total}, {100.0 * right / total:.1f} %")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 20)
