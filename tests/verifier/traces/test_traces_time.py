"""Times: which clock, in what order, with what gaps."""

from itertools import combinations
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from runtime.program import Kind, Role
from spec_schema.diagnostics import SpecError
from verifier.traces.cleaning import Ordering, longest_run, order
from verifier.traces.read import read_trace
from verifier.traces.trace import Trace

SECOND = 1_000_000_000


def seconds(*times: float) -> Any:
    return np.round(np.array(times) * SECOND).astype(np.int64)


def taken(values: Any, ordering: Ordering) -> Any:
    return values if ordering.rows is None else values[ordering.rows]


def ordered(*times: float) -> tuple[list[float], dict[str, int]]:
    found = order("/a", seconds(*times), np.ones(len(times), dtype=np.bool_))
    kept = (taken(seconds(*times), found) / SECOND).tolist()
    return kept, {loss.cause: loss.count for loss in found.losses}


def test_late_samples_are_sorted_and_counted() -> None:
    found = order("/a", seconds(0.0, 0.2, 0.1, 0.3), np.ones(4, dtype=np.bool_))

    assert taken(np.arange(4), found).tolist() == [0, 2, 1, 3]
    assert found.losses == ()
    assert found.notes == ("/a: 1 samples out of order, sorted",)


def test_of_repeated_times_the_first_is_kept() -> None:
    found = order("/a", seconds(0.0, 0.1, 0.1, 0.1, 0.2), np.ones(5, dtype=np.bool_))

    assert taken(np.arange(5), found).tolist() == [0, 1, 4]
    assert [(loss.cause, loss.count) for loss in found.losses] == [("repeated times", 2)]


def test_a_single_stamp_from_the_future_is_dropped() -> None:
    kept, losses = ordered(0.0, 0.1, 1000.0, 0.2, 0.3, 0.4)

    assert kept == [0.0, 0.1, 0.2, 0.3, 0.4]
    assert losses == {"clock set back": 1}


def test_when_the_clock_is_set_back_the_longest_run_is_kept() -> None:
    kept, losses = ordered(50.0, 50.1, 50.2, 10.0, 10.1, 10.2, 10.3, 10.4)

    assert kept == [10.0, 10.1, 10.2, 10.3, 10.4]
    assert losses == {"clock set back": 3}


def test_a_long_run_survives_a_clock_that_is_set_back() -> None:
    first, second = np.arange(100.0, 130.0, 0.5), np.arange(0.0, 50.0, 0.5)

    kept, losses = ordered(*first, *second)

    assert kept == second.tolist()
    assert losses == {"clock set back": first.size}


@given(st.lists(st.integers(0, 20), max_size=12))
def test_the_longest_run_is_the_longest_there_is(times: list[int]) -> None:
    run = longest_run(np.array(times, dtype=np.int64))

    chosen = [times[row] for row in run]
    orders = (c for n in range(len(times), -1, -1) for c in combinations(times, n))
    longest = next(len(c) for c in orders if list(c) == sorted(c))
    assert (np.diff(run) > 0).all()
    assert chosen == sorted(chosen)
    assert len(chosen) == longest


def test_late_samples_survive_beside_a_clock_that_is_set_back() -> None:
    kept, losses = ordered(0.0, 0.2, 0.1, 0.3, 99.0, 0.4, 0.6, 0.5)

    assert kept == [0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6]
    assert losses == {"clock set back": 1}


def test_a_clock_that_starts_in_1970_leaves_a_gap() -> None:
    found = order("/a", seconds(0.0, 0.1, 1.7e9, 1.7e9 + 0.1), np.ones(4, dtype=np.bool_))

    assert found.rows is None
    assert "1 gap, the largest 1.7e+09 s" in found.notes[0]


def test_gaps_are_counted_and_the_largest_is_named() -> None:
    times = np.arange(0.0, 10.0, 0.1)
    times[50:] += 1.8
    times[70:] += 0.7

    found = order("/a", seconds(*times), np.ones(times.size, dtype=np.bool_))

    assert found.notes == ("/a: 2 gaps, the largest 1.9 s after 4.9 s",)


@given(st.lists(st.integers(-(10**12), 10**12), max_size=60), st.randoms())
def test_times_always_increase_and_every_sample_is_accounted_for(
    times: list[int], random: Any
) -> None:
    usable = np.array([random.random() < 0.9 for _ in times], dtype=np.bool_)

    found = order("/a", np.array(times, dtype=np.int64), usable)

    kept = taken(np.array(times, dtype=np.int64), found)
    assert (np.diff(kept) > 0).all()
    assert taken(usable, found).all()
    assert len(kept) + sum(loss.count for loss in found.losses) == len(times)


def odometry_log(workshop: Any, stamp: Any, count: int = 40, **options: Any) -> Any:
    """Odometry every 0.1 s, logged 20 ms late, stamped with `stamp(i)`."""
    notes = [
        workshop.cdr("/odom", 100.0 + 0.1 * i + 0.02, workshop.odometry(stamp(i), x=float(i)))
        for i in range(count)
    ]
    return workshop.mcap(notes, **options)


X = "/odom.pose.pose.position.x"


def test_sensor_stamps_are_preferred_and_the_lateness_is_said(workshop: Any) -> None:
    trace = workshop.read(odometry_log(workshop, lambda i: 100.0 + 0.1 * i), x=X)

    assert trace.series["x"].clock == "sensor"
    assert trace.start == pytest.approx(100.0, abs=1e-6)
    assert any("logged 20 ms after the sensor stamp" in note for note in trace.notes)


def test_log_times_are_taken_when_asked_for(workshop: Any) -> None:
    trace = workshop.read(odometry_log(workshop, lambda i: 100.0 + 0.1 * i), "log", x=X)

    assert trace.series["x"].clock == "log"
    assert trace.start == pytest.approx(100.02, abs=1e-6)


@pytest.mark.parametrize(
    ("stamp", "why"),
    [
        (lambda _: 0.0, "zero"),
        (lambda _: 55.0, "stand still"),
        (lambda i: 200.0 - 0.1 * i, "backwards"),
        (lambda i: 100.0 + 0.01 * i, "span"),
    ],
)
def test_stamps_that_are_no_times_are_not_used(workshop: Any, stamp: Any, why: str) -> None:
    trace = workshop.read(odometry_log(workshop, stamp), x=X)

    assert trace.series["x"].clock == "log"
    assert any("log times" in note and why in note for note in trace.notes)


def test_asking_for_stamps_that_do_not_exist_is_an_error(workshop: Any) -> None:
    path = odometry_log(workshop, lambda _: 0.0)

    with pytest.raises(SpecError, match=r"V312.*/odom.*zero"):
        workshop.read(path, "sensor", x=X)


def test_stamps_in_simulated_time_serve_a_log_that_has_only_those(workshop: Any) -> None:
    trace = workshop.read(odometry_log(workshop, lambda i: 7.0 + 0.1 * i), x=X)

    assert trace.series["x"].clock == "sensor"
    assert trace.start == pytest.approx(7.0)


def two_topics(workshop: Any, make: Any, shift: float) -> Trace:
    odometry = [
        workshop.cdr(
            "/odom", 100.0 + 0.1 * i, workshop.odometry(100.0 + 0.1 * i + shift, x=float(i))
        )
        for i in range(40)
    ]
    commands = [make.said("/cmd", 100.0 + 0.1 * i, v=1.0) for i in range(40)]
    path = workshop.mcap([*odometry, *commands])
    program = make.program([make.state("x")], {"x": X, "v": "/cmd.v"}, controls=["v"])
    return read_trace(path, program)


def test_stamps_and_log_times_of_one_clock_stand_side_by_side(workshop: Any, make: Any) -> None:
    trace = two_topics(workshop, make, -0.01)

    assert trace.series["x"].clock == "sensor"
    assert trace.series["v"].clock == "log"
    assert trace.series["v"].times[0] == pytest.approx(0.01, abs=1e-6)


def test_stamps_of_another_clock_do_not_stand_beside_log_times(workshop: Any, make: Any) -> None:
    trace = two_topics(workshop, make, -90.0)

    assert trace.series["x"].clock == trace.series["v"].clock == "log"
    assert any("log times are used for every topic" in note for note in trace.notes)


def test_zero_stamps_among_good_ones_are_lost_and_counted(workshop: Any) -> None:
    trace = workshop.read(odometry_log(workshop, lambda i: 0.0 if i == 3 else 100.0 + 0.1 * i), x=X)

    assert 3.0 not in trace.series["x"].values
    assert [(loss.cause, loss.count) for loss in trace.losses] == [("samples without a stamp", 1)]


def test_a_delay_moves_a_series_back_and_the_start_with_it(workshop: Any, make: Any) -> None:
    path = workshop.text("t,x,y\n10,1,1\n11,2,2\n")
    late = make.binding("y", "y", delay=0.25)

    trace = read_trace(
        path, make.program([make.state("x"), make.state("y")], {"x": "x", "y": late})
    )

    assert trace.start == 9.75
    assert trace.series["x"].times.tolist() == [0.25, 1.25]
    assert trace.series["y"].times.tolist() == [0.0, 1.0]


def test_scale_unit_and_offset_are_applied_in_that_order(workshop: Any, make: Any) -> None:
    from runtime.program import Unit

    path = workshop.text("t,x\n0,90\n1,180\n")
    bound = make.binding("x", "x", scale=-1.0, offset=0.5, unit=Unit("deg", np.pi / 180.0))

    trace = read_trace(path, make.program([make.state("x")], {"x": bound}))

    np.testing.assert_allclose(trace.series["x"].values, [0.5 - np.pi / 2, 0.5 - np.pi], rtol=1e-15)


def test_a_periodic_state_is_unwrapped_by_its_own_period(workshop: Any, make: Any) -> None:
    angles = np.linspace(0.0, 40.0, 100)
    rows = "".join(f"{0.1 * i:.1f},{float(angle % 3.0)!r}\n" for i, angle in enumerate(angles))
    turning = make.state("h", Kind.PERIODIC, low=0.0, high=3.0)

    trace = read_trace(workshop.text("t,h\n" + rows), make.program([turning], {"h": "h"}))

    np.testing.assert_allclose(trace.series["h"].values, angles, atol=1e-12)


def test_constants_are_handed_on(workshop: Any, make: Any) -> None:
    program = make.program(
        [make.state("x")], {"x": "x", "gain": make.binding("gain", "", constant=2.5)}, ["gain"]
    )

    trace = read_trace(workshop.text("t,x\n0,1\n1,2\n"), program)

    assert trace.constants == {"gain": 2.5}
    assert set(trace.series) == {"x"}


def test_our_own_recordings_need_no_bindings(workshop: Any, make: Any) -> None:
    notes = [make.said("/drive/state", 0.1 * i, x=float(i), y=0.0) for i in range(10)]
    notes += [make.said("/drive/control", 0.1 * i, v=0.5) for i in range(10)]
    program = make.program([make.state("x"), make.state("y")], {}, controls=["v"])

    trace = read_trace(workshop.mcap(notes), program)

    assert set(trace.series) == {"x", "y", "v"}
    assert trace.series["x"].path == "/drive/state.x"


def test_a_control_that_was_not_logged_is_left_out(workshop: Any, make: Any) -> None:
    sensed = make.state("wall", role=Role.SENSED)
    program = make.program([make.state("x"), sensed], {"x": "x"}, controls=["v"])

    trace = read_trace(workshop.text("t,x\n0,1\n1,2\n"), program)

    assert set(trace.series) == {"x"}


def test_a_driven_state_that_is_not_bound_is_an_error(workshop: Any, make: Any) -> None:
    program = make.program([make.state("x"), make.state("y")], {"x": "x"})

    with pytest.raises(SpecError, match=r"(?s)V310.*'y'.*columns: t, x"):
        read_trace(workshop.text("t,x\n0,1\n1,2\n"), program)


def test_all_zero_poses_are_noted(workshop: Any, make: Any) -> None:
    rows = "".join(f"{i},{i % 5},{i % 5}\n" for i in range(20))
    program = make.program([make.state("x"), make.state("y")], {"x": "x", "y": "y"})

    trace = read_trace(workshop.text("t,x,y\n" + rows), program)

    assert any("in 4 of 20 samples everything that is read is zero" in n for n in trace.notes)


def test_a_zero_quaternion_is_a_lost_sample(workshop: Any) -> None:
    message = workshop.odometry(1.0)
    message.pose.pose.orientation.w = 0.0
    good = [workshop.cdr("/odom", 2.0 + i, workshop.odometry(2.0 + i, yaw=0.3)) for i in range(3)]
    path = workshop.mcap([workshop.cdr("/odom", 1.0, message), *good])

    trace = workshop.read(path, h="/odom.pose.pose.orientation.@yaw")

    np.testing.assert_allclose(trace.series["h"].values, [0.3] * 3, atol=1e-12)
    assert [(loss.cause, loss.count) for loss in trace.losses] == [("no finite value", 1)]


def test_series_cannot_be_written_to(workshop: Any) -> None:
    series = workshop.read(workshop.text("t,x\n0,1\n1,2\n"), x="x").series["x"]

    with pytest.raises(ValueError, match="read-only"):
        series.values[0] = 5.0
    with pytest.raises(ValueError, match="read-only"):
        series.times[0] = 5.0
