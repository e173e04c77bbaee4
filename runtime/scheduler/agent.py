"""One robot's control: its nodes, its board, who acts, and what its channels get."""

from collections.abc import Callable, Mapping
from typing import final

import numpy as np

from runtime import chance
from runtime.arbitration.build import arbiter_of
from runtime.architecture import Architecture, Node
from runtime.arrays import Array, Booleans
from runtime.scenario import Robot, Scenario
from runtime.scheduler.acting import Acting
from runtime.scheduler.board import Board
from runtime.scheduler.channels import Resolver
from runtime.scheduler.clock import whole_steps
from runtime.scheduler.inputs import Inputs, domain_of
from runtime.scheduler.nodes import (
    ArbiterNode,
    BehaviorNode,
    Learner,
    ModuleNode,
    Said,
    Ticking,
)
from runtime.scheduler.observer import Event, Observer, Resolved, Silent, Tick, What
from runtime.scheduler.ticker import Ticker, domains_of
from runtime.user_code import Callee


@final
class Agent:
    """What runs on one robot; the scheduler says when.

    periods, delays: (nodes,) of each node in whole steps. order: of ticks at one instant.
    """

    def __init__(
        self,
        scenario: Scenario,
        place: int,
        code: Callable[[str], Callee],
        learners: Mapping[str, Learner],
        observer: Observer,
    ) -> None:
        robot = scenario.robots[place]
        architecture = robot.architecture
        self._place, self._observer = place, observer
        self._is_observed = type(observer) is not Silent
        self._architecture = architecture
        self.board = Board(architecture, robot.body.sensors)
        self.nodes = [
            _node(scenario, robot, node, code, learners.get(f"{robot.name}.{node.name}"))
            for node in architecture.nodes
        ]
        self.periods = [whole_steps(node.period, scenario.step) for node in architecture.nodes]
        self.delays = [whole_steps(n.response_time, scenario.step) for n in architecture.nodes]
        self.order = architecture.order
        self.acting = Acting(architecture, [node.inputs for node in self.nodes])
        self._commands = [np.zeros(len(node.commands)) for node in architecture.nodes]
        self._chooses = [node.arbiter >= 0 for node in architecture.nodes]
        self.channels = [Resolver(architecture, i, code) for i in range(len(architecture.channels))]
        self.set_points: Array = np.zeros(len(self.channels))
        self.driven: Booleans = np.zeros(len(self.channels), dtype=np.bool_)
        self._acting_may_differ = self._channels_may_differ = True
        self.accelerates = False
        self._told: dict[tuple[int, int], tuple[What, ...]] = {}
        self._told_how: list[Resolved | None] = [None] * len(self.channels)

    def tick(self, instant: int, time: float, node: int) -> Said:
        """Let one node sample the board."""
        allowed = self.acting.allowed[node]
        said = self.nodes[node].tick(self.board.values, time, allowed=allowed)
        if said.remarks or self._told:
            self._tell(instant, node, -1, said.remarks)
        if self._is_observed:
            register, outputs, commands, acts, _ = said
            acts = allowed and acts
            tick = Tick(self._place, node, register, outputs, commands, allowed, acts)
            self._observer.ticked(instant, tick)
        return said

    def let_speak(self, node: int, said: Said) -> None:
        """Let what a node said take effect."""
        if said.outputs.size:
            self.board.write(node, said.outputs)
        if self._chooses[node] or said.acts != self.acting.is_ready[node]:
            self.acting.is_ready[node] = said.acts
            self._acting_may_differ = True
        if said.commands.size:
            self._commands[node] = said.commands
            self._channels_may_differ |= self.acting.does[node]

    def settle(self, instant: int) -> None:
        """Work out who acts, if that may differ from before."""
        if self._acting_may_differ:
            self._acting_may_differ = False
            if self.acting.settle(self.board.values):
                self._channels_may_differ = True
                self._observer.acting(instant, self._place, self.acting.acts, self.acting.weights)

    def drive(self, instant: int, step: float) -> bool:
        """Resolve the channels, and let accelerated ones go a step on; whether any is set anew."""
        anew = self._channels_may_differ
        if anew:
            self._channels_may_differ = False
            for channel in self.channels:
                channel.resolve(self.acting, self._commands)
            self.accelerates = any(channel.rate != 0.0 for channel in self.channels)
        elif not self.accelerates:
            return False
        for place, channel in enumerate(self.channels):
            channel.accelerate(step)
            self.set_points[place], self.driven[place] = channel.value, channel.is_driven
            self._remark(instant, place, channel)
        self._observer.commanded(instant, self._place, self.set_points, self.driven)
        return True

    def state(self) -> list[Array]:
        """All that what it does next depends on, but for what is said and not yet in effect."""
        return [
            self.board.values,
            self.acting.acts.astype(np.float64),
            self.set_points,
            self.driven.astype(np.float64),
            *self._commands,
            *(node.state() for node in self.nodes),
        ]

    def _remark(self, instant: int, place: int, channel: Resolver) -> None:
        how = channel.how
        told = self._told_how[place]
        if how is not told and how != told:
            self._told_how[place] = how
            self._observer.resolved(instant, self._place, place, how)
            flags = ((how.is_in_conflict, What.CONFLICT), (how.is_limited, What.LIMITED))
            self._tell(instant, -1, place, tuple(what for is_so, what in flags if is_so))

    def _tell(self, instant: int, node: int, channel: int, remarks: tuple[What, ...]) -> None:
        """Tell what was not so before; what has ended may be told again."""
        before = self._told.get((node, channel), ())
        if remarks != before:
            self._told[node, channel] = remarks
            for what in remarks:
                if what not in before:
                    self._observer.happened(instant, Event(self._place, what, node, channel))


def _node(
    scenario: Scenario,
    robot: Robot,
    node: Node,
    code: Callable[[str], Callee],
    learner: Learner | None,
) -> Ticking:
    name = f"{robot.name}.{node.name}"
    if node.behavior >= 0:
        return BehaviorNode(_ticker(scenario, robot.architecture, node, name))
    if node.arbiter >= 0:
        return _arbiter(scenario, robot.architecture, node, name, code, learner)
    tells = tuple(robot.architecture.board[i].name.rpartition(".")[2] for i in node.outputs)
    return ModuleNode(node.module, code(node.module), Inputs(node.inputs, {}), tells)


def _ticker(scenario: Scenario, architecture: Architecture, node: Node, name: str) -> Ticker:
    program = architecture.programs[node.behavior]
    inputs = Inputs(node.inputs, domains_of(program))
    generator = chance.generator(scenario.seed, "node", name)
    ticker = Ticker(program, inputs, node.commands, node.acts_when, node.period, generator)
    for full, value in scenario.beginnings.items():
        whose, _, state = full.rpartition(".")
        if whose == name:
            ticker.begin(state, value)
    return ticker


def _arbiter(
    scenario: Scenario,
    architecture: Architecture,
    node: Node,
    name: str,
    code: Callable[[str], Callee],
    learner: Learner | None,
) -> ArbiterNode:
    compiled = architecture.arbiters[node.arbiter]
    reads = {read.name: domain_of(read.kind, read.low, read.high) for read in compiled.reads}
    controls = {control.name: (control.low, control.high, 0.0) for control in compiled.controls}
    inputs = Inputs(node.inputs, {**reads, **controls})
    arbiter = learner.arbiter if learner else arbiter_of(compiled, name, node.period, code)
    arbiter.reset(scenario.seed)
    return ArbiterNode(compiled, arbiter, inputs, learner.reward if learner else None)
