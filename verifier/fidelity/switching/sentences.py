"""What is said about changes of mode, to a tired engineer."""

from collections import Counter

from runtime.program import Program
from verifier.fidelity.switching.means import FEWEST
from verifier.report.report import Interval, Standing
from verifier.report.switching import Jump, Switch, SwitchSort, Timing, Way
from verifier.report.wording import listed, number, quantity, span

MOST = 3
"""So many times of switches are named; more are counted."""


def not_logged(program: Program) -> tuple[str, str]:
    """That the mode is missing, and what to do."""
    mode = program.field.mode
    reason = (
        f"{mode}, the mode, is not in the trace: which field should hold, and whether the robot"
        " switches when it should, cannot be told"
    )
    return reason, f"log {mode} with every sample, and say where: `trace: {{{mode}: ...}}`"


def reasons(mode: str, ways: tuple[Way, ...], switches: tuple[Switch, ...]) -> tuple[str, ...]:
    """What speaks against the robot, then what is open, then what is fine."""
    against = [*_undeclared(mode, switches), *(s for way in ways for s in _against(way, switches))]
    open_ = [s for way in ways for s in _open(way)]
    fine = [s for way in ways for s in _fine(way)]
    never = [f"from {way.source} to {way.target}" for way in ways if not _taken(way)]
    unseen = [f"the robot never went {listed(never)}: nothing is said about that"] if never else []
    return (*against, *open_, *fine, *unseen)


def advice(ways: tuple[Way, ...], switches: tuple[Switch, ...]) -> tuple[str, ...]:
    """What to do next."""
    found = []
    if any(s.sort in {SwitchSort.UNDECLARED, SwitchSort.UNEXPECTED} for s in switches):
        found.append(
            "if somebody else changed the mode, say so in `judge_when`; if the robot may go that"
            " way, add it to `leave:`"
        )
    undecided = [way for way in ways if way.standing is Standing.UNDECIDED and _taken(way)]
    return (*found, *(_more(way) for way in undecided))


def _more(way: Way) -> str:
    timing, name = way.timing, f"from {way.source} to {way.target}"
    if timing is not None and timing.resolution > timing.allowed:
        return (
            f"log the mode more often than every {number(timing.resolution)} s: a switch {name} may"
            f" differ by {number(timing.allowed)} s"
        )
    were = "was" if way.expected == 1 else "were"
    few = f", {FEWEST} are needed" if way.expected < FEWEST else ""
    return f"record more switches {name}: there {were} {way.expected}{few}"


def _taken(way: Way) -> int:
    return way.expected + way.unexpected + way.missed + way.wrong


def _undeclared(mode: str, switches: tuple[Switch, ...]) -> list[str]:
    ways = Counter((s.source, s.target) for s in switches if s.sort is SwitchSort.UNDECLARED)
    return [
        f"{mode} went from {source} to {target} {_times(count)}, and the spec has no such way"
        for (source, target), count in ways.items()
    ]


def _against(way: Way, switches: tuple[Switch, ...]) -> list[str]:
    found = []
    name = f"from {way.source} to {way.target}"
    if way.unexpected:
        when = _when(way, switches, SwitchSort.UNEXPECTED)
        found.append(
            f"the robot went {name} {_times(way.unexpected)} ({when}) where by the spec it was not"
            " due, nor within a horizon after"
        )
    if way.missed:
        when = _when(way, switches, SwitchSort.MISSED)
        found.append(
            f"the robot did not go {name} {_times(way.missed)} ({when}) although by the spec it"
            " had to"
        )
    if way.wrong:
        when = _when(way, switches, SwitchSort.WRONG_TARGET)
        found.append(
            f"where by the spec it had to go {name}, the robot went elsewhere {_times(way.wrong)}"
            f" ({when})"
        )
    if way.timing is not None and way.timing.standing is Standing.EXCEEDED:
        found.append(_timing(name, way.timing))
    return [*found, *(_jump(name, j) for j in way.jumps if j.standing is Standing.EXCEEDED)]


def _open(way: Way) -> list[str]:
    name, found = f"from {way.source} to {way.target}", []
    if way.timing is not None and way.timing.standing is Standing.UNDECIDED:
        found.append(f"it is open whether the robot goes {name} in time: {_late(way.timing)}")
    found += [
        f"it is open whether {j.name} is right after going {name}: {_error(j)}"
        for j in way.jumps
        if j.standing is Standing.UNDECIDED
    ]
    if way.expected and way.timing is None:
        found.append(
            f"the robot went {name} {_times(way.expected)}, but that could not be timed: too few"
            " samples lie between its switches"
        )
    return found


def _fine(way: Way) -> list[str]:
    if way.standing is not Standing.WITHIN or way.timing is None:
        return []
    return [f"the robot goes from {way.source} to {way.target} in time: {_late(way.timing)}"]


def _timing(name: str, timing: Timing) -> str:
    side = "later" if timing.late > 0.0 else "earlier"
    ends = sorted([abs(timing.interval.low), abs(timing.interval.high)])
    return (
        f"the robot goes {name} {number(abs(timing.late))} s {side} than by the spec, on average"
        f" over {timing.count} switches (95 % interval {number(ends[0])} to {number(ends[1])} s);"
        f" {number(timing.allowed)} s is allowed: {timing.basis}"
    )


def _late(timing: Timing) -> str:
    side = "late" if timing.late >= 0.0 else "early"
    interval = "" if timing.count < FEWEST else f"of the delay {_seconds(timing.interval)}"
    return (
        f"{number(abs(timing.late))} s {side} {_over(timing.count, interval)},"
        f" {number(timing.allowed)} s is allowed: {timing.basis}"
    )


def _jump(name: str, jump: Jump) -> str:
    rule = "is reset to" if jump.is_reset else "goes on from"
    side = "above" if jump.error > 0.0 else "below"
    return (
        f"after going {name}, {jump.name} is {quantity(abs(jump.error), jump.unit)} {side} what it"
        f" {rule} by the spec, on average over {jump.count} switches (95 % interval of the"
        f" difference {span(jump.interval.low, jump.interval.high, jump.unit)});"
        f" {quantity(jump.tolerance, jump.unit)} is allowed"
    )


def _error(jump: Jump) -> str:
    interval = span(jump.interval.low, jump.interval.high, jump.unit)
    return (
        f"off by {quantity(jump.error, jump.unit)}"
        f" {_over(jump.count, '' if jump.count < FEWEST else interval)},"
        f" {quantity(jump.tolerance, jump.unit)} is allowed"
    )


def _over(count: int, interval: str) -> str:
    """Of how many switches a mean is; so few have no interval."""
    if count == 1:
        return "at the one switch there was (too few to tell)"
    if not interval:
        return f"on average over {count} switches (too few to tell)"
    return f"on average over {count} switches (95 % interval {interval})"


def _seconds(interval: Interval) -> str:
    return f"{number(interval.low)} to {number(interval.high)} s"


def _when(way: Way, switches: tuple[Switch, ...], sort: SwitchSort) -> str:
    times = [
        f"{number(s.time)} s"
        for s in switches
        if s.sort is sort and s.source == way.source and way.target == (s.wanted or s.target)
    ]
    more = ["further times"] if len(times) > MOST else []
    return f"at {listed([*times[:MOST], *more])}"


def _times(count: int) -> str:
    return {1: "once", 2: "twice"}.get(count, f"{count} times")
