"""The scheduler: many nodes at their own rates, in simulated time, the same on every machine.

The six phases of an instant (docs/adr/0020): sensors, readings, what was said before, ticks,
channels, physics. No clock of a computer is read anywhere.
"""

from collections.abc import Callable, Mapping
from hashlib import blake2b
from heapq import heappop, heappush
from pathlib import Path
from typing import Final, final

import numpy as np

from runtime.scenario import Scenario
from runtime.scheduler.agent import Agent
from runtime.scheduler.clock import Clock
from runtime.scheduler.environment import Environment, Sensors
from runtime.scheduler.nodes import Learner, Said
from runtime.scheduler.observer import Observer, Silent
from runtime.user_code import Callee, UserCodeError, load_callee, where_is

NEVER: Final = 2**62
NO_LEARNERS: Final[Mapping[str, Learner]] = {}


@final
class Scheduler:
    """Runs the architectures of a scenario's robots in an environment.

    instant: how many steps have been taken; instant 0 is the beginning.
    """

    def __init__(
        self,
        scenario: Scenario,
        environment: Environment,
        sensors: Sensors,
        *,
        allow_code: bool = False,
        beside: Path | None = None,
        observer: Observer | None = None,
        learners: Mapping[str, Learner] = NO_LEARNERS,
    ) -> None:
        """Begin at instant 0, before anything has happened.

        allow_code: whether Python that the scenario names may be run. beside: the folder where it
        is looked for; None for that of each architecture's own file. learners: by `robot.node`,
        what decides instead of the arbiter that the architecture has there.

        Raises:
            UserCodeError: there is code of the user's own that may not be run, or is not found.
            ValueError: a duration is no multiple of the step, or parts do not fit together.
        """
        self._step = scenario.step
        self._environment, self._sensors = environment, sensors
        self._observer = observer or Silent()
        self.agents = [
            Agent(
                scenario,
                place,
                _finder(
                    beside or Path(robot.architecture.source.file).parent, allow_code=allow_code
                ),
                learners,
                self._observer,
            )
            for place, robot in enumerate(scenario.robots)
        ]
        self._who = [(i, node) for i, agent in enumerate(self.agents) for node in agent.order]
        self._clock = Clock([self.agents[i].periods[node] for i, node in self._who])
        self._pending: list[tuple[int, int, int, Said]] = []
        self._next = 0
        self.instant = 0

    @property
    def time(self) -> float:
        """Seconds since the beginning."""
        return self.instant * self._step

    def step(self) -> None:
        """One instant, and the step of physics after it.

        Raises:
            UserCodeError: the user's code raised, or gave what it should not.
        """
        if self.instant >= self._next:
            self._pass_through()
        self._environment.advance()
        self.instant += 1

    def run(self, instants: int) -> None:
        """So many steps."""
        advance = self._environment.advance
        for _ in range(instants):
            if self.instant >= self._next:
                self._pass_through()
            advance()
            self.instant += 1

    def state_hash(self) -> bytes:
        """A digest (16 bytes) of boards, own states, commands, what is on its way, and world."""
        digest = blake2b(digest_size=16)
        digest.update(self.instant.to_bytes(8, "little"))
        for agent in self.agents:
            for array in agent.state():
                digest.update(array.tobytes())
        for instant, robot, node, said in sorted(self._pending, key=lambda entry: entry[:3]):
            digest.update(np.array([instant, robot, node, said.acts], dtype=np.int64).tobytes())
            digest.update(said.outputs.tobytes() + said.commands.tobytes())
        digest.update(self._sensors.state().tobytes())
        digest.update(self._environment.state_hash())
        return digest.digest()

    def _pass_through(self) -> None:
        """The phases of an instant at which something is due."""
        instant, time = self.instant, self.time
        if self._sensors.next_due <= instant:
            for delivery in self._sensors.due(instant):
                self.agents[delivery.robot].board.sense(delivery.sensor, delivery.readings)
                self._observer.sensed(instant, delivery)
        while self._pending and self._pending[0][0] <= instant:
            _, robot, node, said = heappop(self._pending)
            self.agents[robot].let_speak(node, said)
        for agent in self.agents:
            agent.settle(instant)
        for who in self._clock.due(instant):
            robot, node = self._who[who]
            agent = self.agents[robot]
            said = agent.tick(instant, time, node)
            if agent.delays[node] == 0:
                agent.let_speak(node, said)
                agent.settle(instant)
            else:
                heappush(self._pending, (instant + agent.delays[node], robot, node, said))
        accelerates = False
        for robot, agent in enumerate(self.agents):
            if agent.drive(instant, self._step):
                self._environment.command(robot, agent.set_points, agent.driven)
            accelerates |= agent.accelerates
        self._next = instant + 1 if accelerates else self._next_due()

    def _next_due(self) -> int:
        """The next instant at which anything is due."""
        ticks = self._clock.next_due
        speech = self._pending[0][0] if self._pending else NEVER
        return min(self._sensors.next_due, speech, NEVER if ticks is None else ticks)


def _finder(beside: Path, *, allow_code: bool) -> Callable[[str], Callee]:
    """What finds the user's code in a folder, if it may be run."""

    def find(text: str) -> Callee:
        if not allow_code:
            place = where_is(text, beside)
            raise UserCodeError(f"{text} is code ({place}), which is run only with --allow-code")
        return load_callee(text, beside)

    return find
