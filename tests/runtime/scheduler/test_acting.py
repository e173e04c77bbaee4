"""Who acts: choices in effect, what they set, arbiters above arbiters, inhibition."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
import pytest

from runtime.arbiter import Arbiter, Paradigm, Read, Rule
from runtime.architecture import Way
from runtime.code import Code
from runtime.program import Kind, Noise, Program, Role
from runtime.scheduler.scheduler import Scheduler
from runtime.user_code import UserCodeError
from tests.runtime.behaviors import formula_program, state
from tests.runtime.scheduler.plane import (
    HERE,
    ONE,
    SOURCE,
    STEP,
    N,
    Noted,
    Plain,
    Plane,
    architecture,
    resolution,
    scenario,
)
from tests.runtime.scheduler.test_channels import wants

BIG = 1e9


def arbiter(choices: Sequence[str], paradigm: Paradigm, **parts: object) -> Arbiter:
    """An arbiter that reads `x`, of one paradigm."""
    plain = Arbiter(
        name="choose",
        about="",
        reads=(Read("x", ONE, -BIG, BIG, Kind.CONTINUOUS, (), "", HERE),),
        controls=(),
        constants=(),
        outputs=(),
        choices=tuple(choices),
        paradigm=paradigm,
        rules=(),
        weights=(),
        competition=None,
        plan=None,
        module="",
        agreement=None,
        bindings=(),
        judge_when=None,
        source=SOURCE,
    )
    return replace(plain, **parts)  # type: ignore[arg-type]  # its fields by name


def by_rules(choices: Sequence[str], *rules: tuple[str, str | None]) -> Arbiter:
    """The first rule that holds: (choice, when)."""
    made = tuple(
        Rule(choices.index(choice), Code(when) if when else None, None, 0.0, HERE)
        for choice, when in rules
    )
    return arbiter(choices, Paradigm.RULES, rules=made)


def by_weights(**weights: str) -> Arbiter:
    codes = tuple(map(Code, weights.values()))
    return arbiter(tuple(weights), Paradigm.WEIGHTS, weights=codes)


def chooser(
    name: str,
    decides: Arbiter,
    choices: Mapping[str, Sequence[str] | tuple[Sequence[str], Mapping[str, float]]],
    response: int = 0,
    level: int = 1,
) -> N:
    return N(name, decides, STEP, response * STEP, {"x": "pos.x"}, choices=choices, level=level)


def seek(name: str, speed: float) -> N:
    return N(name, wants(speed), STEP, 0.0, {"x": "pos.x"}, {"x": ("speed", "set-point")})


def speeds(
    nodes: Sequence[N], way: Way, instants: int, arbiter: int = -1
) -> tuple[list[float], Noted]:
    """What channel x gets at each instant, when nodes read the number of the instant as x."""
    plane = Plane(outside=lambda _robot, _sensor, time: (round(time / STEP), 0.0))
    noted = Noted()
    reaching = tuple(i for i, node in enumerate(nodes) if node.commands)
    wired = architecture(nodes, ways={"x": resolution(way, *reaching, arbiter=arbiter)})
    # Arbiters decide before the behaviors that they name tick.
    order = sorted(range(len(nodes)), key=lambda i: -nodes[i].level)
    scheduler = Scheduler(
        scenario(replace(wired, order=tuple(order))), plane, Plain(plane), observer=noted
    )
    values = []
    for _ in range(instants):
        scheduler.step()
        values.append(float(scheduler.agents[0].set_points[0]))
    return values, noted


EARLY_OR_LATE = by_rules(["early", "late"], ("early", "x 3 lt"), ("late", None))


def test_a_choice_lets_its_nodes_act_and_keeps_the_others_from_it() -> None:
    nodes = [
        chooser("choose", EARLY_OR_LATE, {"early": ["a"], "late": ["b"]}),
        seek("a", 1.0),
        seek("b", 2.0),
    ]

    values, noted = speeds(nodes, Way.EXCLUSIVE, 6)

    assert values == [1.0, 1.0, 1.0, 2.0, 2.0, 2.0]
    assert not noted.events


def test_a_decision_takes_effect_later_and_before_the_first_one_nothing_acts() -> None:
    nodes = [
        chooser("choose", EARLY_OR_LATE, {"early": ["a"], "late": ["b"]}, response=2),
        seek("a", 1.0),
        seek("b", 2.0),
    ]

    values, _ = speeds(nodes, Way.EXCLUSIVE, 7)

    assert values == [0.0, 0.0, 1.0, 1.0, 1.0, 2.0, 2.0]


def test_a_choice_sets_controls_while_it_holds_and_the_wire_comes_back() -> None:
    nodes = [
        chooser("choose", EARLY_OR_LATE, {"early": (["a"], {"a.speed": 7.0}), "late": ["a"]}),
        seek("a", 1.0),
    ]

    values, _ = speeds(nodes, Way.SINGLE, 5)

    assert values == [7.0, 7.0, 7.0, 1.0, 1.0]


def test_a_blend_is_weighed_by_its_arbiter_over_those_that_act() -> None:
    weights = by_weights(near="x", far="4 x sub")
    nodes = [
        chooser("choose", weights, {"near": ["a"], "far": ["b"]}),
        seek("a", 10.0),
        seek("b", -10.0),
    ]

    values, _ = speeds(nodes, Way.BLEND, 7, arbiter=0)

    # Beyond 4 the second weight is below 0, and b does not act.
    assert values == pytest.approx([-10.0, -5.0, 0.0, 5.0, 10.0, 10.0, 10.0])


def test_a_node_that_two_choices_name_acts_where_either_holds() -> None:
    weights = by_weights(p="x 1 eq 3 mul", q="x 1 ge x 2 le and 0.5 mul")
    nodes = [chooser("choose", weights, {"p": ["a"], "q": ["a"]}), seek("a", 1.0)]

    values, noted = speeds(nodes, Way.SINGLE, 4)

    assert values == [0.0, 1.0, 1.0, 0.0]
    assert [float(weights[1]) for _, _, _, weights in noted.acts if weights.any()] == [3.5, 0.5]


def test_an_arbiter_above_may_keep_an_arbiter_below_from_having_its_way() -> None:
    below = by_rules(["a", "b"], ("a", "x 2 mod 0 eq"), ("b", None))
    above = by_rules(["work", "rest"], ("work", "x 4 lt"), ("rest", None))
    nodes = [
        chooser("above", above, {"work": ["below"], "rest": ["c"]}, level=2),
        chooser("below", below, {"a": ["a"], "b": ["b"]}),
        seek("a", 1.0),
        seek("b", 2.0),
        seek("c", 3.0),
    ]

    values, noted = speeds(nodes, Way.EXCLUSIVE, 7)

    assert values == [1.0, 2.0, 1.0, 2.0, 3.0, 3.0, 3.0]
    assert [tick.outputs.tolist() for _, tick in noted.of(1)][-1] == [1.0, 0.0, 0.0]  # still told


def test_what_an_arbiter_says_is_its_numbers_and_then_the_largest() -> None:
    nodes = [chooser("choose", by_weights(p="x", q="2"), {"p": ["a"], "q": []}), seek("a", 1.0)]

    _, noted = speeds(nodes, Way.SINGLE, 4)

    said = [tick.outputs.tolist() for _, tick in noted.of(0)]
    assert said == [[0.0, 2.0, 1.0], [1.0, 2.0, 1.0], [2.0, 2.0, 0.0], [3.0, 2.0, 0.0]]


def test_own_states_of_the_inhibited_stand_still_and_outputs_are_told() -> None:
    clock = formula_program(
        (
            replace(state("t", 0.0, 9.0), role=Role.DRIVEN, hold=0.0),
            replace(state("x", -BIG, BIG), role=Role.SENSED),
        ),
        {"t": "1"},
        outputs={"seen": "x"},
    )
    nodes = [
        chooser("choose", EARLY_OR_LATE, {"early": ["a"], "late": ["clock"]}),
        seek("a", 1.0),
        N("clock", clock, STEP, 0.0, {"x": "pos.x"}),
    ]

    _, noted = speeds(nodes, Way.SINGLE, 6)

    ticks = [tick for _, tick in noted.of(2)]
    times = [float(tick.register[0]) for tick in ticks]
    np.testing.assert_allclose(times, [0, 0, 0, 0, STEP, 2 * STEP], atol=1e-12)
    assert [tick.outputs[0] for tick in ticks] == [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]


def test_code_of_the_users_own_is_not_run_without_permission() -> None:
    nodes = [N("mine", "os:getcwd", STEP, tells=("y",))]

    with pytest.raises(UserCodeError, match="--allow-code"):
        speeds(nodes, Way.SINGLE, 1)


def own_clock() -> Program:
    """A clock of its own, t' = 1 with some noise on u, that commands channel x."""
    program = formula_program(
        (
            replace(state("t", 0.0, 9.0), role=Role.DRIVEN, hold=0.0),
            replace(state("u", -BIG, BIG), role=Role.DRIVEN, hold=0.0),
            replace(state("x", -BIG, BIG), role=Role.SENSED),
        ),
        {"t": "1", "u": "0"},
    )
    return replace(program, noise=(Noise("u", Code("1"), HERE),))


def test_own_states_of_parts_stand_still_while_the_combined_behavior_acts() -> None:
    part = N("part", own_clock(), STEP, 0.0, {"x": "pos.x"}, {"x": ("t", "rate")})
    both = replace(seek("both", 5.0), acts_when="x 3 lt", replaces=("part",))

    values, noted = speeds([part, both], Way.EXCLUSIVE, 7)

    times = [float(tick.register[0]) for _, tick in noted.of(0)]
    assert values == [5.0, 5.0, 5.0, 1.0, 1.0, 1.0, 1.0]
    # At instant 3 it ticks before the combined behavior does, which says there that it stops.
    steps = np.diff(times) / STEP
    np.testing.assert_allclose(steps[1:], [0, 0, 0, 1, 1], atol=1e-9)


def test_what_chance_gives_a_node_does_not_depend_on_who_inhibits_it() -> None:
    roam = N("roam", own_clock(), STEP, 0.0, {"x": "pos.x"}, {"x": ("u", "rate")})
    decides = chooser("choose", EARLY_OR_LATE, {"early": [], "late": ["roam"]})

    _, free = speeds([roam], Way.SINGLE, 8)
    _, kept = speeds([decides, roam], Way.SINGLE, 8)

    rates = [[float(tick.commands[0]) for _, tick in run] for run in (free.of(0), kept.of(1))]
    assert rates[0] == rates[1]
