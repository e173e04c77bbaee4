"""What a trace leaves open, on traces that are made to leave something open."""

from collections.abc import Callable
from dataclasses import replace
from types import ModuleType

import numpy as np
import pytest

from runtime.claim import Claim, Place
from runtime.code import Code
from runtime.program import Constant, Guard, Kind, Program, Role, Unit
from verifier.fidelity.shooting.study import Study
from verifier.fidelity.verify import judged
from verifier.limits.commands import levels
from verifier.limits.not_told import what_is_not_told
from verifier.report.limits import NotTold
from verifier.traces.trace import Trace

TIMES = np.arange(0.0, 40.0, 0.05)


def told(program: Program, trace: Trace) -> tuple[NotTold, ...]:
    return what_is_not_told(program, study(program, trace))


def study(program: Program, trace: Trace) -> Study:
    _, found = judged(program, trace)
    assert found is not None
    return found


def about(found: tuple[NotTold, ...], phrase: str) -> list[NotTold]:
    return [each for each in found if phrase in each.what]


def follower(scenes: ModuleType, *names: str, formula: str = "goal x sub") -> Program:
    """x goes to its goal with a rate of 1/s; `names` are constants with the value 1."""
    one = Unit("1", 1.0)
    return scenes.program(
        (scenes.state("x", -2.0, 2.0),),
        (scenes.control("goal", -1.0, 1.0, 0.0),),
        {"x": formula},
        scenes.fidelity({"x": 0.05}, 1.0, region={"x": (-0.8, 0.8)}),
        constants=tuple(Constant(name, one, 1.0, "", f"spec.yaml:{name}") for name in names),
    )


def followed(
    scenes: ModuleType, goal: Callable[[float], float], every: float = 2.0, noise: float = 0.003
) -> Trace:
    """A robot that follows goals which change every so many seconds."""
    switch = np.arange(0.0, 40.0, every)
    goals = np.array([goal(t) for t in switch])
    x = [0.0]
    for t in TIMES[:-1]:
        now = goals[int((t + 1e-9) // every)]
        x.append(now + (x[-1] - now) * np.exp(-0.05))
    measured = np.array(x) + noise * np.random.default_rng(2).standard_normal(len(x))
    return scenes.trace(scenes.series("x", TIMES, measured), scenes.series("goal", switch, goals))


def wandering(t: float) -> float:
    return float(np.sin(1.7 * t) * 0.95)


def test_levels_are_groups_of_near_values() -> None:
    assert levels(np.array([0.0, 1.0, 1.01, 0.0, 0.004]), 0.02) == pytest.approx([0.002, 1.005])


def test_of_inputs_that_vary_well_nothing_is_said(scenes: ModuleType) -> None:
    assert told(follower(scenes), followed(scenes, wandering)) == ()


def test_a_command_with_two_values_cannot_tell_gain_from_saturation(scenes: ModuleType) -> None:
    trace = followed(scenes, lambda t: 0.9 if (t // 2.0) % 2 else -0.9)

    [open_] = about(told(follower(scenes), trace), "gain of goal")

    assert open_.what == "a gain of goal apart from a saturation, a dead zone or an offset"
    assert "only two values, -0.9 and 0.9" in open_.why
    assert "5 values or more from -1 to 1" in open_.suggestion


def test_a_command_with_three_values_is_no_pair(scenes: ModuleType) -> None:
    trace = followed(scenes, lambda t: (-0.9, 0.0, 0.9)[int(t // 2.0) % 3])

    assert not about(told(follower(scenes), trace), "saturation")


def test_a_command_that_rarely_changed_tells_no_delay(scenes: ModuleType) -> None:
    trace = followed(scenes, lambda t: 0.9 if t >= 20.0 else -0.9, every=20.0)

    [open_] = about(told(follower(scenes), trace), "how late")

    assert open_.what == "how late the robot acts on goal"
    assert "changed once" in open_.why


@pytest.mark.parametrize("is_logged", [True, False])
def test_a_control_that_never_varied_is_named(scenes: ModuleType, *, is_logged: bool) -> None:
    trace = followed(scenes, lambda _: 0.5)
    if not is_logged:
        trace = replace(trace, series={"x": trace.series["x"]}, constants={"goal": 0.5})

    [open_] = about(told(follower(scenes), trace), "depends on goal")

    assert open_.names == ("goal",)
    assert "goal stayed at 0.5" in open_.why
    assert not about(told(follower(scenes), trace), "gain of goal")


def test_two_constants_that_stand_in_one_product_are_told_only_together(
    scenes: ModuleType,
) -> None:
    program = follower(scenes, "stiff", "soft", formula="stiff soft mul goal x sub mul")

    [open_] = about(told(program, followed(scenes, wandering)), "together")

    assert open_.what.startswith("stiff and soft apart from one another")
    assert open_.origin == "spec.yaml:stiff"


def test_constants_that_act_apart_are_told(scenes: ModuleType) -> None:
    program = follower(scenes, "stiff", "gain", formula="stiff gain goal mul x sub mul")

    assert told(program, followed(scenes, wandering)) == ()


def test_a_sum_of_two_constants_is_told_only_together_where_the_goal_stands_still(
    scenes: ModuleType,
) -> None:
    """x' = stiff (gain goal + shift - x): with one goal, gain and shift are one number."""
    formula = "stiff gain goal mul shift add x sub mul"
    program = follower(scenes, "stiff", "gain", formula=formula)
    zero = Constant("shift", Unit("1", 1.0), 0.0, "", "spec.yaml:shift")
    program = replace(program, constants=(*program.constants, zero))

    moving = told(program, followed(scenes, wandering))
    still = told(program, followed(scenes, lambda _: 0.8))

    assert not about(moving, "together")
    assert [each.names for each in about(still, "together")] == [("gain", "shift")]


def test_a_constant_that_acts_where_the_robot_never_was_has_no_effect(
    scenes: ModuleType,
) -> None:
    """Beyond 1.2, `wall` pushes back; the robot stays within 1."""
    program = follower(scenes, "wall", formula="goal x sub x 1.2 gt wall x 1.2 sub mul 0 where sub")

    found = told(program, followed(scenes, wandering))

    [open_] = about(found, "the value of wall")
    assert "depends visibly on wall" in open_.why
    assert "x from 1." in open_.suggestion


def test_a_state_that_never_moved_is_named(scenes: ModuleType) -> None:
    trace = followed(scenes, lambda _: 0.0)

    [open_] = about(told(follower(scenes), trace), "depends on x")

    assert "x stayed at about" in open_.why


def test_parts_of_the_region_that_were_not_visited_are_named(scenes: ModuleType) -> None:
    trace = followed(scenes, lambda t: abs(wandering(t)))

    found = about(told(follower(scenes), trace), "what the robot does where x")

    assert len(found) == 1
    assert "from -0.8 to " in found[0].what


def claim(state: str, at: str) -> Claim:
    return Claim(
        text="one saddle at x = 1.8",
        feature="saddle",
        least=1,
        most=1,
        other=False,
        places=(Place(state, Code(at), 0.01),),
        reaches=(),
        period=None,
        period_within=0.0,
        share=None,
        goes_to="",
        called="",
        over=(),
        settings=(),
        sketched=False,
        origin="spec.yaml:30:3",
    )


@pytest.mark.parametrize(("at", "is_open"), [("1.8", True), ("0.5", False)])
def test_a_claimed_feature_that_was_not_visited_is_named(
    scenes: ModuleType, at: str, *, is_open: bool
) -> None:
    program = replace(follower(scenes), claims=(claim("x", at),))

    found = about(told(program, followed(scenes, wandering)), "the spec claims")

    assert [each.origin for each in found] == (["spec.yaml:30:3"] if is_open else [])


def switching(scenes: ModuleType) -> Program:
    """Heating and cooling, and a mode `off` which nothing in the trace enters."""
    values = ("heat", "cool", "off")
    mode = scenes.state("mode", 0.0, 2.0, kind=Kind.DISCRETE, role=Role.BOTH, values=values)
    plain = scenes.program(
        (scenes.state("x", -2.0, 2.0), mode),
        (),
        {"x": "mode 0 eq 1 x sub -1 x sub where"},
        scenes.fidelity({"x": 0.1}, 0.5),
    )
    guards = (
        Guard(0, 1, Code("x 0.5 sub"), (), "spec.yaml:21:7"),
        Guard(1, 0, Code("-0.5 x sub"), (), "spec.yaml:24:7"),
        Guard(1, 2, Code("x 1.5 sub"), (), "spec.yaml:25:7"),
    )
    return replace(plain, field=replace(plain.field, mode="mode", guards=guards))


def test_modes_and_ways_that_were_not_seen_are_named(scenes: ModuleType) -> None:
    """The thermostat swings between -0.5 and 0.5, log(3) seconds each way."""
    half = np.log(3.0)
    phase = TIMES % (2.0 * half)
    rising = phase < half
    x = np.where(rising, 1.0 - 1.5 * np.exp(-phase), -1.0 + 1.5 * np.exp(-(phase - half)))
    trace = scenes.trace(
        scenes.series("x", TIMES, x + 0.003 * np.random.default_rng(1).standard_normal(len(x))),
        scenes.series("mode", TIMES, np.where(rising, 0.0, 1.0)),
    )

    found = told(switching(scenes), trace)

    assert [each.what for each in about(found, "mode is")] == [
        "what the robot does while mode is off"
    ]
    [way] = about(found, "goes from")
    assert way.what.startswith("when the robot goes from cool to off")
    assert way.origin == "spec.yaml:25:7"
