"""Reports made up for drawing: a heading that departs, positions that do not."""

import math

import numpy as np

from runtime.program import Unit
from verifier.report.report import (
    CellAxis,
    Coverage,
    Exclusion,
    HorizonFigure,
    Interval,
    Noise,
    RegionMean,
    Report,
    SpecIdentity,
    Standing,
    TraceIdentity,
    VariableResult,
    Verdict,
    WindowView,
)
from verifier.traces.trace import Loss

METRE = Unit("m", 1.0)
DEGREE = Unit("deg", math.pi / 180.0)
HORIZON = 5.0


def variable(
    name: str, unit: Unit, tolerance: float, mean: float, standing: Standing, windows: int
) -> VariableResult:
    rng = np.random.default_rng(3)
    figures = tuple(
        HorizonFigure(
            horizon=HORIZON * share,
            windows=windows,
            rmse=1.1 * abs(mean) * share,
            noise=0.1 * tolerance * share,
            departure=abs(mean) * share,
            interval=Interval(0.8 * abs(mean) * share, 1.2 * abs(mean) * share),
            tolerance=tolerance,
            standing=standing,
        )
        for share in (0.25, 0.5, 1.0)
    )
    around = Interval(mean - 0.1 * abs(mean), mean + 0.1 * abs(mean))
    region = RegionMean({"x": (0.0, 1.0)}, {}, None, None, 12, mean, around, standing)
    errors = mean + 0.2 * tolerance * rng.standard_normal(windows)
    errors[:1] = np.nan
    return VariableResult(
        name=name,
        unit=unit,
        period=0.0,
        tolerance=tolerance,
        standing=standing,
        noise=Noise(0.1 * tolerance, 4000, 0.1, 0.01 * tolerance, "second differences"),
        horizons=figures,
        systematic=0.5 * abs(mean),
        scatter=0.2 * tolerance,
        allowed_scatter=0.0,
        unjudged=0,
        moved=10.0,
        mean=mean,
        mean_interval=around,
        regions=(region,),
        worst=region,
        errors=errors,
        views=tuple(view(start, mean) for start in range(0, 80, 10)) if windows else (),
        origin="husky_drive.yaml:12:3",
    )


def view(start: float, mean: float) -> WindowView:
    times = np.linspace(start, start + HORIZON, 40)
    predicted = np.sin(times / 6.0)
    return WindowView(times, predicted + mean * (times - start) / HORIZON, predicted)


def coverage(axes: int) -> Coverage:
    shape = (6, 5, 4, 3)[:axes]
    samples = np.random.default_rng(5).poisson(6.0, shape).astype(np.int64)
    cells = tuple(CellAxis("xyzw"[k], METRE, -3.0, 3.0, count) for k, count in enumerate(shape))
    return Coverage(cells, samples, 5, float(np.mean(samples >= 5)), 0.6)


def report(
    verdict: Verdict = Verdict.FAIL,
    windows: int = 60,
    cells: Coverage | None = None,
    word: str = "",
    heading: str = "heading",
) -> Report:
    """A report; `word` is put wherever a stranger's text may stand."""
    starts = np.linspace(0.0, 75.0, windows)
    places = {"x": 3.0 * np.sin(starts / 12.0), "y": 3.0 * np.cos(starts / 9.0)}
    return Report(
        verdict=verdict,
        reasons=(f"heading departs by 1.8 deg{word}", f"x is within its tolerance{word}"),
        advice=(f"drive the left third as well{word}",),
        horizon=HORIZON,
        confidence=0.95,
        variables=(
            variable("x", METRE, 0.1, 0.01, Standing.WITHIN, windows),
            variable(heading, DEGREE, 0.02, -0.031, Standing.EXCEEDED, windows),
        ),
        coverage=cells,
        exclusions=(Exclusion(f"gap{word}", 1.2, 60),),
        losses=(Loss(f"not finite{word}", 3, f"/imu at 12.1 s{word}"),),
        notes=(f"times are sensor stamps{word}",),
        spec=SpecIdentity("husky_drive", f"husky_drive.yaml{word}", "a3" * 32),
        trace=TraceIdentity(f"husky.mcap{word}", 1.7e9, 78.2, 64.6),
        starts=starts,
        places=places,
        units={"x": METRE, "y": METRE, "heading": DEGREE},
    )
