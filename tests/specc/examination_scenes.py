"""Examinations made up for drawing: every section, as an unlucky robot would have it."""

import math
from dataclasses import replace

import numpy as np

from runtime.program import Unit
from tests.specc.report_scenes import DEGREE, METRE, coverage, report
from verifier.report.diagnosis import (
    Candidate,
    CandidateKind,
    DepartureAfter,
    Diagnosis,
    DifferingRegion,
    Evidence,
    FittedNumber,
    ParameterKind,
    Refitted,
    Told,
)
from verifier.report.examination import Examination
from verifier.report.features import (
    ComparedFeature,
    Estimate,
    FeatureNumber,
    Features,
    FeatureStanding,
)
from verifier.report.limits import Caught, Fault, Limits, NotTold, Trial
from verifier.report.report import Interval, RegionMean, Standing, Verdict
from verifier.report.scores import IsoRating, Scores, VariableScores
from verifier.report.switching import Jump, Switch, Switching, SwitchSort, Timing, Way

ONE = Unit("1", 1.0)
SECOND = Unit("s", 1.0)
SPEED = Unit("m/s", 1.0)
PERCENT = Unit("%", 0.01)


def examination(verdict: Verdict = Verdict.FAIL, word: str = "") -> Examination:
    """All sections; `word` is put wherever a stranger's text may stand."""
    return Examination(
        report=report(verdict, cells=coverage(2), word=word),
        switching=switching(word),
        diagnosis=diagnosis(word),
        limits=limits(word),
        features=features(word),
        scores=scores(word),
        origins={"fidelity": "husky_drive.yaml:40:1", "x": "husky_drive.yaml:10:3"},
    )


def passed() -> Examination:
    """A robot that does what the spec says, of which only the verdict was asked."""
    made = report(Verdict.PASS, cells=coverage(1))
    good = replace(made.variables[0], standing=Standing.WITHIN)
    seen = replace(coverage(1), required=0.1)
    trace = replace(made.trace, source="second.mcap")
    kept = replace(made, variables=(good,), coverage=seen, losses=(), notes=(), trace=trace)
    return Examination(kept, origins={"fidelity": "husky_drive.yaml:40:1"})


def diagnosis(word: str = "") -> Diagnosis:
    speed = Refitted(
        ParameterKind.CONTROL,
        f"v1{word}",
        SPEED,
        0.5,
        0.46,
        Interval(0.45, 0.47),
        is_moved=True,
        origin="husky_drive.yaml:14:3",
        sentence=f"v1 is 0.46 ± 0.01 m/s (spec 0.5 m/s){word}",
    )
    scale = replace(
        speed,
        kind=ParameterKind.TIME_SCALE,
        name="",
        unit=ONE,
        spec=1.0,
        value=1.001,
        interval=Interval(0.98, 1.02),
        is_moved=False,
        sentence="",
        origin="husky_drive.yaml:30:1",
    )
    differing = RegionMean(
        {"heading": (0.2, 0.4)}, {}, None, None, 11, 0.03, Interval(0.02, 0.04), Standing.EXCEEDED
    )
    return Diagnosis(
        told=Told.STRUCTURE_DIFFERS,
        sentences=(
            f"turn acts 0.48 s late, which explains 86 % of what heading departs{word}",
            "with that taken in, v1 is 0.46 ± 0.01 m/s (spec 0.5 m/s)",
        ),
        refitted=(speed, scale),
        after=(
            DepartureAfter(
                "heading",
                DEGREE,
                0.02,
                0.001,
                0.031,
                0.009,
                Interval(0.006, 0.012),
                Standing.WITHIN,
                "husky_drive.yaml:12:3",
            ),
        ),
        candidates=tuple(
            candidate(kind, share, word, is_taken=taken)
            for kind, share, taken in (
                (CandidateKind.DEAD_TIME, 0.86, True),
                (CandidateKind.LAG, 0.81, False),
                (CandidateKind.GAIN, 0.12, False),
                (CandidateKind.SIGN, -0.4, False),
            )
        ),
        differs=(
            DifferingRegion(
                "heading",
                DEGREE,
                differing,
                f"heading still departs for heading in 11 … 23 deg{word}",
            ),
        ),
    )


def candidate(kind: CandidateKind, share: float, word: str, *, is_taken: bool) -> Candidate:
    number = FittedNumber("delay", SECOND, 0.0, 0.48, Interval(0.44, math.inf))
    return Candidate(
        kind=kind,
        applies_to=("turn",),
        label=f"{kind} of turn{word}",
        numbers=(number,),
        evidence=Evidence(31, share, 120.0 * share, ()),
        is_taken=is_taken,
        alike=("turn logged late",) if is_taken else (),
        origin="husky_drive.yaml:21:3",
        claim=f"{kind} of turn: 0.48 s{word}",
        sentence=f"{kind} of turn: 0.48 s{word}",
    )


def limits(word: str = "") -> Limits:
    untold = NotTold(
        f"the gain of turn apart from its saturation{word}",
        ("turn",),
        "turn took only two values",
        "drive with turn at 0.1 and 0.2 rad/s as well",
        "husky_drive.yaml:21:3",
    )
    gain = tuple(
        Trial(size, Verdict.FAIL if abs(size) > 0.025 else Verdict.PASS)
        for size in (-0.1, -0.05, -0.025, 0.0125, 0.022, 0.031, 0.05, 0.1)
    )
    caught = Caught(
        Fault.GAIN,
        f"heading{word}",
        PERCENT,
        0.031,
        0.022,
        gain,
        ("heading",),
        f"a turn rate 3.1 % too high would have been caught, 2.2 % not{word}",
        "husky_drive.yaml:12:3",
    )
    unseen = Caught(
        Fault.SENSOR,
        "x",
        METRE,
        math.inf,
        0.4,
        tuple(Trial(size, Verdict.INCONCLUSIVE) for size in (0.1, 0.2, 0.4)),
        (),
        "no constant error of x would have been caught, up to 0.4 m",
        "husky_drive.yaml:10:3",
    )
    return Limits((untold,), (caught, unseen), (f"planted into the first 60 s{word}",))


def features(word: str = "") -> Features:
    turn = np.linspace(0.0, 2.0 * np.pi, 60)
    loop = np.stack([2.0 * np.cos(turn), 1.5 * np.sin(turn)], axis=-1)
    period = FeatureNumber(
        "period",
        SECOND,
        6.66,
        Estimate(6.82, Interval(6.80, 6.84)),
        Estimate(6.81, Interval(6.7, 6.9)),
        0.07,
        "2 % are declared",
        FeatureStanding.EXCEEDED,
    )
    place = FeatureNumber(
        "x",
        METRE,
        0.0,
        None,
        Estimate(0.02, Interval(-0.01, 0.05)),
        math.inf,
        "",
        FeatureStanding.UNDECIDED,
    )
    return Features(
        axes=("x", f"v{word}"),
        units=(METRE, SPEED),
        settings=(("mu", 1.0),),
        features=(
            ComparedFeature(
                "stable cycle",
                f"stable cycle of period 6.66 s{word}",
                "one stable cycle",
                "husky_drive.yaml:50:5",
                in_spec=True,
                is_cycle=True,
                numbers=(period,),
                standing=FeatureStanding.EXCEEDED,
                visits=9,
                spec_path=loop,
                robot_path=1.06 * loop,
                sentence=f"the robot's laps take 6.82 s, the spec's 6.66 s{word}",
            ),
            ComparedFeature(
                "saddle",
                "saddle at x = 0",
                "",
                "husky_drive.yaml:30:1",
                in_spec=True,
                is_cycle=False,
                numbers=(place,),
                standing=FeatureStanding.UNDECIDED,
                visits=3,
                spec_path=np.zeros((1, 2)),
                robot_path=np.array([[0.02, 0.01]]),
                sentence="the saddle at x = 0 is at x = 0.02 ± 0.03 m in the refitted field",
            ),
        ),
        notes=(f"nothing is known beyond x = 2.2 m{word}",),
        confidence=0.95,
    )


def switching(word: str = "") -> Switching:
    rng = np.random.default_rng(8)
    timing = Timing(
        9, 0.12, Interval(0.1, 0.14), 0.08, "tolerance of x over 0.6 m/s", 0.02, Standing.EXCEEDED
    )
    jump = Jump(
        "v",
        SPEED,
        is_reset=True,
        count=9,
        error=0.02,
        interval=Interval(0.01, 0.03),
        tolerance=0.05,
        standing=Standing.WITHIN,
    )
    there = Way(
        f"go{word}", "back", 9, 1, 1, 0, timing, (jump,), Standing.EXCEEDED, "husky_drive.yaml:33:5"
    )
    again = Way(
        "back", f"go{word}", 0, 0, 0, 0, None, (), Standing.UNDECIDED, "husky_drive.yaml:36:5"
    )
    made = [
        Switch(
            8.0 * k + 3.0,
            f"go{word}",
            "back",
            SwitchSort.EXPECTED,
            "",
            0.12 + 0.02 * float(rng.standard_normal()),
            0.015,
            0.08,
        )
        for k in range(9)
    ]
    lone = Switch(
        77.0, "back", f"go{word}", SwitchSort.UNEXPECTED, "", math.nan, math.nan, math.nan
    )
    return Switching(
        f"phase{word}",
        (there, again),
        (*made, lone),
        Standing.EXCEEDED,
        (f"go to back comes 0.12 s late, 0.08 s are allowed{word}",),
        ("record more laps",),
    )


def scores(word: str = "") -> Scores:
    iso = IsoRating(0.957, 0.98, 1.0, 0.93, 0.9)
    return Scores(
        (
            VariableScores("x", 3000, iso, 0.056, 0.972),
            VariableScores(f"heading{word}", 3000, None, math.nan, math.nan),
        ),
        ("These scores are for comparison only.",),
    )
