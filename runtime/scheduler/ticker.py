"""Ticks of a behavior: its program, packed for one compiled call a tick."""

from collections.abc import Callable, Sequence
from functools import partial
from typing import Final, final

import numpy as np

from runtime.architecture import Command
from runtime.arrays import Array, Integers, frozen
from runtime.code import ONE, Code
from runtime.direct_calls import machine_code
from runtime.flow import Source, rate_of
from runtime.kernels.tape import LANES, Tape
from runtime.program import Kind, Program, Role, State
from runtime.scheduler.inputs import ANY, Domain, Inputs, domain_of
from runtime.scheduler.kernels.tick import (
    AS_ENTRY,
    AS_NEXT,
    AS_OUTPUT,
    AS_RATE,
    BARRED,
    BROKEN,
    COMMANDS,
    NOTHING,
    OUTSIDE,
    OWN,
    Frame,
    bench,
    tick,
)
from runtime.tape import Sum, pack, read_only_integers

AGAINST: Final = OUTSIDE | BARRED | BROKEN
"""Flags that keep a behavior from acting."""
ROOM: Final = 9
LATER: Final = 6
"""The row of the room with the behavior's own states."""


@final
class Ticker:
    """One behavior that ticks: its own states, and what it says at each tick.

    register: (r,) after a tick everything as it was at the sample. told: (q + c,) outputs, then
    commands. Both are overwritten by the next tick.
    """

    def __init__(
        self,
        program: Program,
        inputs: Inputs,
        commands: Sequence[Command],
        acts_when: Code | None,
        period: float,
        generator: np.random.Generator,
    ) -> None:
        self.program = program
        self.inputs = inputs
        self._frame = _frame(program, inputs, commands, acts_when or ONE, period)
        self.register: Array = np.array(
            [
                *(state.hold for state in program.states),
                *(control.default for control in program.controls),
                *(constant.value for constant in program.constants),
            ]
        )
        self._frame.room[LATER] = self.register[: len(program.states)]
        self.told: Array = np.zeros(len(program.outputs) + len(commands))
        self._generator = generator
        self._kicks: Array = np.zeros(len(program.noise))
        self._tick: Callable[[Array, int], int] | None = None

    @property
    def own(self) -> Array:
        """The states (n,) that the next tick starts from; only its own ones mean anything."""
        later: Array = self._frame.room[LATER]
        return later

    def begin(self, state: str, value: float) -> None:
        """Let one of its own states start from `value`.

        Raises:
            ValueError: it has no such state of its own.
        """
        names = [state.name for state in self.program.states]
        if state not in names or names.index(state) not in self._frame.own:
            raise ValueError(f"'{state}' is no state of {self.program.name}'s own")
        self.own[names.index(state)] = value

    def tick(self, board: Array, *, allowed: bool) -> int:
        """Sample the board, and look a period ahead; flags.

        allowed: whether nothing outside it keeps it from acting; if it has its way, its own
        states go on.
        """
        if self._kicks.size:
            # Drawn whether or not it acts, so that its numbers do not depend on who inhibits it.
            self._generator.standard_normal(out=self._kicks)
        if self._tick is None:
            self._tick = self._compiled(board)
        return self._tick(board, int(allowed))

    def _compiled(self, board: Array) -> Callable[[Array, int], int]:
        """What ticks: the compiled function, with all that it works on laid out for it."""
        given = (self.inputs.signals, self.inputs.values, self.register, self._kicks, self.told)
        laid_out = bench(self._frame, *given)
        return partial(machine_code(tick, (laid_out, board, 1)), laid_out)


def domains_of(program: Program) -> dict[str, Domain]:
    """The domain of each state and control."""
    states = {s.name: domain_of(s.kind, s.low, s.high) for s in program.states}
    return {**states, **{c.name: (c.low, c.high, 0.0) for c in program.controls}}


def _frame(
    program: Program, inputs: Inputs, commands: Sequence[Command], acts_when: Code, period: float
) -> Frame:
    names = [state.name for state in program.states]
    tape = _rates(program)
    rest, ways, jumps = _rest(program, acts_when)
    entries = [program.register.index(entry) for entry in inputs.entries]
    moving = [i for i, name in enumerate(names) if name in program.field.driven]
    own = [i for i, state in enumerate(program.states) if _is_own(program, state)]
    packed = [_packed(command, program) for command in commands]
    ahead = _looks_ahead(packed, own)
    moved = set(program.field.driven) - {program.field.mode}  # a mode only by guards
    return Frame(
        tape=tape,
        rest=rest,
        inputs=_whole(list(zip(entries, inputs.inhibits.tolist(), strict=True)), 2),
        scaling=frozen(np.column_stack([inputs.scales, inputs.low, inputs.high, inputs.turns])),
        ways=ways,
        jumps=jumps,
        noisy=read_only_integers([names.index(noise.state) for noise in program.noise]),
        moving=read_only_integers(moving),
        own=read_only_integers(own),
        edges=frozen(np.array([_edges(state) for state in program.states]).T),
        commands=_whole(packed, 2),
        signs=frozen([command.sign for command in commands]),
        period=period,
        mode=names.index(program.field.mode) if program.field.mode else -1,
        outputs=len(program.outputs),
        is_map=int(program.field.is_map),
        looks_ahead=ahead,
        steady_rates=int(not moved & _read_by(_taken(program, ahead, own), program)),
        steady_guards=int(not moved & _read_by(_guards(program), program)),
        work=_work(tape),
        rest_work=_work(rest),
        room=np.zeros((ROOM, len(names))),
    )


def _rates(program: Program) -> Tape:
    """What gives the rates of all states; those that are only sensed are held."""
    results = _results(program)
    return pack(results, program.register, program.field.tables, program.field.coordinates)


def _results(program: Program) -> list[Code | Sum]:
    results: list[Code | Sum] = []
    for index, state in enumerate(program.states):
        still = Code(state.name) if program.field.is_map else Code("0")
        moves = state.name in program.field.driven
        results.append(rate_of(program, index, Source.TABLES) if moves else still)
    return results


def _taken(program: Program, ahead: int, own: Sequence[int]) -> list[Code | Sum]:
    """The rates of the states that are taken a period on; guards and jumps may read all."""
    results = _results(program)
    takes_all = ahead == COMMANDS or program.field.guards or program.noise
    return results if takes_all else [results[i] for i in own]


def _guards(program: Program) -> list[Code | Sum]:
    return [guard.condition for guard in program.field.guards]


def _read_by(results: Sequence[Code | Sum], program: Program) -> set[str]:
    """The entries of the register that some results are worked out from, tables and all."""
    codes = [result for result in results if isinstance(result, Code)]
    for result in results:
        if isinstance(result, Sum):
            for code, table, _ in result.parts:
                axes = program.field.tables[table].axes if table >= 0 else ()
                codes += [code, *(Code(axis.name) for axis in axes)]
    behind = {one.name: set(one.code.tokens) for one in program.field.coordinates}
    names = {token for code in codes for token in code.tokens}
    return names.union(*(behind.get(name, set()) for name in names))


def _rest(program: Program, acts_when: Code) -> tuple[Tape, Integers, Integers]:
    """What gives all the rest, and the guards' ways and jumps."""
    names = [state.name for state in program.states]
    ways: list[tuple[int, int, int, int]] = []
    jumps: list[tuple[int, Code]] = []
    for guard in program.field.guards:
        ways.append((guard.mode, guard.target, len(jumps), len(guard.resets)))
        jumps += [(names.index(name), code) for name, code in guard.resets]
    codes = (
        acts_when,
        *(output.code for output in program.outputs),
        *(noise.size for noise in program.noise),
        *(guard.condition for guard in program.field.guards),
        *(code for _, code in jumps),
    )
    return (
        pack(codes, program.register, ()),
        _whole(ways, 4),
        read_only_integers([state for state, _ in jumps]),
    )


def _is_own(program: Program, state: State) -> bool:
    return state.role is Role.DRIVEN or state.name == program.field.mode


def _edges(state: State) -> Domain:
    return ANY if state.kind is Kind.DISCRETE else domain_of(state.kind, state.low, state.high)


def _packed(command: Command, program: Program) -> tuple[int, int]:
    names = [state.name for state in program.states]
    outputs = [output.name for output in program.outputs]
    if command.entry in outputs:
        return AS_OUTPUT, outputs.index(command.entry)
    if command.entry not in program.field.driven:
        return AS_ENTRY, program.register.index(command.entry)
    return AS_NEXT if command.mode == "set-point" else AS_RATE, names.index(command.entry)


def _looks_ahead(commands: Sequence[tuple[int, int]], own: Sequence[int]) -> int:
    if any(what == AS_NEXT for what, _ in commands):
        return COMMANDS
    return OWN if own else NOTHING


def _whole(rows: Sequence[Sequence[int]], columns: int) -> Integers:
    return read_only_integers(np.reshape(np.array(rows, dtype=np.int64), (-1, columns)))


def _work(tape: Tape) -> Array:
    """Rows for a tape to work in, with its literals in place."""
    work = np.zeros((tape.rows, LANES))
    work[tape.entries : tape.entries + tape.literals.size] = tape.literals[:, np.newaxis]
    return work
