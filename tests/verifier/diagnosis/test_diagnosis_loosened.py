"""Loosened programs, and parts of formulas that saturate or have dead zones."""

from pathlib import Path

import numpy as np
import pytest

import specc
from runtime.code import Code
from runtime.flow import flow_of
from runtime.machine import evaluate, run_tape
from verifier.diagnosis.loosened import gain_of, given_of, is_given_of, loosened_flow, offset_of
from verifier.diagnosis.wraps import wraps_of

SPECS = Path(__file__).parents[3] / "specs"


@pytest.mark.parametrize("name", ["wall_follow", "line_steps", "two_homes"])
@pytest.mark.parametrize("wraps", [False, True])
def test_a_loosened_program_is_the_program_itself_until_a_number_moves(
    name: str, *, wraps: bool
) -> None:
    program = specc.load_program(SPECS / f"{name}.yaml")
    plain, loose = flow_of(program), loosened_flow(program, wraps=wraps)
    rng = np.random.default_rng(1)
    low, high = (np.clip(edge, -3.0, 3.0) for edge in plain.domain)
    r = len(program.register)
    register = np.tile(loose.defaults, (50, 1))
    kept = len(program.states) + len(program.controls)
    register[:, :kept] = rng.uniform(low[:kept], high[:kept], (50, kept))

    one, other = run_tape(plain.tape, register[:, :r]), run_tape(loose.tape, register)

    # Tables are within their measured bound of the formula, 1e-4 here.
    assert other == pytest.approx(one, abs=2e-4, nan_ok=True)


def test_gain_offset_and_given_rates_act_as_they_say() -> None:
    program = specc.load_program(SPECS / "wall_follow.yaml")
    flow = loosened_flow(program, wraps=False)
    names = flow.program.register
    register = np.array([flow.defaults] * 3)
    register[:, 0], register[:, 1] = 1.0, 0.3
    plain = run_tape(flow.tape, register)[0, 1]
    register[1, names.index(gain_of("heading"))] = 1.5
    register[1, names.index(offset_of("heading"))] = 0.1
    register[2, names.index(is_given_of("heading"))] = 1.0
    register[2, names.index(given_of("heading"))] = 0.7

    found = run_tape(flow.tape, register)[:, 1]

    assert found[1] == pytest.approx(1.5 * plain + 0.1)
    assert found[2] == pytest.approx(0.7)


def test_the_difference_in_a_formula_can_have_a_dead_zone() -> None:
    program = specc.load_program(SPECS / "wall_follow.yaml")
    (wrap,) = (w for w in wraps_of(program) if w.words == "distance - wanted")
    flow = loosened_flow(program, wraps=True)
    register = np.array([flow.defaults] * 2)
    register[:, 0], register[:, 1] = [0.83, 0.9], 0.0
    register[:, flow.program.register.index(wrap.zone)] = 0.04

    found = run_tape(flow.tape, register)[:, 1]

    # stiffness 2, wanted 0.8: nothing within 4 cm, beyond it what is left of 10 cm.
    assert found == pytest.approx([0.0, -2.0 * 0.06])


def test_a_wrapped_part_is_read_as_it_was_written() -> None:
    code = wraps_of(specc.load_program(SPECS / "wall_follow.yaml"))[-1].code

    assert code == Code("distance wanted sub")
    assert evaluate([code], ("distance", "wanted"), np.array([[1.0, 0.8]]))[0, 0] == pytest.approx(
        0.2
    )
