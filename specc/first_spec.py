"""A first spec from what a log holds.

Most users arrive with a bag and no spec. What is written for them checks, compiles and verifies as
it stands; every guess in it is marked, so that the next step is an edit and not a search.
"""

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import final

from specc.beginnings import identifier
from specc.faults import fault
from specc.inventory_text import MOST_FIELDS, looks
from verifier.traces.inventory import FieldInfo, Inventory, TopicInfo

POSES = (
    ("pose.pose.position", "pose.pose.orientation"),
    ("pose.position", "pose.orientation"),
    ("position", "orientation"),
)
TWISTS = (
    ("twist.twist.linear.x", "twist.twist.angular.z"),
    ("twist.linear.x", "twist.angular.z"),
    ("linear.x", "angular.z"),
)
MOST_STATES = 2  # guessed where a log holds no pose


def spec_for(found: Inventory, name: str) -> str:
    """A first spec for the log, its `trace:` filled in."""
    guess = _pose_guess(found) or _plain_guess(found)
    return "\n".join(_spec_lines(found, name, guess)) + "\n"


@final
@dataclass(frozen=True, slots=True)
class Variable:
    """A variable of the first spec: where it stands in the log, and what the log says of it."""

    name: str
    path: str
    unit: str
    low: float
    high: float
    rate: str = ""
    relates: tuple[str, str] = ("what of the robot", "what of its surroundings")
    periodic: bool = False
    tolerance: str = ""


@final
@dataclass(frozen=True, slots=True)
class Guess:
    """The variables of a first spec, and a sentence on how far to trust it."""

    states: tuple[Variable, ...]
    controls: tuple[Variable, ...]
    advice: tuple[str, ...]


def _field(topic: TopicInfo, suffix: str) -> FieldInfo | None:
    wanted = f"{topic.name}.{suffix}"
    return next((f for f in topic.fields if f.path == wanted and f.low is not None), None)


def _pose_guess(found: Inventory) -> Guess | None:
    """A pose under a speed and a turn rate, where the log holds both."""
    for topic in sorted(found.topics, key=lambda t: -t.count):
        for position, orientation in POSES:
            parts = [
                _field(topic, f"{position}.x"),
                _field(topic, f"{position}.y"),
                _field(topic, f"{orientation}.@yaw"),
            ]
            twist = _twist(found, topic)
            if all(parts) and twist is not None:
                return _drive(parts, *twist)
    return None


def _twist(found: Inventory, beside: TopicInfo) -> tuple[FieldInfo, FieldInfo, bool] | None:
    """Speed and turn rate: from a topic of their own, else from beside the pose (True)."""
    others = [t for t in found.topics if t is not beside]
    for topic in (*others, beside):
        for linear, angular in TWISTS:
            speed, turn = _field(topic, linear), _field(topic, angular)
            if speed is not None and turn is not None:
                return speed, turn, topic is beside
    return None


def _drive(
    parts: list[FieldInfo | None],
    speed: FieldInfo,
    turn: FieldInfo,
    is_own: bool,  # noqa: FBT001
) -> Guess:
    x, y, yaw = (part for part in parts if part is not None)
    start = ("where the log's frame begins",)
    base = ("center of the base", *start)
    states = (
        replace(_variable("x", x, "m", "speed * cos(heading)", base), tolerance="0.1 m"),
        replace(_variable("y", y, "m", "speed * sin(heading)", base), tolerance="0.1 m"),
        Variable(
            name="heading",
            path=yaw.path,
            unit="rad",
            low=-math.pi,
            high=math.pi,
            rate="turn",
            relates=("forward axis", *start),
            periodic=True,
            tolerance="0.05 rad",
        ),
    )
    controls = (_variable("speed", speed, "m/s"), _variable("turn", turn, "rad/s"))
    advice = ["A pose under a speed and a turn rate: the robot goes where its twist says."]
    if is_own:
        advice.append(
            "Beware: pose and twist come from the same topic. If the robot computes one from the"
        )
        advice.append(
            "other, agreement proves nothing: take the turn rate from another sensor (an IMU)."
        )
    return Guess(states, controls, tuple(advice))


def _variable(
    name: str, info: FieldInfo, unit: str, rate: str = "", relates: tuple[str, ...] = ()
) -> Variable:
    low, high = _widened(info.low or 0.0, info.high or 0.0)
    pair = (
        (relates[0], relates[1]) if relates else ("what of the robot", "what of its surroundings")
    )
    return Variable(name, info.path, unit, low, high, rate, pair)


def _widened(low: float, high: float) -> tuple[float, float]:
    """The range with a tenth on either side, rounded outward to two digits."""
    width = max(high - low, 1e-3 * max(abs(low), abs(high)), 1e-6)
    digit = 10.0 ** math.floor(math.log10(width) - 1)
    return math.floor((low - width / 10) / digit) * digit, math.ceil(
        (high + width / 10) / digit
    ) * digit


def _plain_guess(found: Inventory) -> Guess:
    """The first numbers that change, each staying as it is until the user knows better."""
    fields = [
        info
        for topic in found.topics
        for info in topic.fields
        if info.low is not None
        and info.high is not None
        and info.low < info.high
        and not re.search(r"(^|[._])(t|time|stamp|sec|nanosec|seq|covariance\[\d+\])$", info.path)
    ]
    if not fields:
        message = "this log holds no number that changes, so there is nothing to write a spec about"
        raise fault("V344", found.source, message)
    states: list[Variable] = []
    for info in fields[:MOST_STATES]:
        name = _unused(identifier(info.path.rsplit(".", 1)[-1]), [s.name for s in states])
        states.append(_variable(name, info, "1", "0"))
    advice = (
        "Nothing in this log looks like a pose. The first numbers that change are taken as states",
        "that stay as they are; write down how they ought to move.",
    )
    return Guess(tuple(states), (), advice)


def _unused(name: str, taken: list[str]) -> str:
    return name if name not in taken else f"{name}_{len(taken) + 1}"


def _spec_lines(found: Inventory, name: str, guess: Guess) -> Iterator[str]:
    yield f"# A first spec for {Path(found.source).name}, written by `specc init --from`."
    for line in guess.advice:
        yield f"# {line}"
    yield "# Every line marked CHECK is a guess. Then: specc check, specc verify."
    yield "specc: 1"
    yield "kind: behavior"
    yield f"name: {name}"
    yield "about: CHECK what this behavior does, in a sentence"
    yield "state:"
    for state in guess.states:
        yield from _state_lines(state)
    if guess.controls:
        yield "control:"
        for control in guess.controls:
            default = 0 if control.low <= 0 <= control.high else round(control.low, 6)
            unit, domain = _text(control.unit), _domain(control)
            yield f"  {control.name}: {{unit: {unit}, domain: {domain}, default: {default:g}}}"
    yield "field:"
    yield "  formula:                     # CHECK how each state moves, in its unit per second"
    for state in guess.states:
        yield f"    {state.name}: {state.rate}"
    yield "fidelity:"
    yield "  tolerance:                   # CHECK how far off is still the same behavior"
    for state in guess.states:
        yield f"    {state.name}: {_tolerance(state)}"
    yield "  horizon: 1 s                 # CHECK how far ahead it must hold"
    yield "trace:"
    for variable in (*guess.states, *guess.controls):
        yield f"  {variable.name}: {_text(variable.path)}"
    yield from _other_fields(found, guess)


def _state_lines(state: Variable) -> Iterator[str]:
    yield f"  {state.name}:"
    yield f"    unit: {_text(state.unit)}"
    yield f"    domain: {'[-pi, pi]' if state.periodic else _domain(state)}"
    if state.periodic:
        yield "    kind: periodic"
    yield "    role: both"
    agent, environment = state.relates
    yield f"    relates: {{agent: {agent}, environment: {environment}}}     # CHECK"


def _domain(variable: Variable) -> str:
    return f"[{variable.low:.6g}, {variable.high:.6g}]"


def _tolerance(state: Variable) -> str:
    """As guessed with the variable, else two percent of the range seen, to one digit."""
    if state.tolerance:
        return state.tolerance
    width = 0.02 * (state.high - state.low)
    digits = 10.0 ** math.floor(math.log10(width))
    return f"{round(width / digits) * digits:.3g}"


def _text(text: str) -> str:
    """The text as a YAML scalar."""
    if re.fullmatch(r"[A-Za-z/][\w/.@\[\]-]*", text):
        return text
    return "'" + text.replace("'", "''") + "'"


def _other_fields(found: Inventory, guess: Guess) -> Iterator[str]:
    used = {v.path for v in (*guess.states, *guess.controls)}
    yield "# Also in this log:"
    for topic in found.topics:
        for info in topic.fields[:MOST_FIELDS]:
            if info.path not in used and info.low != info.high:
                yield f"#   {info.path}   ({looks(info)})"
