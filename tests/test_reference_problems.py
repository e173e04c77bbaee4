"""Closed forms and published figures, from YAML through the compiler and the integrators.

Van der Pol at mu = 1: period 6.6632868593231... (Andersen & Geer, SIAM J. Appl. Math. 42, 1982).
"""

from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicHermiteSpline

import specc
from runtime.flow import Source
from runtime.program import Program
from runtime.simulate import Adaptive, simulate

SPECS = Path(__file__).parents[1] / "specs"
PERIOD = 6.66328686


def period(program: Program, source: Source) -> float:
    """The time between two upward crossings of x = 0, long after the transient has died."""
    rollout = simulate(
        program,
        {"x": 2.0, "v": 0.0},
        70.0,
        {"mu": 1.0},
        1e-3,  # Hermite interpolation between such samples is exact to 1e-13
        method=Adaptive(rtol=1e-11, atol=1e-12),
        source=source,
    )
    x, v = rollout.states.T
    late = rollout.times > 50.0
    crossings = CubicHermiteSpline(rollout.times[late], x[late], v[late]).roots(extrapolate=False)
    return float(crossings[2] - crossings[0])


@pytest.mark.parametrize("source", list(Source))
def test_van_der_pol_has_its_period_through_table_and_formula(source: Source) -> None:
    program = specc.load_program(SPECS / "van_der_pol.yaml")

    assert period(program, source) == pytest.approx(PERIOD, abs=1e-8)


def test_van_der_pol_has_its_period_through_a_linear_table(tmp_path: Path) -> None:
    text = (SPECS / "van_der_pol.yaml").read_text()
    spec = tmp_path / "linear.yaml"
    spec.write_text(text + "table: {method: linear, tolerance: {x: 1e-3, v: 5e-3}}\n")
    program = specc.load_program(spec)

    found = period(program, Source.TABLES)

    assert found == pytest.approx(PERIOD, abs=1e-3)
    assert found != pytest.approx(PERIOD, abs=1e-8), "a linear table can't be exact here"


def test_a_pendulum_through_its_table_stays_as_close_as_the_bound_promises() -> None:
    program = specc.load_program(SPECS / "pendulum.yaml")
    friction, duration = 0.3, 10.0
    rollout = simulate(
        program,
        {"angle": 2.5, "rate": 0.0},
        duration,
        {"friction": friction},
        0.1,
        method=Adaptive(rtol=1e-11, atol=1e-12),
    )
    solved = solve_ivp(
        lambda _t, z: [z[1], -friction * z[1] - 9.81 * np.sin(z[0])],
        (0.0, duration),
        [2.5, 0.0],
        method="DOP853",
        t_eval=rollout.times,
        rtol=1e-12,
        atol=1e-13,
    )
    bound = program.field.bounds[1].measured

    apart = np.abs(rollout.states - solved.y.T).max(axis=1)

    # Gronwall: apart(t) <= bound (exp(L t) - 1) / L, with L the largest growth of differences;
    # the symmetric part of the Jacobian [[0, 1], [-9.81 cos a, -0.3]] has L <= 5.26.
    growth = 5.26
    allowed = bound * np.expm1(growth * rollout.times) / growth + 1e-9
    assert np.all(apart <= allowed)
    # Far below that worst case: friction forgets errors about as fast as they are made.
    assert apart.max() <= 20.0 * bound / friction
