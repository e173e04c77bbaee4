"""What a verdict says, word by word: reasons in their order, and advice that would decide."""

from dataclasses import replace
from types import ModuleType

import numpy as np
import pytest

from runtime.program import Program, Unit
from verifier.fidelity.judging import sentences
from verifier.fidelity.together import verify_together
from verifier.fidelity.verify import verify
from verifier.report.report import (
    HorizonFigure,
    Interval,
    Noise,
    RegionMean,
    Standing,
    VariableResult,
    Verdict,
)
from verifier.report.situations import exceeded
from verifier.traces.trace import Trace

RADIAN, METRE, KELVIN = Unit("rad", 1.0), Unit("m", 1.0), Unit("K", 1.0)
DEGREES = 180.0 / np.pi


def result(  # as many as a variable has figures
    *,
    departure: float = 0.033,
    interval: tuple[float, float] = (0.023, 0.045),
    systematic: float = 0.028,
    scatter: float = 0.01,
    worst: RegionMean | None = None,
    name: str = "heading",
) -> VariableResult:
    """A heading that may depart by 0.02 rad after 5 s."""
    ends = Interval(*interval)
    figure = HorizonFigure(5.0, 156, 0.034, 0.001, departure, ends, 0.02, Standing.EXCEEDED)
    return VariableResult(
        name=name,
        unit=RADIAN,
        period=0.0,
        tolerance=0.02,
        standing=Standing.EXCEEDED,
        noise=Noise(0.001, 1000, 0.0, 0.0, "estimated"),
        horizons=(figure,),
        systematic=systematic,
        scatter=scatter,
        allowed_scatter=0.0,
        unjudged=0,
        moved=10.0,
        mean=0.0,
        mean_interval=Interval(-0.001, 0.001),
        regions=() if worst is None else (worst,),
        worst=worst,
        errors=np.zeros(156),
        views=(),
        origin="",
    )


def part(**changes: object) -> RegionMean:
    plain = RegionMean({}, {}, None, None, 156, 0.034, Interval(0.03, 0.037), Standing.EXCEEDED)
    return replace(plain, **changes)


def told(**changes: object) -> str:
    return exceeded(result(**changes), {"turn": Unit("rad/s", 1.0)})


# --- a variable that departs


def test_a_departure_says_how_much_of_it_and_what_is_allowed() -> None:
    said = told(worst=part(moved=-0.38))

    assert said.startswith(
        "heading departs by 0.033 rad after 5 s (0.02 rad is allowed), at least 0.028 rad of it"
        " systematically: "
    )


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"moved": -0.38}, "where it should fall by 0.38 rad, it ends 0.034 rad above"),
        ({"moved": 0.38}, "where it should rise by 0.38 rad, it ends"),
        ({"moved": 0.0}, "where it should stay, it ends"),
        ({"hurried": -0.01}, "where its rate should fall during the window, it ends"),
        ({"bounds": {"turn": (0.1, 0.3)}}, "where turn is 0.1 to 0.3 rad/s, it ends"),
        (
            {"values": {"mode": "back"}, "bounds": {"turn": (0.1, 0.3)}},
            "where mode is back and turn is 0.1 to 0.3 rad/s, it ends",
        ),
        ({}, ": it ends 0.034 rad above the prediction on average (95 % interval 0.03 to 0.037"),
        ({"mean": -0.034, "interval": Interval(-0.037, -0.03)}, "it ends 0.034 rad below"),
    ],
)
def test_a_departure_says_where_and_in_which_direction(
    changes: dict[str, object], words: str
) -> None:
    assert words in told(worst=part(**changes))


def test_a_mean_that_is_allowed_is_not_told_as_what_is_wrong() -> None:
    said = told(worst=part(mean=0.012, moved=0.3, interval=Interval(0.01, 0.014)))

    assert "0.012" not in said
    assert said.endswith("windows in the same situation err alike")


def test_a_worst_situation_beyond_the_departure_is_no_share_of_it() -> None:
    said = told(systematic=0.05, worst=part(mean=0.06))

    assert "of it" not in said
    assert "in some situations by at least 0.05 rad systematically" in said


def test_systematic_is_explained_once_in_a_fail(scenes: ModuleType) -> None:
    report = verify(scenes.unicycle(1.2), scenes.unicycle_drive(4, 60.0, 0.01))

    assert sum("same situation" in reason for reason in report.reasons) == 1
    assert "same situation" in report.reasons[-1]


# --- more data


def test_more_data_is_asked_for_once_and_enough_for_all() -> None:
    # The upper end comes down to the tolerance as the root of the data: 4 and 9 times as much.
    one = result(name="x", departure=0.01, interval=(0.0, 0.03))
    other = result(name="y", departure=0.01, interval=(0.0, 0.04))

    (advice,) = sentences.more_data([one, other], 60.0)

    assert "about 540 s of judged data" in advice
    assert "decide about x and y" in advice


def test_a_departure_at_the_tolerance_is_no_matter_of_data() -> None:
    near = result(name="x", departure=0.0201, interval=(0.01, 0.04))
    far = result(name="y", departure=0.01, interval=(0.0, 0.03))

    first, second = sentences.more_data([near, far], 60.0)

    assert first.startswith("x departs by just about its tolerance")
    assert "about 240 s" in second


# --- outside the domain


def wall(scenes: ModuleType, heading: Unit = RADIAN, **binding: object) -> Program:
    """A follower in whose log `heading` may stand otherwise."""
    spec = scenes.program(
        (
            scenes.state("distance", 0.1, 1.9, unit=METRE),
            scenes.state("heading", -1.4, 1.4, unit=heading),
        ),
        (),
        {
            "distance": "0.4 heading mul",
            "heading": "0.8 distance sub heading 0.5 mul sub",
        },
        scenes.fidelity({"distance": 0.03, "heading": 0.04}, 2.0),
    )
    entries = [replace(each, unit=spec.states[i].unit) for i, each in enumerate(spec.bindings)]
    entries[1] = replace(entries[1], **binding)
    return replace(spec, bindings=tuple(entries))


def wall_drive(
    scenes: ModuleType, scale: float = 1.0, wrong_from: float = 0.0, seconds: float = 60.0
) -> Trace:
    """Swings about the wall; from a time on its heading is logged `scale` times as large."""
    times = np.arange(0.0, seconds, 0.05)

    def rate(_: float, s: np.ndarray) -> list[float]:
        return [0.4 * s[1], 0.8 - s[0] - 0.5 * s[1]]

    pieces = [
        scenes.integrated(rate, [1.3, 0.3 * (-1.0) ** k], times[:200], 0.1)
        for k in range(len(times) // 200)
    ]
    found = np.concatenate(pieces) + 0.002 * np.random.default_rng(1).standard_normal(
        (200 * len(pieces), 2)
    )
    times = times[: len(found)]
    heading = np.where(times >= wrong_from, scale, 1.0) * found[:, 1]
    return scenes.trace(
        scenes.series("distance", times, found[:, 0]), scenes.series("heading", times, heading)
    )


def test_a_heading_in_degrees_is_told_first_with_what_to_write(scenes: ModuleType) -> None:
    report = verify(wall(scenes), wall_drive(scenes, 1000.0 * DEGREES))
    # A thousand times as large again: no unit explains that.
    assert "check the unit, scale and offset of heading" in report.advice[0]

    report = verify(wall(scenes), wall_drive(scenes, DEGREES))

    assert report.verdict is Verdict.INCONCLUSIVE
    assert report.reasons[0].startswith("heading lies outside its domain for ")
    assert "the domain is -1.4 to 1.4 rad; read in deg, it would lie inside" in report.reasons[0]
    assert report.advice[0].endswith(
        "write `heading: {path: /heading.data, unit: deg}` in `trace:`"
    )
    assert not any("record longer" in advice for advice in report.advice)


def test_an_entry_with_more_than_a_path_is_added_to(scenes: ModuleType) -> None:
    report = verify(wall(scenes, delay=0.1), wall_drive(scenes, DEGREES))

    assert "add `unit: deg` to its entry" in report.advice[0]


def test_what_lies_outside_for_most_of_the_trace_comes_before_more_data(
    scenes: ModuleType,
) -> None:
    report = verify(wall(scenes), wall_drive(scenes, DEGREES, wrong_from=14.0))

    assert report.verdict is Verdict.INCONCLUSIVE
    assert report.variables
    assert "heading lies outside its domain" in report.reasons[0]
    assert "unit: deg" in report.advice[0]


def test_what_lies_inside_is_not_spoken_of(scenes: ModuleType) -> None:
    report = verify(wall(scenes), wall_drive(scenes))

    assert not any("outside" in reason for reason in report.reasons)


def test_of_several_recordings_the_one_outside_is_named(scenes: ModuleType) -> None:
    wrong = replace(wall_drive(scenes, DEGREES, wrong_from=14.0), source="b.csv")

    report = verify_together(wall(scenes), [wall_drive(scenes), wrong])

    assert any(reason.startswith("b.csv: heading lies outside") for reason in report.reasons)


@pytest.mark.parametrize(
    ("factor", "zero", "unit", "entry"),
    [
        (1.0, 273.15, "Celsius", "offset: 273.15 K"),
        (5.0 / 9.0, 255.372, "Fahrenheit", "scale: 0.555556, offset: 255.372 K"),
    ],
)
def test_a_temperature_with_another_zero_wants_an_offset(
    scenes: ModuleType, factor: float, zero: float, unit: str, entry: str
) -> None:
    spec = scenes.program(
        (scenes.state("room", 280.0, 320.0, unit=KELVIN),),
        (),
        {"room": "293 room sub 0.1 mul"},
        scenes.fidelity({"room": 0.5}, 5.0),
    )
    spec = replace(spec, bindings=(replace(spec.bindings[0], unit=KELVIN, path="T room"),))
    times = np.arange(0.0, 60.0, 0.1)
    kelvin = 293.15 + 5.0 * np.exp(-0.1 * times)
    drive = scenes.trace(scenes.series("room", times, (kelvin - zero) / factor))

    report = verify(spec, drive)

    assert "K, the domain is 280 to 320 K" in report.reasons[0]
    assert f"read in degrees {unit}, it would lie inside" in report.reasons[0]
    assert f"`room: {{path: 'T room', {entry}}}`" in report.advice[0]


# --- nothing to compare


def test_a_gap_is_named_as_what_cuts(scenes: ModuleType) -> None:
    drive = wall_drive(scenes)
    kept = np.mod(drive.series["heading"].times, 3.0) < 1.6
    heading = drive.series["heading"]
    cut = replace(heading, times=heading.times[kept], values=heading.values[kept])

    report = verify(wall(scenes), replace(drive, series=drive.series | {"heading": cut}))

    assert "cut by a gap in heading (27" in report.reasons[0]
    assert "without a gap in heading" in report.advice[0]


def test_every_open_verdict_says_what_to_do(scenes: ModuleType) -> None:
    drive = wall_drive(scenes)
    short = {
        name: replace(s, times=s.times[:30], values=s.values[:30])
        for name, s in drive.series.items()
    }
    rest = {"distance": drive.series["distance"]}

    for series in (short, rest):
        report = verify(wall(scenes), replace(drive, series=series))
        assert report.verdict is Verdict.INCONCLUSIVE
        assert report.advice
