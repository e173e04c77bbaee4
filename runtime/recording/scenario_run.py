"""A run of a scenario as an MCAP file: what was said, what is drawn, and what it was made of.

The file carries the compiled scenario and the artifact of each robot's architecture, so that it can
be judged by itself. The same run gives the same bytes.
"""

import json
from typing import Final

import numpy as np

from runtime import architecture_artifact
from runtime.program import Unit
from runtime.program_json import to_plain
from runtime.recording.drawn import tell_drawn
from runtime.recording.foxglove import classes
from runtime.recording.happened import SUFFIX, Happened, to_bytes
from runtime.recording.messages import Messages, nanoseconds
from runtime.recording.nodes import CLOSE, MEASURED, THINGS, tell_robot
from runtime.recording.tables import Field, tell_rows
from runtime.requirement import Requirement
from runtime.run import Run
from runtime.scenario import Scenario
from runtime.world.model import World

ARCHITECTURE: Final = "application/vnd.specc"
DOCUMENT: Final = "application/json"
FORMAT: Final = 1
"""The version of the scenario's document."""
WARNING: Final = 3
"""`Log.WARNING`."""


def recorded_run(run: Run) -> bytes:
    """The bytes of an MCAP file that holds the run."""
    messages = Messages()
    tell_drawn(messages, run)
    for robot, track in zip(run.scenario.robots, run.robots, strict=True):
        tell_robot(messages, robot, track)
    _tell_measures(messages, run)
    _tell_things(messages, run)
    _tell_events(messages, run)
    attachments = [
        (f"{robot.name}.specc", ARCHITECTURE, _artifact(run, place))
        for place, robot in enumerate(run.scenario.robots)
    ]
    document = (f"{run.scenario.name}.scenario.json", DOCUMENT, scenario_document(run.scenario))
    happened = Happened(run.layout.things, run.touches, run.audit.jams)
    told = (f"{run.scenario.name}{SUFFIX}", DOCUMENT, to_bytes(happened))
    about = {
        "scenario": run.scenario.name,
        "seed": str(run.scenario.seed),
        "duration": repr(run.duration),
        "state_hash": run.digest.hex(),
    }
    return messages.written([document, told, *attachments], about)


def scenario_document(scenario: Scenario) -> bytes:
    """The compiled scenario as JSON; architectures are attachments of their own, `ROBOT.specc`."""
    requirements = [to_plain(Requirement, one) for one in scenario.requirements]
    document = {
        "format": FORMAT,
        "name": scenario.name,
        "about": scenario.about,
        "duration": scenario.duration,
        "step": scenario.step,
        "seed": scenario.seed,
        "beginnings": scenario.beginnings,
        "requirements": requirements,
        "world": to_plain(World, scenario.world),
        "robots": {
            robot.name: {"architecture": f"{robot.name}.specc"} for robot in scenario.robots
        },
    }
    text = json.dumps(document, sort_keys=True, allow_nan=False, ensure_ascii=False, indent=1)
    return (text + "\n").encode()


def _artifact(run: Run, place: int) -> bytes:
    robot = run.scenario.robots[place]
    return architecture_artifact.to_bytes(robot.architecture, robot.body)


def _tell_measures(messages: Messages, run: Run) -> None:
    """What the world knows of each robot: at the instants of its poses, and how near it is always.

    Between two instants of poses a robot may come nearer than at both: `close` is told each step.
    """
    world = run.world
    metres, lux = Unit("m", 1.0), Unit("lx", 1.0)
    measured = [
        *_pose_fields(),
        Field("speed", Unit("m/s", 1.0)),
        Field("turn", Unit("rad/s", 1.0)),
        Field("light", lux, about="at its middle"),
    ]
    close = [
        Field("clearance", metres, about="to the nearest other thing or wall"),
        Field("contacts", about="how many things it touches"),
    ]
    for place, robot in enumerate(run.scenario.robots):
        poses = world.poses[:, len(run.layout.things) + place]
        rows = np.column_stack([poses, world.motions[:, place], world.light[:, place]])
        tell_rows(messages, f"/{robot.name}/{MEASURED}", measured, world.times, rows)
        near = np.column_stack([world.clearance[:, place], world.contacts[:, place]])
        tell_rows(messages, f"/{robot.name}/{CLOSE}", close, world.close_times, near)


def _tell_things(messages: Messages, run: Run) -> None:
    """Where each thing is: first, last, and around each change, for most stand still mostly."""
    world = run.world
    for place, thing in enumerate(run.layout.things):
        poses = world.poses[:, place]
        moves = np.any(np.diff(poses, axis=0) != 0.0, axis=1)
        told = np.concatenate([[True], moves]) | np.concatenate([moves, [True]])
        topic = f"{THINGS}/{thing.name}"
        tell_rows(messages, topic, _pose_fields(), world.times[told], poses[told])


def _pose_fields() -> list[Field]:
    metres, radians = Unit("m", 1.0), Unit("rad", 1.0)
    return [Field("x", metres), Field("y", metres), Field("heading", radians, about="not wrapped")]


def _tell_events(messages: Messages, run: Run) -> None:
    """What should not pass in silence, with jams where they begin."""
    told = [(event.time, event.robot, f"{event.what}: {event.where}") for event in run.events]
    for jam in run.audit.jams:
        held = f" at {jam.thing}" if jam.thing else ""
        told.append((jam.begin, jam.robot, f"{jam.cause}{held}, for {jam.end - jam.begin:.1f} s"))
    if not told:
        return
    channel = messages.drawn_topic("/events", "Log")
    for time, robot, text in sorted(told):
        log = classes()["Log"](level=WARNING, message=text, name=robot)
        log.timestamp.seconds, log.timestamp.nanos = divmod(nanoseconds(time), 10**9)
        messages.draw(channel, time, log)
