"""Architectures for the tests of exclusion, wired by hand or drawn, and their replay in time."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from hypothesis import strategies as st

from compiler.architecture.exclusion.answer import Witness
from compiler.architecture.exclusion.ask import question_of
from compiler.architecture.exclusion.question import Question
from compiler.architecture.exclusion.wiring import Wiring
from runtime.arbiter import Arbiter, Paradigm, Read, Rule
from runtime.architecture import Architecture, Outside, Way
from runtime.code import Code
from runtime.program import Kind, Program, Role
from runtime.scheduler.observer import What
from runtime.scheduler.scheduler import Scheduler
from tests.runtime.behaviors import ONE, control, formula_program, state
from tests.runtime.scheduler.plane import (
    HERE,
    SOURCE,
    STEP,
    N,
    Noted,
    Plain,
    Plane,
    architecture,
    scenario,
)

TOP = 2.0
GRID = tuple(0.25 * i for i in range(9))
SIGNALS = ("a.r", "b.r")
EXCLUSIVE = {"x": Way.EXCLUSIVE}


def behavior() -> Program:
    """What senses p and q, may be set k, and drives y."""
    sensed = tuple(replace(state(name, -TOP, TOP), role=Role.SENSED) for name in "pq")
    own = replace(state("y", -1.0, 1.0), role=Role.DRIVEN)
    return formula_program((*sensed, own), {"y": "0"}, (control("k", 0.0, TOP, 1.0),))


def arbiter(
    choices: Sequence[str],
    rules: Sequence[tuple[int, str | None, str | None, float]] = (),
    weights: Sequence[str] = (),
    paradigm: Paradigm = Paradigm.RULES,
) -> Arbiter:
    """An arbiter of p, q and the control k."""
    reads = [Read(name, ONE, -TOP, TOP, Kind.CONTINUOUS, (), "", HERE) for name in "pq"]
    return Arbiter(
        name="arbiter",
        about="",
        reads=tuple(reads),
        controls=(control("k", 0.0, TOP, 1.0),),
        constants=(),
        outputs=(),
        choices=tuple(choices),
        paradigm=paradigm,
        rules=tuple(
            Rule(choice, when and Code(when), until and Code(until), lasts, HERE)
            for choice, when, until, lasts in rules
        ),
        weights=tuple(map(Code, weights)),
        competition=None,
        plan=None,
        module="",
        agreement=None,
        bindings=(),
        judge_when=None,
        source=SOURCE,
    )


@dataclass(frozen=True)
class Case:
    """An architecture, two of its nodes, and its sensors `a` and `b`: (rate, latency) in steps."""

    wired: Architecture
    first: int
    second: int
    sensors: tuple[tuple[int, int], ...]

    @property
    def question(self) -> Question:
        body = self.scenario().robots[0].body
        wired = self.wired
        wiring = Wiring(wired.nodes, wired.board, wired.programs, wired.arbiters, body.sensors)
        return question_of(wiring, self.first, self.second)

    def scenario(self):  # type: ignore[no-untyped-def]  # noqa: ANN201
        made = scenario(self.wired, sensors={"a": ("r",), "b": ("r",)})
        robot = made.robots[0]
        sensors = tuple(
            replace(sensor, every=rate * STEP, latency=late * STEP)
            for sensor, (rate, late) in zip(robot.body.sensors, self.sensors, strict=True)
        )
        return replace(made, robots=(replace(robot, body=replace(robot.body, sensors=sensors)),))

    def both_act(self, read: Mapping[int, Sequence[float]], steps: int) -> list[int]:
        """The instants at which both act, where sensor i reads read[i][n] in its n-th sample."""
        return self.run(read, steps)[0]

    def run(self, read: Mapping[int, Sequence[float]], steps: int) -> tuple[list[int], list[int]]:
        """The instants at which both act, and at which the run tells that a conflict begins."""

        def outside(_robot: int, sensor: int, time: float) -> list[float]:
            sample = round(time / STEP) // self.sensors[sensor][0]
            return [read[sensor][min(sample, len(read[sensor]) - 1)]]

        plane, noted = Plane(outside=outside), Noted()
        sensors = Plain(plane, self.sensors)
        scheduler = Scheduler(self.scenario(), plane, sensors, allow_code=True, observer=noted)
        found = []
        for instant in range(steps):
            scheduler.step()
            acts = scheduler.agents[0].acting.acts
            if acts[self.first] and acts[self.second]:
                found.append(instant)
        return found, [i for i, event in noted.events if event.what is What.CONFLICT]

    def replayed(self, witness: Witness) -> bool:
        """Whether both act where the witness says so, after the inputs that it tells.

        A conflict on their channel is told then, or was told before and goes on.
        """
        last = round(witness.at / STEP)
        read = {
            sensor: [
                self._value(witness, name, rate * (n + 1) + late) for n in range((last // rate) + 1)
            ]
            for sensor, (name, (rate, late)) in enumerate(zip(SIGNALS, self.sensors, strict=True))
        }
        both, conflicts = self.run(read, last + 1)
        assert conflicts == [i for i in both if i - 1 not in both]
        return last in both

    def _value(self, witness: Witness, name: str, ends: int) -> float:
        """What a signal is until the instant at which its next version can be read."""
        value = 1.0
        for moment in witness.inputs:
            if round(moment.time / STEP) < ends:
                value = dict(moment.signals).get(name, value)
        return value


def wired(
    nodes: Sequence[N],
    sensors: tuple[tuple[int, int], ...] = ((1, 0), (1, 0)),
    first: str = "first",
    second: str = "second",
) -> Case:
    """A case of nodes written by hand."""
    places = [node.name for node in nodes]
    nodes = [_on_channel(node) if node.name in {first, second} else node for node in nodes]
    limits = dict.fromkeys(SIGNALS, (0.0, TOP))
    made = architecture(nodes, sensors={"a": ("r",), "b": ("r",)}, signals=limits, ways=EXCLUSIVE)
    return Case(made, places.index(first), places.index(second), sensors)


def _on_channel(node: N) -> N:
    """The node, which reaches channel x if it reached none."""
    return node if node.commands else replace(node, commands={"x": ("y", "rate")})


def acting(name: str, when: str | None = None, **more: object) -> N:
    """A behavior of p = a.r and q = b.r."""
    return N(name, behavior(), inputs=INPUTS, acts_when=when, **more)  # type: ignore[arg-type]


INPUTS = {"p": "a.r", "q": "b.r"}

thresholds = st.sampled_from(GRID)
comparisons = st.sampled_from(["lt", "le", "gt", "ge", "lt", "gt", "eq", "ne"])
terms = st.one_of(
    st.sampled_from(["p", "q", "p", "k", "p q add", "p q sub", "p 2 mul", "p neg", "p q max"]),
    thresholds.map(lambda x: f"{x:g}"),
)
atoms = st.builds(
    lambda term, number, op: f"{term} {number} {op}",
    st.sampled_from(["p", "p", "q", "p q add", "p neg", "p k sub"]),
    thresholds.map(lambda x: f"{x:g}"),
    comparisons,
) | st.builds(lambda a, b, op: f"{a} {b} {op}", terms, terms, comparisons)
conditions = st.recursive(
    atoms,
    lambda inner: st.one_of(
        st.builds(lambda a, b, op: f"{a} {b} {op}", inner, inner, st.sampled_from(["and", "or"])),
        inner.map(lambda a: f"{a} not"),
    ),
    max_leaves=3,
)
periods = st.sampled_from([1, 2, 2, 3, 4]).map(lambda n: n * STEP)
responses = st.sampled_from([0, 1, 1, 2, 3, 5]).map(lambda n: n * STEP)
wires = st.builds(
    lambda p, q, scale, outside: {
        "p": (p, scale, outside),
        "q": (q, 1.0, Outside.CLIP),
    },
    st.sampled_from(SIGNALS[:1] * 3 + SIGNALS),
    st.sampled_from(SIGNALS),
    st.sampled_from([1.0, 1.0, 1.0, -1.0, 0.5, 1.5]),
    st.sampled_from([Outside.CLIP, Outside.INHIBIT]),
)
rules = st.tuples(
    st.integers(0, 1),
    st.none() | conditions,
    st.none() | conditions,
    st.sampled_from([0.0, 0.0, STEP, 3 * STEP]),
)


@st.composite
def arbiters(draw: st.DrawFn) -> Arbiter:
    """Rules, layers, or weights."""
    how = draw(st.sampled_from([Paradigm.RULES, Paradigm.SUBSUMPTION, Paradigm.WEIGHTS]))
    if how is Paradigm.WEIGHTS:
        sizes = st.sampled_from(["p", "1 p sub", "p 1 sub", "q", "p q sub", "q p sub", "1"])
        return arbiter(("x", "y"), weights=(draw(sizes), draw(sizes)), paradigm=how)
    many = draw(st.lists(rules, min_size=1, max_size=3))
    return arbiter(("x", "y"), many, paradigm=how)


@st.composite
def cases(draw: st.DrawFn) -> Case:
    """Two behaviors under conditions, one arbiter, two, or a hierarchy."""
    period, response = draw(periods), draw(responses)
    same = draw(st.booleans())
    wire = draw(wires)

    def timed() -> dict[str, object]:
        if same:
            return {"period": period, "response": response}
        return {"period": draw(periods), "response": draw(responses)}

    def made(name: str, runs: Program | Arbiter, **more: object) -> N:
        inputs = wire if draw(st.booleans()) else draw(wires)
        return N(name, runs, inputs=inputs, **timed(), **more)  # type: ignore[arg-type]

    when = st.none() | conditions
    shape = draw(st.sampled_from(["conditions", "one", "one and condition", "two", "above"]))
    plain = shape in {"one", "two", "above"} and draw(st.booleans())
    nodes = [
        made(name, behavior(), acts_when=None if plain else draw(when))
        for name in ("first", "second")
    ]
    choices = st.sampled_from([(("first",), ("second",)), (("first", "second"), ("second",))])
    if shape == "one":
        one, other = draw(choices)
        nodes.append(made("choose", draw(arbiters()), choices={"x": one, "y": other}))
    if shape == "one and condition":
        nodes.append(made("choose", draw(arbiters()), choices={"x": ("first",), "y": ()}))
    if shape in {"two", "above"}:
        nodes.append(made("left", draw(arbiters()), choices={"x": ("first",), "y": ()}))
        nodes.append(made("right", draw(arbiters()), choices={"x": (), "y": ("second",)}))
    if shape == "above":
        above = {"x": ("left",), "y": ("right",)}
        nodes.append(replace(made("top", draw(arbiters()), choices=above), level=2))
    if draw(st.integers(0, 3)) == 0:
        combined = made("both", behavior(), acts_when=draw(when), replaces=("first", "second"))
        nodes.append(combined)
    rate = st.sampled_from([(1, 0), (1, 0), (2, 0), (3, 1)])
    return wired(nodes, (draw(rate), draw(rate)))


def random_readings(seed: int, count: int) -> dict[int, list[float]]:
    """What both sensors read: numbers at, and beside, the thresholds of the conditions."""
    chance = np.random.default_rng(seed)
    found = {}
    for sensor in range(2):
        near = chance.choice(GRID, count) + chance.choice([0.0, 0.0, 0.1, -0.1, 1e-9], count)
        stays = chance.random(count) < chance.random()
        for i in range(1, count):
            near[i] = near[i - 1] if stays[i] else near[i]
        found[sensor] = np.clip(near, 0.0, TOP).tolist()
    return found
