"""Cycles that go through several modes, or through one again and again by its jumps.

Spread trajectories are followed from every mode. Candidates are what they come back to in the end,
and in the plane, where the states after a switch lie on lines, the places between two of which the
return map crosses the diagonal, so that cycles that repel are found, too.

m: number of axes; n: of states.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array, frozen
from runtime.integrators import Trajectories
from runtime.rollout import Ending, Switches
from verifier.topology.cycles.floquet import stability
from verifier.topology.features import Cycle, Stability
from verifier.topology.hybrid.flow import EXACT, ROUGH, Hybrid, followed, on_axes, points_in
from verifier.topology.hybrid.saltation import monodromy, sorted_values, transverse
from verifier.topology.hybrid.switch_maps import Closed, Kind, Return, closed
from verifier.topology.paths.seeds import spread
from verifier.topology.slices import shortest
from verifier.topology.words import place_words

SEEDS: Final = 48
"""Trajectories in all modes together, but at least `LEAST` in each."""
LEAST: Final = 8
LASTING: Final = (24.0, 192.0, 1536.0)
"""How long they are followed, in tempos, until they have switched often enough."""
OFTEN: Final = 4
"""How often, for each mode, is enough."""
MOST_COUNT: Final = 8
"""The most switches of one kind in a cycle that is looked for."""
BACK: Final = 1e-2
"""What comes back so close, in widths, may be on the way to a cycle."""
SAME: Final = 2e-3
"""A candidate this close to a known cycle's switch is that cycle."""
SAMPLES: Final = 256
LONGER: Final = 1.01
"""Rounds that are followed, so that the switch that closes the cycle is among those seen."""
AT_ONCE: Final = 1e-9
"""Times of a round that differ by less than this share of its period are one."""
NEUTRAL: Final = 1e-6
AGREEMENT: Final = 1e-4
"""Multipliers by two methods that differ by more than this share are doubtful."""
ENOUGH: Final = 8
"""So many neutral cycles are a continuum; beside fewer of them there may be others."""
CONTINUUM: Final = (
    "trajectories through several modes close wherever they begin: these are not listed as cycles"
)


CHATTERING: Final = "chattering"
"""How a note on trajectories that switch without end begins."""
ONE_PLACE: Final = 1e-3
"""Trajectories that end this close to one another, in widths, come to rest in one place."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Lane:
    """What became of a trajectory: its switches, the points (m,) after them, where it ended.

    chatters, leaves: it ended as it switched without end, or left the domain.
    """

    switches: Switches
    points: Array
    chatters: bool
    leaves: bool
    end: Array


@final
@dataclass(frozen=True, eq=False, slots=True)
class Course:
    """A hybrid cycle with the switches of one round."""

    cycle: Cycle
    switches: Switches


def find_hybrid_cycles(
    hybrid: Hybrid,
) -> tuple[tuple[Cycle, ...], tuple[str, ...], tuple[Array, ...]]:
    """The cycles through switches, the shortest period first, and notes on what is not listed.

    Third, the places (m,) that trajectories come to that switch without end.
    """
    if not np.isfinite(hybrid.tempo):
        return (), (), ()
    lanes = _spread_out(hybrid)
    found: list[Course] = []
    neutral = 0
    for guess in _candidates(hybrid, lanes):
        if _is_known(hybrid, found, guess):
            continue
        exact = closed(hybrid, guess)
        if exact is None or _is_known(hybrid, found, exact.at):
            continue
        course = _course(hybrid, exact)
        if course.cycle.stability is Stability.NEUTRAL:
            neutral += 1
            if neutral == ENOUGH:
                break
        else:
            found.append(course)
    cycles = sorted((course.cycle for course in found), key=lambda cycle: cycle.period)
    chattering, rests = _chattering(hybrid, lanes)
    return tuple(cycles), (*chattering, *([CONTINUUM] if neutral else [])), rests


def _spread_out(hybrid: Hybrid) -> list[Lane]:
    """Lanes from spread places in every mode; slow ones are followed for longer."""
    seeds = spread(hybrid.view, max(LEAST, SEEDS // len(hybrid.modes)))
    waiting = np.concatenate([points_in(hybrid, seeds, mode) for mode in range(len(hybrid.modes))])
    found: list[Lane] = []
    for duration in LASTING:
        times = np.array([0.0, duration * hybrid.tempo])
        ran = followed(hybrid, waiting, times, ROUGH)
        slow = []
        for b in range(len(waiting)):
            lane = _lane(hybrid, ran, b)
            is_short = len(lane.switches) < OFTEN * len(hybrid.modes)
            if is_short and ran.ending(b) is Ending.COMPLETED and duration < LASTING[-1]:
                slow.append(b)
            else:
                found.append(lane)
        if not slow:
            break
        waiting = waiting[slow]
    return found


def _lane(hybrid: Hybrid, ran: Trajectories, b: int) -> Lane:
    switches = ran.switches.of(b)
    ending = ran.ending(b)
    return Lane(
        switches,
        on_axes(hybrid, switches.after),
        ending is Ending.CHATTERING,
        ending is Ending.LEFT_DOMAIN,
        on_axes(hybrid, ran.ended_in[b]),
    )


def _candidates(hybrid: Hybrid, lanes: list[Lane]) -> Iterator[Return]:
    """What trajectories come back to, then crossings of return maps."""
    yield from _recurrences(hybrid, lanes)
    if len(hybrid.view.axes) <= 2:
        yield from _crossings(hybrid, lanes)


def _recurrences(hybrid: Hybrid, lanes: list[Lane]) -> Iterator[Return]:
    """The last switch of each trajectory that has been nearly the same a few rounds before."""
    for lane in lanes:
        mine = lane.switches
        if lane.chatters or len(mine) < 2:
            continue
        kind = (int(mine.left[-1]), int(mine.entered[-1]))
        alike = np.flatnonzero((mine.left == kind[0]) & (mine.entered == kind[1]))
        last = alike[-1]
        for count, other in enumerate(alike[-2 : -2 - MOST_COUNT : -1], start=1):
            step = lane.points[last] - lane.points[other]
            gap = shortest(hybrid.view, step) / hybrid.view.width
            period = float(mine.times[last] - mine.times[other])
            if np.abs(gap).max() < BACK and period > 0.0:
                yield Return(lane.points[last], kind, count, period)
                break


def _crossings(hybrid: Hybrid, lanes: list[Lane]) -> Iterator[Return]:
    """Where, between two neighbours on a line of switches, the return map changes sides."""
    for kind, (points, ends, times) in _returns(lanes).items():
        spreads = points.max(axis=0) - points.min(axis=0)
        axis = int(np.argmax(spreads / hybrid.view.width))
        order = np.argsort(points[:, axis], kind="stable")
        gap = shortest(hybrid.view, ends - points)[order, axis]
        line, duration = points[order], times[order]
        for i in np.flatnonzero(gap[:-1] * gap[1:] < 0.0):
            part = gap[i] / (gap[i] - gap[i + 1])
            period = float(duration[i] + part * (duration[i + 1] - duration[i]))
            yield Return(line[i] + part * (line[i + 1] - line[i]), kind, 1, period)


def _returns(lanes: list[Lane]) -> dict[Kind, tuple[Array, Array, Array]]:
    """For each kind of switch the points after it, those after the next one, and times between."""
    found: dict[Kind, list[tuple[Array, Array, float]]] = {}
    for lane in lanes:
        latest: dict[Kind, int] = {}
        kinds = zip(lane.switches.left.tolist(), lane.switches.entered.tolist(), strict=True)
        for i, kind in enumerate(kinds):
            if kind in latest:
                j = latest[kind]
                waited = float(lane.switches.times[i] - lane.switches.times[j])
                found.setdefault(kind, []).append((lane.points[j], lane.points[i], waited))
            latest[kind] = i
    return {
        kind: (
            np.array([pair[0] for pair in pairs]),
            np.array([pair[1] for pair in pairs]),
            np.array([pair[2] for pair in pairs]),
        )
        for kind, pairs in found.items()
    }


def _is_known(hybrid: Hybrid, found: list[Course], guess: Return) -> bool:
    """Whether a known cycle has a switch of the same kind there."""
    for course in found:
        alike = (course.switches.left == guess.kind[0]) & (course.switches.entered == guess.kind[1])
        points = on_axes(hybrid, course.switches.after[alike])
        gaps = shortest(hybrid.view, points - guess.point) / hybrid.view.width
        if np.any(np.abs(gaps).max(axis=-1, initial=0.0) < SAME):
            return True
    return False


def _course(hybrid: Hybrid, exact: Closed) -> Course:
    """The cycle with its multipliers and points."""
    period = exact.at.period
    start = points_in(hybrid, exact.at.point, exact.at.kind[1])
    clock = period * np.arange(SAMPLES) / SAMPLES
    ran = followed(hybrid, start[None], np.append(clock, LONGER * period), EXACT)
    switches = _round(ran.switches, exact.switches)
    values = sorted_values(exact.derivative)[:-1]
    second = transverse(hybrid, start, monodromy(hybrid, start, switches))
    pairs = zip(values, second, strict=True)
    apart = [not abs(a - b) <= AGREEMENT * (1.0 + abs(a)) for a, b in pairs]
    times, states = _drawn(ran, clock, start, switches, exact)
    error = float(np.max(hybrid.view.accuracy / hybrid.view.width)) * period
    cycle = Cycle(
        times=frozen(times),
        points=frozen(_closing(hybrid, on_axes(hybrid, states), exact)),
        period=period,
        stability=stability(values, NEUTRAL + error),
        multipliers=values,
        cross_checked=second,
        doubtful=any(apart),
        turns=tuple(int(turn) for turn in exact.turns),
        modes=tuple(int(mode) for mode in states[:, hybrid.column]),
    )
    return Course(cycle, switches)


def _round(switches: Switches, count: int) -> Switches:
    """The first `count` switches."""
    return Switches(
        switches.trajectories[:count],
        switches.times[:count],
        switches.left[:count],
        switches.entered[:count],
        switches.before[:count],
        switches.after[:count],
    )


def _closing(hybrid: Hybrid, points: Array, exact: Closed) -> Array:
    """The points with the last one where it must be: at the first, or whole turns from it."""
    points[-1] = points[0] + exact.turns * hybrid.view.width
    return points


def _drawn(
    ran: Trajectories, clock: Array, start: Array, switches: Switches, exact: Closed
) -> tuple[Array, Array]:
    """Times (T,) and states (T, n) of a round: samples, and both sides of every switch.

    Samples at the very time of a switch may be of either side, by rounding, and are left out.
    """
    period = exact.at.period
    gaps = np.abs(clock[1:, None] - switches.times)
    kept = np.concatenate([[True], np.all(gaps > AT_ONCE * period, axis=-1)])
    switched = np.minimum(switches.times, period)
    times = np.concatenate([clock[kept], switched, switched, [period]])
    sampled = ran.states[0, : len(clock)][kept]
    states = np.concatenate([sampled, switches.before, switches.after, start[None]])
    rank = np.repeat([0, 1, 2, 3], [len(sampled), len(switches), len(switches), 1])
    order = np.lexsort((rank, times))
    return times[order], states[order]


def _chattering(hybrid: Hybrid, lanes: list[Lane]) -> tuple[list[str], tuple[Array, ...]]:
    """A sentence for each pair of modes between which trajectories switch without end, and where.

    The places are those that most of a pair end in. The last sentence goes on with what becomes of
    the other trajectories.
    """
    seen: dict[Kind, list[Array]] = {}
    for lane in lanes:
        if lane.chatters:
            low, high = sorted((int(lane.switches.left[-1]), int(lane.switches.entered[-1])))
            seen.setdefault((low, high), []).append(lane.end)
    notes, rests = [], list[Array]()
    for (low, high), places in seen.items():
        share = 100.0 * len(places) / len(lanes)
        middle = np.median(places, axis=0)
        gaps = np.abs(shortest(hybrid.view, np.array(places) - middle)) / hybrid.view.width
        if np.mean(gaps.max(axis=-1) < ONE_PLACE) > 0.5:
            rests.append(frozen(middle))
        where = place_words(hybrid.view.axes, middle)
        first, second = hybrid.modes[low], hybrid.modes[high]
        what = f"between '{first}' and '{second}'" if low != high else f"of '{first}'"
        notes.append(
            f"{CHATTERING}: {share:.0f} % of the trajectories switch without end {what} ({where})"
        )
    if notes:
        notes[-1] += _of_the_others(lanes)
    return notes, tuple(rests)


def _of_the_others(lanes: list[Lane]) -> str:
    """What becomes of the trajectories that do not chatter: `; 27 % leave the domain`."""
    leave = sum(lane.leaves for lane in lanes)
    on = sum(not lane.leaves and not lane.chatters for lane in lanes)
    told = [(leave, "leave the domain"), (on, "go on for as long as they were followed")]
    return "".join(f"; {100.0 * n / len(lanes):.0f} % {what}" for n, what in told if n)
