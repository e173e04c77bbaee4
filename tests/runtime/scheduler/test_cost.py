"""What ticks and idle instants cost: processor time, so that a busy machine changes little."""

import time
from collections.abc import Callable

from runtime.scheduler.scheduler import Scheduler
from tests.runtime.behaviors import van_der_pol
from tests.runtime.scheduler.plane import STEP, N, Plain, Plane, architecture, scenario

TICK, IDLE = 40e-6, 3e-6
"""Seconds that a tick of a formula of two states, and an instant with nothing due, may take."""
COUNT = 10_000


class Still(Plane):
    """A world that takes no time."""

    def advance(self) -> None:
        pass


class Once(Plain):
    """Sensors that sample at the beginning and never again."""

    def due(self, instant: int) -> list:  # type: ignore[type-arg]
        now = super().due(instant)
        self.next_due = 2**62
        return now


def least(run: Callable[[], None]) -> float:
    """The least processor time of some tries."""
    tries = []
    for _ in range(3):
        begun = time.process_time()
        run()
        tries.append(time.process_time() - begun)
    return min(tries)


def swinging(period: int) -> Scheduler:
    node = N(
        "swing",
        van_der_pol(),
        period * STEP,
        0.0,
        {"x": "pos.x", "v": "pos.y"},
        {"x": ("x", "rate"), "y": ("v", "set-point")},
    )
    plane = Still([(0.5, 0.5)])
    scheduler = Scheduler(scenario(architecture([node])), plane, Once(plane))
    scheduler.step()
    return scheduler


def test_a_tick_is_quick() -> None:
    scheduler = swinging(1)
    agent = scheduler.agents[0]

    def ticks() -> None:
        for instant in range(COUNT):
            agent.tick(instant, 0.0, 0)

    assert least(ticks) / COUNT < TICK


def test_an_instant_with_nothing_due_costs_next_to_nothing() -> None:
    scheduler = swinging(10**9)

    assert least(lambda: scheduler.run(COUNT)) / COUNT < IDLE


def test_an_instant_with_a_tick_and_two_channels_is_quick() -> None:
    scheduler = swinging(1)

    assert least(lambda: scheduler.run(COUNT)) / COUNT < 2.0 * TICK
