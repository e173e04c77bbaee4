from dataclasses import replace
from types import ModuleType

import numpy as np
import pytest

from runtime.interpolation import tabulate
from runtime.program import Kind, Program, Role, Term
from runtime.table import Axis, Method
from spec_schema.diagnostics import SpecError
from verifier.fidelity.verify import verify
from verifier.report.report import Report, Standing, Verdict
from verifier.traces.trace import Trace

SEEDS = 40


def of(report: Report, name: str) -> object:
    return next(result for result in report.variables if result.name == name)


def with_tolerance(program: Program, **tolerance: float) -> Program:
    return replace(program, fidelity=replace(program.fidelity, tolerance=tolerance))


def shifted(trace: Trace, seconds: float, names: set[str]) -> Trace:
    moved = {
        name: replace(s, times=s.times + seconds) if name in names else s
        for name, s in trace.series.items()
    }
    return replace(trace, series=moved)


def test_a_faithful_robot_passes(scenes: ModuleType) -> None:
    report = verify(scenes.van_der_pol(), scenes.van_der_pol_drive(1, 60.0, 0.01))

    assert report.verdict is Verdict.PASS
    assert "x stays within 0.05 over 2 s" in report.reasons[0]


def true_departure(scenes: ModuleType, mu: float, seconds: float) -> float:
    """Of x after 2 s from a robot with mu = 1, both integrated by scipy from every half second."""
    calm = scenes.van_der_pol_drive(1, seconds, 0.0)
    x, v = calm.series["x"].values, calm.series["v"].values

    def rate(_: float, s: np.ndarray) -> list[float]:
        return [s[1], mu * (1.0 - s[0] ** 2) * s[1] - s[0]]

    times = np.array([0.0, 2.0])
    ends = [
        scenes.integrated(rate, [x[k], v[k]], times, 0.5)[-1, 0] - x[k + 40]
        for k in range(0, len(x) - 40, 10)
    ]
    return float(np.sqrt(np.mean(np.square(ends))))


def test_a_parameter_ten_per_cent_off_fails_by_what_it_is_off(scenes: ModuleType) -> None:
    spec = with_tolerance(scenes.van_der_pol("1.1"), x=0.03, v=0.1)
    truth = true_departure(scenes, 1.1, 60.0)

    report = verify(spec, scenes.van_der_pol_drive(1, 60.0, 0.01))

    assert report.verdict is Verdict.FAIL
    assert report.reasons[0].startswith("x departs by")
    assert of(report, "v").standing is Standing.WITHIN
    figure = of(report, "x").declared
    assert figure.departure == pytest.approx(truth, rel=0.1)
    assert figure.interval.low < truth < figure.interval.high


def test_a_departure_near_the_tolerance_is_undecided_and_asks_for_more(scenes: ModuleType) -> None:
    spec = with_tolerance(scenes.van_der_pol("1.1"), x=0.06)

    report = verify(spec, scenes.van_der_pol_drive(3, 20.0, 0.01))

    assert report.verdict is Verdict.INCONCLUSIVE
    assert "x may or may not stay within 0.06" in report.reasons[0]
    assert report.advice


def test_no_right_spec_fails_over_forty_seeds(scenes: ModuleType) -> None:
    drives = [scenes.van_der_pol_drive(seed, 20.0, 0.03) for seed in range(SEEDS)]

    verdicts = [verify(scenes.van_der_pol(), drive).verdict for drive in drives]

    assert Verdict.FAIL not in verdicts
    assert verdicts.count(Verdict.PASS) > SEEDS / 3


@pytest.mark.parametrize("seed", range(3))
def test_a_rollout_does_not_depart_from_its_own_spec(scenes: ModuleType, seed: int) -> None:
    report = verify(scenes.van_der_pol(), scenes.van_der_pol_drive(seed, 30.0, 0.0))

    # Runge-Kutta of order 4 with steps of 0.05 s, against DOP853 at 1e-9.
    assert all(result.declared.departure < 1e-5 for result in report.variables)


@pytest.mark.parametrize("seconds", [-1.0, 0.37, 1e4])
def test_the_figures_do_not_depend_on_when_it_was(scenes: ModuleType, seconds: float) -> None:
    drive = scenes.unicycle_drive(2, 40.0, 0.01)
    here = verify(scenes.unicycle(), drive)

    there = verify(scenes.unicycle(), shifted(drive, seconds, set(drive.series)))

    assert there.verdict is here.verdict
    for a, b in zip(here.variables, there.variables, strict=True):
        assert b.declared.departure == pytest.approx(a.declared.departure, rel=1e-6, abs=1e-9)


def test_a_fast_field_is_integrated_with_steps_that_fit_it(scenes: ModuleType) -> None:
    spec = scenes.program(
        (scenes.state("x", -5.0, 5.0),),
        (scenes.control("u", -2.0, 2.0, 0.0),),
        {"x": "30 u x sub mul"},
        scenes.fidelity({"x": 0.01}, 4.0),
    )
    times = np.arange(0.0, 60.0, 0.5)
    u = np.repeat(np.random.default_rng(1).uniform(-2.0, 2.0, 30), 4)
    # Half a second is fifteen time constants: each sample ends where the held input is.
    x = np.concatenate([[0.0], u[:-1]])

    report = verify(spec, scenes.trace(scenes.series("x", times, x), scenes.series("u", times, u)))

    assert of(report, "x").declared.rmse < 1e-4


def test_slow_samples_do_not_coarsen_the_integration(scenes: ModuleType) -> None:
    drive = scenes.van_der_pol_drive(1, 60.0, 0.0)
    slow = {
        n: replace(s, times=s.times[::10], values=s.values[::10]) for n, s in drive.series.items()
    }

    report = verify(scenes.van_der_pol(), replace(drive, series=slow))

    # One step per half second would be off by 0.02.
    assert of(report, "x").declared.rmse < 0.01 * 0.05


def test_turns_of_an_angle_do_not_matter(scenes: ModuleType) -> None:
    drive = scenes.unicycle_drive(2, 120.0, 0.01)
    heading = drive.series["heading"]
    assert np.ptp(heading.values) > np.pi
    wrapped = replace(heading, values=np.mod(heading.values + np.pi, 2.0 * np.pi) - np.pi)

    a = verify(scenes.unicycle(), drive)
    b = verify(scenes.unicycle(), replace(drive, series=drive.series | {"heading": wrapped}))

    assert of(b, "heading").declared.rmse == pytest.approx(of(a, "heading").declared.rmse, rel=1e-6)


def test_a_wrong_scale_is_named_with_its_size(scenes: ModuleType) -> None:
    report = verify(scenes.unicycle(1.1), scenes.unicycle_drive(4, 120.0, 0.01))

    assert report.verdict is Verdict.FAIL
    assert "heading departs" in " ".join(report.reasons)
    # The spec turns 1.1 times as fast as the robot: 1 / 1.1.
    assert any(r.startswith("heading moves 0.909 times as far") for r in report.reasons)


@pytest.mark.parametrize("seed", range(5))
def test_a_minute_tells_a_gain_three_percent_off(scenes: ModuleType, seed: int) -> None:
    # Turns of 1 rad within the horizon: 0.03 rad, and 0.02 are allowed.
    report = verify(scenes.unicycle(1.03), scenes.unicycle_drive(seed, 60.0, 0.01))

    assert of(report, "heading").standing is Standing.EXCEEDED
    assert (
        verify(scenes.unicycle(), scenes.unicycle_drive(seed, 60.0, 0.01)).verdict is Verdict.PASS
    )


def test_a_late_input_shows_and_its_declared_delay_heals_it(scenes: ModuleType) -> None:
    late = scenes.unicycle_drive(5, 120.0, 0.01, late=0.3)

    assert verify(scenes.unicycle(), late).verdict is Verdict.FAIL
    # A `delay: 0.3 s` in the trace mapping moves the measurements back by as much.
    healed = verify(scenes.unicycle(), shifted(late, -0.3, {"turn"}))
    assert all(result.standing is Standing.WITHIN for result in healed.variables)


def test_only_the_declared_horizon_decides(scenes: ModuleType) -> None:
    drive = scenes.unicycle_drive(6, 120.0, 0.002)
    x = drive.series["x"]
    # A wobble of the sensor with the horizon's own period: largest after half of it.
    swayed = replace(x, values=x.values + 0.2 * np.cos(2.0 * np.pi * x.times / 5.0))
    spec = with_tolerance(scenes.unicycle(), x=0.1)

    report = verify(spec, replace(drive, series=drive.series | {"x": swayed}))

    standings = [figure.standing for figure in of(report, "x").horizons]
    assert standings == [Standing.EXCEEDED, Standing.EXCEEDED, Standing.WITHIN]
    assert report.verdict is Verdict.PASS


def test_a_control_that_nobody_logged_forbids_a_verdict(scenes: ModuleType) -> None:
    drive = scenes.unicycle_drive(4, 60.0, 0.01)
    rest = {name: s for name, s in drive.series.items() if name != "turn"}

    report = verify(scenes.unicycle(), replace(drive, series=rest))

    assert report.verdict is Verdict.INCONCLUSIVE
    assert "turn is neither in the trace nor declared constant" in report.reasons[0]
    assert of(report, "heading").declared.rmse > 0.1


def test_a_control_declared_constant_is_known(scenes: ModuleType) -> None:
    spec = scenes.program(
        (scenes.state("x", -10.0, 10.0),),
        (scenes.control("k", 0.0, 2.0, 1.5),),
        {"x": "k x mul neg"},
        scenes.fidelity({"x": 0.01}, 1.0),
    )
    times = np.arange(0.0, 10.0, 0.05)
    rng = np.random.default_rng(7)
    drive = scenes.trace(scenes.series("x", times, 5.0 * np.exp(-0.5 * times)), k=0.5)
    noisy = replace(
        drive.series["x"], values=drive.series["x"].values + 0.002 * rng.standard_normal(200)
    )

    assert verify(spec, replace(drive, series={"x": noisy})).verdict is Verdict.PASS


def test_a_missing_state_is_said(scenes: ModuleType) -> None:
    drive = scenes.van_der_pol_drive(1, 30.0, 0.01)

    report = verify(scenes.van_der_pol(), replace(drive, series={"x": drive.series["x"]}))

    assert report.verdict is Verdict.INCONCLUSIVE
    assert report.reasons == ("v is not in the trace, and nothing can be compared without",)


def test_a_trace_shorter_than_the_horizon_is_said(scenes: ModuleType) -> None:
    report = verify(scenes.unicycle(), scenes.unicycle_drive(1, 4.25, 0.01))

    assert report.verdict is Verdict.INCONCLUSIVE
    assert report.reasons == ("the trace covers 0.0-4.2 s, the check needs 5.0 s",)


def test_a_spec_without_a_tolerance_cannot_be_verified(scenes: ModuleType) -> None:
    spec = scenes.van_der_pol()

    with pytest.raises(SpecError, match="V351") as caught:
        verify(replace(spec, fidelity=None), scenes.van_der_pol_drive(1, 10.0, 0.0))

    assert "fidelity:" in caught.value.diagnostics[0].help


def test_too_little_coverage_withholds_a_pass_and_says_where_to_drive(scenes: ModuleType) -> None:
    spec = scenes.van_der_pol()
    wide = replace(spec.fidelity, region={"x": (-3.0, 3.0), "v": (-4.0, 4.0)}, coverage=0.9)

    report = verify(replace(spec, fidelity=wide), scenes.van_der_pol_drive(1, 60.0, 0.01))

    assert report.verdict is Verdict.INCONCLUSIVE
    assert "of the region of x and v was seen, 90 % is required" in report.reasons[0]
    assert any(advice.startswith("record v from -4 to") for advice in report.advice)


def test_without_a_region_a_pass_says_how_far_it_reaches(scenes: ModuleType) -> None:
    spec = scenes.van_der_pol()
    bare = replace(spec, fidelity=replace(spec.fidelity, region={}, coverage=0.6))

    report = verify(bare, scenes.van_der_pol_drive(1, 60.0, 0.01))

    assert report.verdict is Verdict.PASS
    assert "the spec declares no region, so this holds where the robot was" in report.reasons[-1]


def test_states_with_stamps_of_their_own_are_compared_at_those(scenes: ModuleType) -> None:
    fast = scenes.van_der_pol_drive(8, 60.0, 0.01)
    v = fast.series["v"]
    slow = replace(v, times=v.times[::3], values=v.values[::3])
    # x keeps 20 Hz; v comes at 6.7 Hz.
    report = verify(scenes.van_der_pol(), replace(fast, series={"x": fast.series["x"], "v": slow}))

    assert report.verdict is Verdict.PASS


def test_a_table_gives_the_verdict_of_its_formula(scenes: ModuleType) -> None:
    spec = scenes.van_der_pol()
    axes = (Axis("x", -3.0, 3.0, 21, periodic=False), Axis("v", -4.0, 4.0, 21, periodic=False))
    x, v = np.meshgrid(*(a.low + a.step * np.arange(a.count) for a in axes), indexing="ij")
    table = tabulate(np.stack([v, (1.0 - x**2) * v - x], axis=-1), axes, Method.CUBIC)
    terms = tuple(Term(i, scenes.Code("1"), 0, i) for i in range(2))
    tabulated = replace(spec, field=replace(spec.field, tables=(table,), terms=terms))
    drive = scenes.van_der_pol_drive(1, 60.0, 0.01)

    a, b = verify(spec, drive), verify(tabulated, drive)

    # Cubic splines with not-a-knot ends reproduce a cubic polynomial.
    assert of(b, "v").declared.rmse == pytest.approx(of(a, "v").declared.rmse, rel=1e-6)
    assert b.verdict is Verdict.PASS


@pytest.mark.parametrize(("gain", "verdict"), [(0.8, Verdict.PASS), (0.5, Verdict.FAIL)])
def test_a_step_map_is_judged_on_its_clock(
    scenes: ModuleType, gain: float, verdict: Verdict
) -> None:
    plain = scenes.program(
        (scenes.state("x", -5.0, 5.0),),
        (scenes.control("u", -1.0, 1.0, 0.0),),
        {"x": f"{gain} x mul u add"},
        scenes.fidelity({"x": 0.2}, 0.5),
    )
    spec = replace(plain, field=replace(plain.field, form="step", every=0.1))
    rng = np.random.default_rng(3)
    times = 0.1 * np.arange(400)
    u = np.repeat(rng.uniform(-1.0, 1.0, 80), 5)
    x = np.zeros(400)
    for k in range(399):
        x[k + 1] = 0.8 * x[k] + u[k]
    measured = x + 0.02 * rng.standard_normal(400)

    report = verify(
        spec, scenes.trace(scenes.series("x", times, measured), scenes.series("u", times, u))
    )

    assert report.verdict is verdict


def test_the_noise_of_a_sensed_input_is_not_taken_for_a_departure(scenes: ModuleType) -> None:
    sensed = scenes.state("d", -5.0, 5.0, role=Role.SENSED)
    spec = scenes.program(
        (scenes.state("x", -50.0, 50.0), sensed),
        (),
        {"x": "d"},
        scenes.fidelity({"x": 0.1}, 2.0),
    )
    rng = np.random.default_rng(5)
    times = np.arange(0.0, 120.0, 0.1)
    d = np.sin(0.2 * times)
    x = np.concatenate([[0.0], np.cumsum(0.1 * d[:-1])])
    drive = scenes.trace(
        scenes.series("x", times, x + 0.002 * rng.standard_normal(len(x))),
        scenes.series("d", times, d + 0.2 * rng.standard_normal(len(d))),
    )

    figure = of(verify(spec, drive), "x").declared

    # Twenty held samples of noise 0.2, each for 0.1 s: 0.2 * 0.1 * sqrt(20) = 0.089.
    assert figure.rmse == pytest.approx(0.089, rel=0.25)
    assert figure.departure < 0.5 * figure.rmse


def test_a_discrete_state_is_taken_as_measured(scenes: ModuleType) -> None:
    mode = scenes.state("mode", 0.0, 1.0, kind=Kind.DISCRETE, values=("slow", "fast"))
    spec = scenes.program(
        (scenes.state("x", -100.0, 100.0), mode),
        (),
        {"x": "mode 1 eq 1 0.2 where"},
        scenes.fidelity({"x": 0.05}, 1.0),
    )
    times = np.arange(0.0, 30.0, 0.1)
    switches = np.arange(0.0, 30.0, 2.0)
    modes = (np.arange(15) % 2).astype(float)
    rate = np.where(modes == 1.0, 1.0, 0.2)
    edges = np.concatenate([[0.0], np.cumsum(2.0 * rate)])
    x = np.interp(times, np.append(switches, 30.0), edges)
    drive = scenes.trace(scenes.series("x", times, x), scenes.series("mode", switches, modes))

    report = verify(spec, drive)

    assert report.verdict is Verdict.PASS


def test_a_pass_that_standing_still_would_earn_says_so(scenes: ModuleType) -> None:
    spec = scenes.program(
        (scenes.state("x", -5.0, 5.0),), (), {"x": "0.02"}, scenes.fidelity({"x": 0.1}, 1.0)
    )
    times = np.arange(0.0, 30.0, 0.1)

    report = verify(spec, scenes.trace(scenes.series("x", times, 0.02 * times)))

    assert report.verdict is Verdict.PASS
    assert "a spec in which it stays where it is would pass as well" in report.reasons[1]


def restless(scenes: ModuleType, seed: int, seconds: float, unrest: float) -> tuple[Program, Trace]:
    """A robot that follows x' = -x + u but for white unrest, exact between its samples."""
    spec = scenes.program(
        (scenes.state("x", -5.0, 5.0),),
        (scenes.control("u", -2.0, 2.0, 0.0),),
        {"x": "u x sub"},
        scenes.fidelity({"x": 0.1}, 1.0),
    )
    rng = np.random.default_rng(seed)
    times = np.arange(0.0, seconds, 0.05)
    u = np.repeat(rng.uniform(-1.0, 1.0, len(times) // 20 + 1), 20)[: len(times)]
    x = np.zeros(len(times))
    decay = np.exp(-0.05)
    for k in range(len(times) - 1):
        kick = unrest * np.sqrt((1.0 - decay**2) / 2.0) * rng.standard_normal()
        x[k + 1] = u[k] + (x[k] - u[k]) * decay + kick
    measured = x + 0.005 * rng.standard_normal(len(x))
    return spec, scenes.trace(scenes.series("x", times, measured), scenes.series("u", times, u))


def test_unrest_beyond_the_tolerance_condemns_no_robot(scenes: ModuleType) -> None:
    # Single runs scatter by 0.3 * sqrt((1 - exp(-2)) / 2) = 0.197, twice the tolerance.
    reports = [verify(*restless(scenes, seed, 60.0, 0.3)) for seed in range(SEEDS)]

    assert all(report.verdict is Verdict.INCONCLUSIVE for report in reports)
    scatters = [report.variables[0].scatter for report in reports]
    assert np.mean(scatters) == pytest.approx(0.197, rel=0.1)
    assert "but not alike in the same situation" in reports[0].reasons[0]
    assert "fidelity: {scatter: {x:" in reports[0].advice[0]


def test_a_spec_that_allows_the_scatter_passes_the_restless_robot(scenes: ModuleType) -> None:
    spec, drive = restless(scenes, 1, 600.0, 0.3)
    allowing = replace(spec, fidelity=replace(spec.fidelity, scatter={"x": 0.25}))

    report = verify(allowing, drive)

    assert report.verdict is Verdict.PASS
    assert "beside the scatter of 0.25 that the spec allows" in report.reasons[0]


def test_unrest_does_not_hide_a_wrong_gain(scenes: ModuleType) -> None:
    spec, drive = restless(scenes, 2, 600.0, 0.1)
    formula = (scenes.Code("0.6 u x sub mul"),)
    wrong = replace(spec, field=replace(spec.field, formula=formula))

    report = verify(wrong, drive)

    assert report.verdict is Verdict.FAIL
    assert "systematically: where x is" in report.reasons[0]
    assert report.reasons[-1].startswith("systematic is what repeats")


def test_noise_that_the_spec_declares_is_not_estimated(scenes: ModuleType) -> None:
    spec = scenes.van_der_pol()
    sure = replace(spec.bindings[0], noise=0.02, origin="scene.yaml:7:3")

    drive = scenes.van_der_pol_drive(1, 60.0, 0.01)
    noise = of(verify(replace(spec, bindings=(sure, *spec.bindings[1:])), drive), "x").noise

    assert noise.sigma == 0.02
    assert noise.method == "declared at scene.yaml:7:3"


def test_noise_that_the_field_makes_grow_is_named_with_what_would_help(scenes: ModuleType) -> None:
    # x'' = 9 x: what is not known of the start grows by e^3 a second.
    spec = scenes.program(
        (scenes.state("x", -50.0, 50.0), scenes.state("v", -150.0, 150.0)),
        (scenes.control("u", -20.0, 20.0, 0.0),),
        {"x": "v", "v": "9 x mul u add"},
        scenes.fidelity({"x": 0.1}, 2.0),
    )
    rng = np.random.default_rng(9)
    times = np.arange(0.0, 60.0, 0.05)
    x, v, inputs = np.zeros(1200), np.zeros(1200), np.zeros(1200)
    grown, swept = np.cosh(0.15), np.sinh(0.15) / 3.0
    for k in range(1199):
        inputs[k] = np.clip(-18.0 * x[k] - 6.0 * v[k] + rng.normal(), -20.0, 20.0)
        rest = -inputs[k] / 9.0
        x[k + 1] = rest + (x[k] - rest) * grown + v[k] * swept
        v[k + 1] = 9.0 * (x[k] - rest) * swept + v[k] * grown
    noisy = [values + 0.01 * rng.standard_normal(1200) for values in (x, v)]
    drive = scenes.trace(
        scenes.series("x", times, noisy[0]),
        scenes.series("v", times, noisy[1]),
        scenes.series("u", times, inputs),
    )

    report = verify(spec, drive)

    assert report.verdict is Verdict.INCONCLUSIVE
    assert "the field carries apart what starts together" in report.advice[0]
    assert "a horizon of at most" in report.advice[0]
