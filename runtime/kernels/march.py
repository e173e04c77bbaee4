"""Fixed steps, compiled: the classical Runge-Kutta method (Kutta 1901), and discrete-time maps.

Every trajectory has its own times; inputs are held during a step. A step of length 0 does nothing.
"""
# ruff: noqa: PLR0917 - kernels take arguments by place

from typing import NamedTuple

from runtime.arrays import Array, Integers
from runtime.kernels.blocks import (
    COMPLETED,
    DIVERGED,
    LEFT_DOMAIN,
    Block,
    Domain,
    Results,
    blank,
    copy_lanes,
    end,
    end_at,
    first_exit,
    is_finite,
    load,
    nearer_side,
    new_block,
    outside,
    point,
    side_of,
    take_rates,
)
from runtime.kernels.cache import kernel, part
from runtime.kernels.machine import run
from runtime.kernels.tape import LANES, Tape


class Course(NamedTuple):
    """The times (B or 1, S + 1), and inputs (B or 1, S or 1, k) for the register's `columns`."""

    times: Array
    inputs: Array
    columns: Integers


@kernel
def march(
    tape: Tape, domain: Domain, start: Array, course: Course, steps_map: int, results: Results
) -> None:
    """Integrate from the registers `start` (B, r); a map is iterated where `steps_map` is 1."""
    block = new_block(tape)
    for first in range(0, start.shape[0], LANES):
        lanes = min(LANES, start.shape[0] - first)
        for lane in range(lanes):
            load(block, lane, start[first + lane])
        for s in range(course.times.shape[1] - 1):
            if _begin(block, domain, course, s, first, lanes, results) == 0:
                break
            if steps_map == 1:
                _map_step(tape, block, domain.moving, lanes)
            else:
                _runge_kutta_step(tape, block, domain.moving, lanes)
            _finish(tape, block, domain, s, first, lanes, steps_map == 1, results)
        _complete(block, course, first, lanes, results)


@part
def _begin(
    block: Block,
    domain: Domain,
    course: Course,
    s: int,
    first: int,
    lanes: int,
    results: Results,
) -> int:
    """Take the step's length and inputs; end lanes that are outside; how many go on."""
    going = 0
    n = block.x.shape[0]
    for lane in range(lanes):
        b = first + lane
        times = course.times[b if course.times.shape[0] > 1 else 0]
        block.t[lane] = times[s]
        block.h[lane] = times[s + 1] - times[s] if block.alive[lane] else 0.0
        if not block.alive[lane]:
            continue
        if block.h[lane] != 0.0:
            _take_inputs(block, course, b, s, lane)
        for i in range(n):
            results.states[b, s, i] = block.x[i, lane]
        left = outside(block.rows, lane, 0, domain.lows.shape[0], domain)
        if left >= 0 and block.h[lane] != 0.0:
            side = side_of(block.rows[left, lane], domain.highs[left])
            end(results, b, LEFT_DOMAIN, left, side, times[s])
            end_at(results, b, block.x, lane)
            blank(results, b, s)
            block.alive[lane] = False
        else:
            going += 1
    return going


@part
def _take_inputs(block: Block, course: Course, b: int, s: int, lane: int) -> None:
    inputs = course.inputs[b if course.inputs.shape[0] > 1 else 0]
    values = inputs[s if course.inputs.shape[1] > 1 else 0]
    for j in range(course.columns.shape[0]):
        entry = course.columns[j]
        block.rows[entry, lane] = values[j]
        if entry < block.x.shape[0]:
            block.x[entry, lane] = values[j]


@part
def _map_step(tape: Tape, block: Block, moving: Integers, lanes: int) -> None:
    run(tape, block.rows, block.points, lanes)
    take_rates(tape, block, 0, lanes)
    copy_lanes(block.x, block.new, lanes)
    for j in range(moving.shape[0]):
        for lane in range(lanes):
            block.new[moving[j], lane] = block.k[0, moving[j], lane]


@part
def _runge_kutta_step(tape: Tape, block: Block, moving: Integers, lanes: int) -> None:
    """From x to new; the register's states are left at the last stage."""
    for i in range(block.x.shape[0]):
        for lane in range(lanes):
            block.new[i, lane] = 0.0
    for stage in range(4):
        run(tape, block.rows, block.points, lanes)
        take_rates(tape, block, 0 if stage == 0 else 1, lanes)
        k = block.k[0 if stage == 0 else 1]
        weight = 1.0 / 6.0 if stage in {0, 3} else 1.0 / 3.0
        reach = 1.0 if stage == 2 else 0.5
        for j in range(moving.shape[0]):
            i = moving[j]
            for lane in range(lanes):
                block.new[i, lane] += weight * k[i, lane]
                block.rows[i, lane] = block.x[i, lane] + reach * block.h[lane] * k[i, lane]
    for i in range(block.x.shape[0]):
        for lane in range(lanes):
            block.new[i, lane] = block.x[i, lane] + block.h[lane] * block.new[i, lane]


@part
def _finish(
    tape: Tape,
    block: Block,
    domain: Domain,
    s: int,
    first: int,
    lanes: int,
    is_map: bool,  # noqa: FBT001  # kernels take arguments by place
    results: Results,
) -> None:
    """Accept the step of each lane, or end the lane; x and the register go on to new."""
    n = block.x.shape[0]
    leaving = 0
    for lane in range(lanes):
        if block.h[lane] == 0.0:
            for i in range(n):
                block.new[i, lane] = block.x[i, lane]
        elif is_finite(block.new, lane) and outside(block.new, lane, 0, n, domain) >= 0:
            leaving += 1
    copy_lanes(block.new, block.rows, lanes)
    if leaving > 0 and not is_map:
        run(tape, block.rows, block.points, lanes)
        take_rates(tape, block, 1, lanes)
    for lane in range(lanes):
        if block.h[lane] != 0.0:
            _settle(block, domain, lane, is_map, results, first + lane, s + 1)
    copy_lanes(block.new, block.x, lanes)


@part
def _settle(
    block: Block,
    domain: Domain,
    lane: int,
    is_map: bool,  # noqa: FBT001  # kernels take arguments by place
    results: Results,
    b: int,
    sample: int,
) -> None:
    n = block.x.shape[0]
    left = outside(block.new, lane, 0, n, domain)
    if not is_finite(block.new, lane):
        end(results, b, DIVERGED, -1, 0, block.t[lane])
        end_at(results, b, block.x, lane)
    elif left >= 0 and is_map:
        side = side_of(block.new[left, lane], domain.highs[left])
        end(results, b, LEFT_DOMAIN, left, side, block.t[lane] + block.h[lane])
        end_at(results, b, block.new, lane)
    elif left >= 0:
        _leave(block, domain, lane, left, results, b)
    else:
        return
    block.alive[lane] = False
    blank(results, b, sample)


@part
def _leave(block: Block, domain: Domain, lane: int, left: int, results: Results, b: int) -> None:
    """End a lane where the cubic through both ends of the step leaves the domain."""
    h = block.h[lane]
    dense = block.dense
    for i in range(block.x.shape[0]):
        dense[0, i] = block.x[i, lane]
        dense[1, i] = dense[2, i] = dense[3, i] = dense[4, i] = 0.0
    for j in range(domain.moving.shape[0]):
        i = domain.moving[j]
        dense[1, i] = block.new[i, lane] - block.x[i, lane]
        dense[2, i] = h * block.k[0, i, lane] - dense[1, i]
        dense[3, i] = dense[1, i] - h * block.k[1, i, lane] - dense[2, i]
    theta, variable = first_exit(dense, domain)
    variable = left if variable < 0 else variable
    side = nearer_side(point(dense, variable, theta), variable, domain)
    end(results, b, LEFT_DOMAIN, variable, side, block.t[lane] + theta * h)
    for i in range(block.x.shape[0]):
        results.ended[b, 1 + i] = point(dense, i, theta)


@part
def _complete(block: Block, course: Course, first: int, lanes: int, results: Results) -> None:
    last = course.times.shape[1] - 1
    for lane in range(lanes):
        if block.alive[lane]:
            b = first + lane
            for i in range(block.x.shape[0]):
                results.states[b, last, i] = block.x[i, lane]
            time = course.times[b if course.times.shape[0] > 1 else 0, last]
            end(results, b, COMPLETED, -1, 0, time)
            end_at(results, b, block.x, lane)
