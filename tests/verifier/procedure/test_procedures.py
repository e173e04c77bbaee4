"""Test procedures of behaviors: who drives them and is faithful passes, who is not fails."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from runtime.arrays import Array
from runtime.code import Code
from runtime.program import Program
from specc.loading import load_program
from verifier.fidelity.together import verify_together
from verifier.procedure.behavior import procedure_of
from verifier.procedure.choosing import chosen_runs, reached
from verifier.procedure.driving import SHORT, Plans, driven_paths, inputs_of
from verifier.procedure.goals import Goals
from verifier.procedure.levels import threshold_levels
from verifier.procedure.model import Drive, Procedure
from verifier.procedure.remaining import remaining_runs
from verifier.procedure.wording import drive_phrase, log_sentence, run_sentences
from verifier.report.report import Report, Standing, Verdict
from verifier.traces.trace import Series, Trace

SPECS = Path(__file__).parents[3] / "specs"


@pytest.fixture(scope="module")
def wall() -> Program:
    return load_program(SPECS / "wall_follow.yaml", allow_code=False)


@pytest.fixture(scope="module")
def avoid() -> Program:
    return load_program(SPECS / "avoid.yaml", allow_code=False)


@pytest.fixture(scope="module")
def procedure(wall: Program) -> Procedure:
    return procedure_of(wall)


def along_the_wall(
    drive: Drive, every: float, rng: np.random.Generator, stiff: float, index: int
) -> Trace:
    """A drive of `wall_follow`, by scipy from the formula in its YAML, as noisy sensors log it.

    distance' = speed * sin(heading); heading' = stiffness * (wanted - distance) - damping *
    heading, where the robot's own stiffness is `stiff` times the one that it was set.
    """
    times: list[Array] = []
    states: list[Array] = []
    controls: list[Array] = []
    now, state = 0.0, np.array([drive.start["distance"], drive.start["heading"]])
    for stage in drive.stages:
        held = [stage.held[n] for n in ("wanted", "speed", "stiffness", "damping")]

        def rates(_: float, s: Array, held: list[float] = held) -> list[float]:
            wanted, speed, stiffness, damping = held
            turn = stiff * stiffness * (wanted - s[0]) - damping * s[1]
            return [speed * np.sin(s[1]), turn]

        ticks: Array = every * np.arange(round(stage.seconds / every) + 1.0)
        found = solve_ivp(
            rates, (0.0, ticks[-1]), state, t_eval=ticks, rtol=1e-9, atol=1e-10, method="DOP853"
        ).y.T
        times.append(now + ticks[:-1])
        states.append(found[:-1])
        controls.append(np.tile(held, (len(ticks) - 1, 1)))
        now, state = now + ticks[-1], found[-1]
    at, told, given_ = np.concatenate(times), np.concatenate(states), np.concatenate(controls)
    noisy = told + rng.standard_normal(told.shape) * [0.003, 0.004]
    columns = {"distance": noisy[:, 0], "heading": noisy[:, 1]}
    columns |= dict(zip(("wanted", "speed", "stiffness", "damping"), given_.T, strict=True))
    series = {n: Series(n, at, v, f"/{n}", "sensor") for n, v in columns.items()}
    return Trace(f"run {index}", series, {}, float(index), (), ())


def driven(wall: Program, procedure: Procedure, stiff: float, seed: int) -> Report:
    rng = np.random.default_rng(seed)
    traces: list[Trace] = []
    for drive in procedure.drives:
        for _ in range(drive.repeats):
            every = 1.0 / procedure.rate
            traces.append(along_the_wall(drive, every, rng, stiff, len(traces)))
    return verify_together(replace(wall, judge_when=None), traces)


def test_a_faithful_robot_that_drives_the_procedure_passes(
    wall: Program, procedure: Procedure
) -> None:
    report = driven(wall, procedure, 1.0, 1)
    assert report.verdict is Verdict.PASS, report.reasons
    assert report.coverage is not None
    assert report.coverage.is_reached


def test_a_robot_with_half_the_gain_that_drives_the_procedure_fails(
    wall: Program, procedure: Procedure
) -> None:
    report = driven(wall, procedure, 0.5, 1)
    assert report.verdict is Verdict.FAIL
    named = {r.name for r in report.variables if r.standing is Standing.EXCEEDED}
    assert "heading" in named


def test_its_rehearsal_says_so_beforehand(procedure: Procedure) -> None:
    found = procedure.rehearsal
    assert found is not None
    assert found.decides
    assert {each.variable for each in found.planted} == {"distance", "heading"}
    tolerances = {"distance": 0.03, "heading": 0.04}
    assert all(1.5 < p.departure / tolerances[p.variable] < 2.5 for p in found.planted)


def test_every_control_is_held_low_usual_and_high(wall: Program, procedure: Procedure) -> None:
    for control in wall.controls:
        held = [stage.held[control.name] for drive in procedure.drives for stage in drive.stages]
        thirds = {int(3 * (v - control.low) / (control.high - control.low)) for v in held}
        assert thirds == {0, 1, 2}, control.name


def test_every_start_lies_in_the_region(wall: Program, procedure: Procedure) -> None:
    assert wall.fidelity is not None
    for drive in procedure.drives:
        for name, (low, high) in wall.fidelity.region.items():
            assert low <= drive.start[name] <= high


def test_the_same_spec_has_the_same_procedure(wall: Program) -> None:
    one, other = (procedure_of(wall, is_rehearsed=False) for _ in range(2))
    assert one == other


def test_runs_are_told_in_words_with_units(procedure: Procedure) -> None:
    first = run_sentences(procedure)[0]
    assert first.startswith("run 1: start with distance 0.")
    assert " m and heading " in first
    assert "; run 6 s with wanted " in first
    assert "1/s" in first
    assert log_sentence(procedure).startswith(
        "log distance, heading, wanted, speed, stiffness and damping at 10 Hz; sensors no noisier"
    )


def test_what_is_sensed_is_brought_evenly_from_where_it_was(avoid: Program) -> None:
    procedure = procedure_of(avoid, is_rehearsed=False)
    told = drive_phrase(procedure, procedure.drives[0])
    assert ", bringing left to " in told
    assert told.endswith(" evenly")
    assert "side to_" in told


def test_a_quantity_that_is_moved_goes_evenly_from_its_start_to_its_end(avoid: Program) -> None:
    places = [avoid.register.index(n) for n in ("left", "right")]
    start = np.array([[0.0, 0.4, 1.0, 0.0]])
    held = np.zeros((1, 2, len(avoid.states) + len(avoid.controls)))
    held[0, :, places] = np.array([[1.0, 0.6], [1.1, 1.1]])
    paths = driven_paths(avoid, Plans(start, held, inputs_of(avoid), 1.0), 0.05, 0)
    left = paths.register[0, :, places[0]]
    expected = np.interp(paths.times, [0.0, 1.0, 2.0], [0.4, 1.0, 0.6])
    assert np.allclose(left, expected, atol=1e-9)


def test_a_run_ends_where_the_mode_changes_again_at_once(avoid: Program) -> None:
    """It begins in a mode that is left at its very start."""
    start = np.array([[0.0, 0.4, 1.5, 0.0], [0.0, 0.4, 0.5, 0.0]])
    held = np.append(start, np.zeros((2, 1)), axis=1)[:, None]
    paths = driven_paths(avoid, Plans(start, held, inputs_of(avoid), 1.0), 0.05, 0)
    assert paths.alive.tolist() == [0, len(paths.times)]
    assert SHORT >= 1.0


def test_levels_stand_on_either_side_of_each_threshold(avoid: Program) -> None:
    """`right >= left + 0.3`, right at 1 m, and the reverse: 0.2 m about 0.7 m and 1.3 m."""
    left = next(state for state in avoid.states if state.name == "left")
    assert np.allclose(threshold_levels(avoid, left), [0.5, 0.9, 1.1, 1.5], atol=0.002)


@settings(max_examples=60)
@given(st.integers(1, 12), st.integers(1, 8), st.integers(0, 10_000))
def test_runs_are_chosen_once_each_until_nothing_that_can_be_met_is_missing(
    runs: int, wanted: int, seed: int
) -> None:
    rng = np.random.default_rng(seed)
    gives = rng.integers(0, 4, (runs, wanted)).astype(float)
    needs = rng.integers(1, 5, wanted).astype(float)
    nothing = np.zeros(wanted, dtype=bool)
    goals = Goals(gives, needs, ("",) * wanted, nothing, (), np.zeros((runs, 0), dtype=np.int64))
    chosen = chosen_runs(goals, 0.0)
    assert len(set(chosen)) == len(chosen)
    most = np.minimum(gives.sum(axis=0) / needs, 1.0)
    assert np.all(reached(goals, chosen) >= most - 1e-9)


def test_nothing_is_left_to_drive_where_the_procedure_was_driven(
    wall: Program, procedure: Procedure
) -> None:
    seen = driven(wall, procedure, 1.0, 2).coverage
    assert remaining_runs(procedure, None) == tuple(range(len(procedure.drives)))
    assert remaining_runs(procedure, seen) == ()


def test_what_is_left_to_drive_goes_where_nobody_was(wall: Program, procedure: Procedure) -> None:
    part = replace(procedure, drives=procedure.drives[:1])
    seen = driven(wall, part, 1.0, 2).coverage
    assert seen is not None
    needy = replace(procedure, required=seen.share + 0.05)
    left = remaining_runs(needy, seen)
    assert left
    assert 0 not in left


def test_a_behavior_that_leaves_its_domain_at_once_has_no_runs_and_says_so(wall: Program) -> None:
    formula = (Code("1000"), Code("0"))
    field = replace(wall.field, tables=(), terms=(), bounds=(), formula=formula)
    found = procedure_of(replace(wall, field=field))
    assert found.drives == ()
    assert found.rehearsal is None
    assert found.remarks[0].startswith("no run of the behavior alone lasts long enough")


def test_a_bumper_is_held_at_what_it_can_say() -> None:
    """Halfway between two names there is nothing."""
    bumping = load_program(SPECS / "back_up_and_turn.yaml")
    random_walk = load_program(SPECS / "move_at_random.yaml")

    for program in (bumping, random_walk):
        assert procedure_of(program, is_rehearsed=False).drives
