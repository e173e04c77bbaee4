"""What happened in a run of a scenario, as text for people and as a record for programs."""

from collections import Counter
from collections.abc import Iterator, Sequence
from typing import Final

import numpy as np

from runtime.architecture import Architecture, Way
from runtime.recording.resolutions import shares_of
from runtime.recording.tracks import Happening, RobotTrack
from runtime.run import Run
from runtime.world.audit import Jam
from specc.scenarios.replaying import Replay
from specc.scenarios.simulating import Simulation
from verifier.report.layout import INDENT, section, table
from verifier.report.requirement_record import requirements_record, requirements_text
from verifier.report.requirement_results import Outcome, RequirementResult
from verifier.report.wording import listed, number, percent, percents, seconds

MILLIMETRES: Final = 1e3
MOST_NAMED: Final = 4
"""So many of what was touched are named."""


def simulation_text(made: Simulation, took: float | None) -> str:
    """What was required, what each robot did, and what should not pass in silence.

    took: seconds of the computer; None where somebody watched, at a speed of their own.
    """
    run = made.run
    scenario = run.scenario
    head = f"{scenario.name}: {seconds(run.duration)} simulated, seed {scenario.seed}"
    if took is not None:
        head += f" ({number(run.duration / max(took, 1e-9))} times as fast as real time)"
    head += _concluded(made.requirements)
    blocks = [head]
    if made.requirements:
        blocks.append(requirements_text(made.requirements))
    for place, robot in enumerate(scenario.robots):
        rows = [*_robot_rows(run, place), *_node_rows(run, place)]
        blocks.append(section(robot.name, [table(rows, INDENT)]))
    blocks.append(section("audit", [table(list(_audit_rows(run)), INDENT)]))
    return "\n\n".join(blocks)


def replay_text(found: Replay) -> str:
    """What a recording says of what was required."""
    scenario = found.scenario
    head = f"{scenario.name}: {seconds(scenario.duration)} recorded, seed {scenario.seed}"
    head += _concluded(found.requirements)
    return "\n\n".join(
        [head, *([requirements_text(found.requirements)] * bool(found.requirements))]
    )


def _concluded(requirements: Sequence[RequirementResult]) -> str:
    """How it went, in a few words: `: as required`, `: 1 of 2 requirements violated`.

    >>> _concluded(())
    ''
    """
    if not requirements:
        return ""
    outcomes = [each.outcome for each in requirements]
    worst = (one for one in (Outcome.VIOLATED, Outcome.OPEN) if one in outcomes)
    found = next(worst, None)
    if found is None:
        return ": as required"
    noun = "requirement" if len(outcomes) == 1 else "requirements"
    return f": {outcomes.count(found)} of {len(outcomes)} {noun} {found}"


def simulation_record(made: Simulation, took: float | None) -> dict[str, object]:
    """The same for programs, in SI; `took` is the only thing that differs between two runs."""
    run = made.run
    return {
        "scenario": run.scenario.name,
        "seed": run.scenario.seed,
        "duration": run.duration,
        "step": run.scenario.step,
        "took": took,
        "real_time_factor": None if took is None else run.duration / max(took, 1e-9),
        "outcome": str(made.outcome),
        "requirements": requirements_record(made.requirements),
        "robots": {
            robot.name: _robot_record(run, place) for place, robot in enumerate(run.scenario.robots)
        },
        "events": [
            {"time": e.time, "robot": e.robot, "what": e.what, "where": e.where} for e in run.events
        ],
        "touches": [
            {"time": t.time, "robot": t.robot, "what": t.what, "x": t.x, "y": t.y}
            for t in run.touches
        ],
        "jams": [_jam_record(jam) for jam in run.audit.jams],
        "worst_penetration": {
            "depth": run.audit.depth,
            "between": list(run.audit.pair),
            "time": run.audit.time,
        },
        "state_hash": run.digest.hex(),
    }


def _robot_rows(run: Run, place: int) -> Iterator[tuple[str, str]]:
    yield "driven", f"{number(travelled(run, place))} m"
    yield "touched something", _touched_text(run, place)
    yield "nearest to anything", f"{number(float(run.world.clearance[:, place].min()))} m"


def _touched_text(run: Run, place: int) -> str:
    """How often, what, and for how long together."""
    count, share = touched(run, place)
    if not count:
        return "never"
    name = run.scenario.robots[place].name
    what = Counter(touch.what for touch in run.touches if touch.robot == name)
    named = [f"{other} ×{often}" for other, often in what.most_common(MOST_NAMED)]
    more = ["others"] if len(what) > MOST_NAMED else []
    times = "once" if count == 1 else f"{count} times"
    told = f" ({', '.join([*named, *more])})" if len(what) > 1 else f" ({next(iter(what))})"
    return f"{times}{told}, {percent(share)} of the time"


def _node_rows(run: Run, place: int) -> Iterator[tuple[str, str]]:
    architecture = run.scenario.robots[place].architecture
    shares = acting_shares(run.robots[place], run.duration)
    blended = _blended(architecture)
    for node, share in zip(architecture.nodes, shares, strict=True):
        if node.behavior >= 0:
            yield f"{node.name} acted", f"{percent(share)} of the time"
    if blended:
        yield "in a blend", f"{listed(blended)} act all at once; their shares stand below"
    for channel, drivers in driving_shares(run, place).items():
        parts = zip(drivers, percents([*drivers.values()]), strict=True)
        told = [f"{name} {share}" for name, share in parts]
        yield f"{channel} driven by", ", ".join(told)


def _blended(architecture: Architecture) -> list[str]:
    """The nodes that are mixed on a channel."""
    mixed = {
        node
        for channel in architecture.channels
        if channel.resolution.way is Way.BLEND
        for node in channel.resolution.nodes
    }
    return [architecture.nodes[node].name for node in sorted(mixed)]


def _audit_rows(run: Run) -> Iterator[tuple[str, str]]:
    jams = [_jam_text(jam) for jam in run.audit.jams]
    yield "stuck", "; ".join(jams) or "never"
    conflicts = [event for event in run.events if event.what == "conflict"]
    yield "conflicts", _counted(conflicts) if conflicts else "none"
    kinds = {(e.robot, e.what, e.where): e for e in reversed(run.events) if e.what != "conflict"}
    for robot, what, where in sorted(kinds):
        same = [e for e in run.events if (e.robot, e.what, e.where) == (robot, what, where)]
        yield f"{robot}.{where}: {what}", _counted(same)
    depth = f"{number(run.audit.depth * MILLIMETRES)} mm"
    one, other = run.audit.pair
    yield "worst penetration", f"{depth} of {one} and {other}" if one else depth


def _counted(events: list[Happening]) -> str:
    times = "once" if len(events) == 1 else f"{len(events)} times"
    return f"{times}, first at {seconds(events[0].time)}"


def _jam_text(jam: Jam) -> str:
    held = f" at {jam.thing}" if jam.thing else ""
    return f"{jam.robot} {jam.cause}{held} from {number(jam.begin)} to {number(jam.end)} s"


def _jam_record(jam: Jam) -> dict[str, object]:
    return {
        "robot": jam.robot,
        "thing": jam.thing,
        "cause": str(jam.cause),
        "begin": jam.begin,
        "end": jam.end,
        "force": jam.force,
    }


def _robot_record(run: Run, place: int) -> dict[str, object]:
    count, share = touched(run, place)
    architecture = run.scenario.robots[place].architecture
    shares = acting_shares(run.robots[place], run.duration)
    return {
        "driven": travelled(run, place),
        "touched": count,
        "touching": share,
        "nearest": float(run.world.clearance[:, place].min()),
        "acting": {
            node.name: share
            for node, share in zip(architecture.nodes, shares, strict=True)
            if node.behavior >= 0
        },
        "driving": driving_shares(run, place),
    }


def driving_shares(run: Run, place: int) -> dict[str, dict[str, float]]:
    """For each channel of a robot who had what share of it."""
    architecture, track = run.scenario.robots[place].architecture, run.robots[place]
    return {
        channel.name: shares_of(architecture, i, how, run.duration)
        for i, (channel, how) in enumerate(
            zip(architecture.channels, track.resolutions, strict=True)
        )
    }


def travelled(run: Run, place: int) -> float:
    """Metres that a robot drove, over ground."""
    path = run.world.poses[:, len(run.layout.things) + place, :2]
    return float(np.hypot(*np.diff(path, axis=0).T).sum())


def touched(run: Run, place: int) -> tuple[int, float]:
    """How often a robot began to touch something, and for what share of the time it did."""
    name = run.scenario.robots[place].name
    count = sum(touch.robot == name for touch in run.touches)
    return count, float((run.world.contacts[:, place] > 0).mean())


def acting_shares(track: RobotTrack, duration: float) -> list[float]:
    """For each node the share of the time in which it acted."""
    acting = track.acting
    lasts = np.diff(np.append(acting.times, duration))
    shares: list[float] = ((acting.acts * lasts[:, np.newaxis]).sum(axis=0) / duration).tolist()
    return shares
