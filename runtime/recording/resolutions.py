"""How each channel is resolved, as topics of a recording: `/ROBOT/base/turn/resolved`.

A message where another has its way, where a weight changes, or where the set-point does.
"""

from collections.abc import Sequence
from typing import Final

import numpy as np

from runtime.architecture import Architecture, Channel, Way
from runtime.arrays import Array
from runtime.recording.messages import Messages
from runtime.recording.tables import Field, tell_rows
from runtime.recording.tracks import ResolutionTrack, RobotTrack
from runtime.scenario import Robot

RESOLVED: Final = "resolved"
REST: Final = "rest"
NOBODY: Final = "nobody"
WEIGHT: Final = "weight_"
TOGETHER: Final = (Way.SUM, Way.FUNCTION)
"""What several want makes one set-point, and none of them has a share of it."""


def topic_of_channel(robot: str, channel: Channel) -> str:
    """The topic of how a channel is resolved."""
    return f"/{robot}/{channel.name.replace('.', '/')}/{RESOLVED}"


def tell_resolutions(messages: Messages, robot: Robot, track: RobotTrack) -> None:
    """Of each channel who drives it, in which way, and what it gets."""
    architecture = robot.architecture
    for place, (channel, how) in enumerate(
        zip(architecture.channels, track.resolutions, strict=True)
    ):
        times, values = _set_points(track, how, place)
        since = np.searchsorted(how.times, times, "right") - 1
        who, names = _who(architecture, how)
        reaching = reaching_of(architecture, place)
        rows = np.column_stack(
            [
                who[since] == 0,
                who[since],
                values,
                how.limited[since],
                how.in_conflict[since],
                how.weights[since][:, reaching],
            ]
        )
        fields = _fields(channel, names, [architecture.nodes[i].name for i in reaching])
        tell_rows(messages, topic_of_channel(robot.name, channel), fields, times, rows)


def reaching_of(architecture: Architecture, channel: int) -> list[int]:
    """The nodes that have a command for a channel."""
    return [
        i
        for i, node in enumerate(architecture.nodes)
        if any(command.channel == channel for command in node.commands)
    ]


def shares_of(
    architecture: Architecture, channel: int, how: ResolutionTrack, duration: float
) -> dict[str, float]:
    """Who had what share of a channel in a run, adding up to 1; the largest first.

    Of those that counted together, as in a sum, a share for all of them: `avoid and seek`.
    """
    lasts = np.diff(np.append(how.times, duration)) / duration
    shares: dict[str, float] = {NOBODY: float(how.times[0]) / duration if how.times.size else 1.0}
    for weights, share in zip(how.weights.tolist(), lasts.tolist(), strict=True):
        for name, weight in _holders(architecture, channel, weights):
            shares[name] = shares.get(name, 0.0) + weight * share
    found = [(name, share) for name, share in shares.items() if share > 0.0]
    return dict(sorted(found, key=lambda each: (each[0] == NOBODY, -each[1])))


def _holders(
    architecture: Architecture, channel: int, weights: Sequence[float]
) -> list[tuple[str, float]]:
    drives = [(architecture.nodes[i].name, w) for i, w in enumerate(weights) if w > 0.0]
    if not drives:
        return [(NOBODY, 1.0)]
    if architecture.channels[channel].resolution.way in TOGETHER:
        return [(" and ".join(name for name, _ in drives), 1.0)]
    return drives


def _set_points(track: RobotTrack, how: ResolutionTrack, place: int) -> tuple[Array, Array]:
    """When anything of a channel changes, and its set-point; NaN where it rolls freely."""
    channels = track.channels
    values = np.where(channels.driven[:, place], channels.set_points[:, place], np.nan)
    same = (values[1:] == values[:-1]) | (np.isnan(values[1:]) & np.isnan(values[:-1]))
    told = np.concatenate([[True], ~same]) | np.isin(channels.times, how.times)
    return channels.times[told], values[told]


def _who(architecture: Architecture, how: ResolutionTrack) -> tuple[Array, list[str]]:
    """At each time who drives, as a place in the names; nobody is the first."""
    names = {NOBODY: 0}
    places = [
        names.setdefault(
            ", ".join(architecture.nodes[i].name for i in np.flatnonzero(weights > 0.0)) or NOBODY,
            len(names),
        )
        for weights in how.weights
    ]
    return np.array(places, dtype=np.float64), [*names]


def _fields(channel: Channel, names: Sequence[str], reaching: Sequence[str]) -> list[Field]:
    way = channel.resolution.way
    return [
        Field("way", labels=(str(way), REST), about=f"at {REST} it does this: {channel.rest}"),
        Field("who", labels=tuple(names), about="whose wants count"),
        Field("set_point", channel.unit, about="after limiting; null where it rolls freely"),
        Field("is_limited", is_flag=True, about="more was wanted than the channel can do"),
        Field("is_in_conflict", is_flag=True, about="two act that never should at once"),
        *(Field(f"{WEIGHT}{name}", about="how much what it wants counts") for name in reaching),
    ]
