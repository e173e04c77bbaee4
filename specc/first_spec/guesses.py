"""What the variables of a first spec could be, guessed from what a log holds, with the reasons.

Commands are controls, angles lie on the circle, texts and small whole numbers are discrete. A pose
under a speed moves as a base does; what nothing is known of stays as it is.
"""

import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Final, final

from specc.faults import fault
from specc.first_spec.beginnings import identifier
from verifier.traces.alike import is_asked, meaning
from verifier.traces.inventory import FieldInfo, Inventory, TopicInfo

POSES: Final = (
    ("pose.pose.position", "pose.pose.orientation"),
    ("pose.position", "pose.orientation"),
    ("position", "orientation"),
)
TWISTS: Final = (
    ("twist.twist.linear.x", "twist.twist.angular.z"),
    ("twist.linear.x", "twist.angular.z"),
    ("linear.x", "angular.z"),
)
MOST_STATES: Final = 3  # guessed where a log holds no pose
MOST_DISCRETE: Final = 3
LARGEST_CODE: Final = 20
SOMETHING: Final = ("what of the robot", "what of its surroundings")
FRAME: Final = "where the log's frame begins"
UNSAID: Final = re.compile(
    r"(^|[._])(t|time|stamp|sec|nanosec|seq|frame_id|child_frame_id|covariance\[\d+\])$"
)
"""Fields that say nothing about what a robot does."""


@final
@dataclass(frozen=True, slots=True)
class Variable:
    """A variable of the first spec: where it stands in the log, and what the log says of it.

    values: of a discrete one, each with the text that stands for it, or empty where the log holds
    numbers, which begin at `low`. why: what it was guessed from.
    """

    name: str
    path: str
    unit: str
    low: float
    high: float
    rate: str = ""
    relates: tuple[str, str] = SOMETHING
    periodic: bool = False
    tolerance: str = ""
    values: tuple[tuple[str, str], ...] = ()
    why: str = ""


@final
@dataclass(frozen=True, slots=True)
class Guess:
    """The variables of a first spec, and a sentence on how far to trust it."""

    states: tuple[Variable, ...]
    controls: tuple[Variable, ...]
    discrete: tuple[Variable, ...]
    advice: tuple[str, ...]


def guess(found: Inventory) -> Guess:
    """The variables that a log seems to hold; raises SpecError V306 and V344."""
    if not found.messages:
        lost = "\n".join(f"{loss.cause}: {loss.count} ({loss.detail})" for loss in found.losses)
        raise fault("V306", found.source, "no message of this log can be read", lost)
    moving = _pose_guess(found) or _column_pose_guess(found) or _plain_guess(found)
    taken = [variable.name for variable in (*moving.states, *moving.controls)]
    used = {variable.path for variable in (*moving.states, *moving.controls)}
    return replace(moving, discrete=tuple(_discrete(found, used, taken)))


def _field(topic: TopicInfo, suffix: str) -> FieldInfo | None:
    wanted = f"{topic.name}.{suffix}"
    return next((f for f in topic.fields if f.path == wanted and f.low is not None), None)


def _pose_guess(found: Inventory) -> Guess | None:
    """A pose under a speed and a turn rate, where messages hold both."""
    for topic in sorted(found.topics, key=lambda t: (is_asked(t.name), -t.count)):
        for position, orientation in POSES:
            parts = [
                _field(topic, f"{position}.x"),
                _field(topic, f"{position}.y"),
                _field(topic, f"{orientation}.@yaw"),
            ]
            twist = _twist(found, topic)
            if all(parts) and twist is not None:
                x, y, yaw = (part for part in parts if part is not None)
                return _drive((x, y, yaw), *twist)
    return None


def _twist(found: Inventory, beside: TopicInfo) -> tuple[FieldInfo, FieldInfo, bool] | None:
    """Speed and turn rate: commands first, then other topics, else from beside the pose (True)."""
    others = [topic for topic in found.topics if topic is not beside]
    others.sort(key=lambda topic: not is_asked(topic.name))
    for topic in (*others, beside):
        for linear, angular in TWISTS:
            speed, turn = _field(topic, linear), _field(topic, angular)
            if speed is not None and turn is not None:
                return speed, turn, topic is beside
    return None


def _column_pose_guess(found: Inventory) -> Guess | None:
    """The same where columns, or fields of flat messages, hold them under common names."""
    for topic in found.topics:
        by_meaning: dict[str, FieldInfo] = {}
        # Of what is told and what is done, the pose is what is done, the control what is told.
        for info in sorted(topic.fields, key=lambda info: is_asked(info.path)):
            if info.low is None:
                continue
            quantity = meaning(info.path)
            if quantity not in by_meaning or quantity in {"speed", "turn"}:
                by_meaning[quantity] = info
        pose = [by_meaning.get(quantity) for quantity in ("x", "y", "yaw")]
        x, y, yaw = pose
        speed = by_meaning.get("speed")
        if x is not None and y is not None and yaw is not None and speed is not None:
            return _drive((x, y, yaw), speed, by_meaning.get("turn"), is_own=False)
    return None


def _drive(
    pose: tuple[FieldInfo, FieldInfo, FieldInfo],
    speed: FieldInfo,
    turn: FieldInfo | None,
    is_own: bool,  # noqa: FBT001
) -> Guess:
    x, y, yaw = pose
    start = ("center of the base", FRAME)
    heading = _angle("heading", yaw) or _variable("heading", yaw, "rad")
    rate = "0" if turn is None else "turn"
    states = (
        _variable("x", x, "m", "speed * cos(heading)", start, tolerance="0.1 m"),
        _variable("y", y, "m", "speed * sin(heading)", start, tolerance="0.1 m"),
        replace(heading, rate=rate, relates=("forward axis", FRAME)),
    )
    controls = [_variable("speed", speed, "m/s", why=_told(speed))]
    advice = ["A pose under a speed and a turn rate: the robot goes where its twist says."]
    if turn is None:
        advice = [
            "A pose under a speed: the robot goes where it looks. No turn rate was found in the",
            "log, so that the heading stays as it is: write down what turns the robot.",
        ]
    else:
        controls.append(_variable("turn", turn, f"{heading.unit}/s", why=_told(turn)))
    if is_own:
        advice += [
            "Beware: pose and twist come from the same topic. If the robot computes one from the",
            "other, agreement proves nothing: take the turn rate from another sensor (an IMU).",
        ]
    return Guess(states, tuple(controls), (), tuple(advice))


def _told(info: FieldInfo) -> str:
    return "by its name a command" if is_asked(info.path) else ""


def _angle(name: str, info: FieldInfo) -> Variable | None:
    """The field as an angle on the circle, where its name or its jumps say that it is one."""
    low, high = info.low or 0.0, info.high or 0.0
    is_named = meaning(info.path) == "yaw"
    for half, unit, tolerance in ((math.pi, "rad", "0.05 rad"), (180.0, "deg", "3 deg")):
        is_round = 1.8 * half < high - low < 2.02 * half and info.wraps > 0
        reaches = -1.01 * half <= low and high <= 2.02 * half
        if reaches and (is_round or is_named):
            times = "once" if info.wraps == 1 else f"{info.wraps} times"
            why = f"it jumps by a turn {times}" if is_round else "so says its name"
            why = f"an angle in {unit}: {why}"
            return Variable(
                name=name,
                path=info.path,
                unit=unit,
                low=-half,
                high=half,
                rate="0",
                periodic=True,
                tolerance=tolerance,
                why=why,
            )
        if is_round:
            break
    return None


def _variable(
    name: str,
    info: FieldInfo,
    unit: str,
    rate: str = "",
    relates: tuple[str, str] = SOMETHING,
    *,
    tolerance: str = "",
    why: str = "",
) -> Variable:
    low, high = _widened(info.low or 0.0, info.high or 0.0)
    return Variable(name, info.path, unit, low, high, rate, relates, tolerance=tolerance, why=why)


def _widened(low: float, high: float) -> tuple[float, float]:
    """The range with a tenth on either side, rounded outward to two digits."""
    width = max(high - low, 1e-3 * max(abs(low), abs(high)), 1e-6)
    digit = 10.0 ** math.floor(math.log10(width) - 1)
    return math.floor((low - width / 10) / digit) * digit, math.ceil(
        (high + width / 10) / digit
    ) * digit


def _plain_guess(found: Inventory) -> Guess:
    """The first numbers that change and are no commands, until the user knows better."""
    fields = [info for info in _changing(found) if info.low is not None]
    measured = [info for info in fields if not is_asked(info.path) and not _is_code(info)]
    if not fields:
        message = "this log holds no number that changes, so there is nothing to write a spec about"
        raise fault("V344", found.source, message)
    states: list[Variable] = []
    for info in (measured or fields)[:MOST_STATES]:
        name = _unused(_name_of(info), [state.name for state in states])
        state = _angle(name, info) or _variable(name, info, "1", "0", why="it changes")
        states.append(state)
    advice = (
        "Nothing in this log looks like a pose under a speed. The first numbers that change are",
        "taken as states that stay as they are; write down how they ought to move, in which unit.",
    )
    return Guess(tuple(states), (), (), advice)


def _changing(found: Inventory) -> Iterator[FieldInfo]:
    for topic in found.topics:
        for info in topic.fields:
            changes = len(info.texts) > 1 or (info.low is not None and info.low != info.high)
            if changes and not UNSAID.search(info.path):
                yield info


def _is_code(info: FieldInfo) -> bool:
    """Whether the numbers look like those of modes: few, whole, small and without a hole."""
    codes = info.codes
    return (
        len(codes) > 1
        and codes == tuple(range(codes[0], codes[-1] + 1))
        and 0 <= codes[0] <= codes[-1] <= LARGEST_CODE
    )


def _discrete(found: Inventory, used: set[str], taken: list[str]) -> Iterator[Variable]:
    """What takes a few values, as texts or as small whole numbers."""
    few = (i for i in _changing(found) if i.path not in used and not is_asked(i.path))
    names = list(taken)
    for info in few:
        if len(names) - len(taken) == MOST_DISCRETE:
            return
        values = _values(info)
        if not values:
            continue
        name = _unused(_name_of(info), names)
        names.append(name)
        what = "texts" if info.is_text else f"whole numbers from {info.codes[0]} on"
        why = f"{len(values)} {what}"
        low, high = info.low or 0.0, info.high or 0.0
        yield Variable(name, info.path, "", low, high, values=values, why=why)


def _values(info: FieldInfo) -> tuple[tuple[str, str], ...]:
    if 1 < len(info.texts) <= LARGEST_CODE:
        names: list[str] = []
        for text in info.texts:
            names.append(_unused(identifier(text), names))
        return tuple(zip(names, info.texts, strict=True))
    if not info.is_text and _is_code(info):
        return tuple((f"{_name_of(info)}_{code}", "") for code in info.codes)
    return ()


def _name_of(info: FieldInfo) -> str:
    return identifier(re.split(r"[./]", info.path)[-1])


def _unused(name: str, taken: Sequence[str]) -> str:
    return name if name not in taken else f"{name}_{len(taken) + 1}"
