"""What a recorded node's report tells beside its figures: contacts, and controls as recorded."""

from dataclasses import replace
from types import ModuleType

import numpy as np
import pytest

from runtime.program import Control, Role, Unit
from tests.runtime.behaviors import formula_program, state
from verifier.architectures.telling import controls_as_recorded, with_touches
from verifier.fidelity.stretches.needs import needs_of
from verifier.fidelity.verify import verify
from verifier.report.report import Report, Verdict
from verifier.traces.trace import TICKS, Series, Trace

TIMES = np.arange(0.0, 10.0, 0.1)
EVERYWHERE = np.ones(TIMES.size, dtype=np.bool_)


@pytest.fixture
def report(scenes: ModuleType) -> Report:
    found = verify(scenes.van_der_pol(), scenes.van_der_pol_drive(1, 60.0, 0.01))
    return replace(found, verdict=Verdict.FAIL, reasons=("x departs", "so it is"))


def test_a_departure_says_how_long_the_body_touched_something(report: Report) -> None:
    told = with_touches(report, TIMES, EVERYWHERE, TIMES < 4.0 - 1e-9)

    assert told.reasons[0].startswith("x departs; in 4 s of the 9.9 s in which it had its way")
    assert told.reasons[1:] == ("so it is",)


def test_contacts_while_others_have_their_way_and_those_of_a_pass_are_not_told(
    report: Report,
) -> None:
    touches = TIMES < 4.0

    assert with_touches(report, TIMES, ~touches, touches) is report
    passed = replace(report, verdict=Verdict.PASS)
    assert with_touches(passed, TIMES, EVERYWHERE, touches) is passed


def test_a_control_that_was_recorded_otherwise_than_the_spec_has_it_is_told(
    scenes: ModuleType,
) -> None:
    gain = Control("gain", Unit("1/s", 1.0), 0.0, 3.0, 0.5, "", "spec.yaml:1:1")
    program = replace(scenes.van_der_pol(), controls=(gain,))

    assert controls_as_recorded(program, {"gain": np.full(9, 1.5)}) == (
        "gain is 1.5 1/s, as recorded; the spec's default is 0.5 1/s",
    )
    assert controls_as_recorded(program, {"gain": np.full(9, 0.5)}) == ()
    assert controls_as_recorded(program, {}) == ()


@pytest.mark.parametrize(("clock", "is_noisy"), [("sensor", True), ("log", True), (TICKS, False)])
def test_what_a_node_sampled_at_its_own_ticks_has_no_noise_beside_what_it_acted_on(
    clock: str, *, is_noisy: bool
) -> None:
    sensed = replace(state("near", 0.0, 1.0), role=Role.SENSED)
    program = formula_program((state("x", -1.0, 1.0), sensed), {"x": "near"})
    series = {n: Series(n, TIMES, 0.5 + 0.0 * TIMES, n, clock) for n in ("x", "near")}

    (given,) = needs_of(program, Trace("run", series, {}, 0.0, (), ())).inputs

    assert given.is_sensed
    assert given.is_noisy is is_noisy
