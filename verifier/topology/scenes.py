"""Portraits of a behavior at many settings of its controls, each made once."""

from dataclasses import replace
from typing import Final, final

from runtime.program import Kind, Program
from verifier.topology.features import Portrait, Settings
from verifier.topology.portrait import Detail, portrait

RAYS: Final = 1
"""From each fixed point, to find cycles; limits of trajectories are looked at beside them."""

NODES: Final = 33
"""Per axis of the sampled field, which no claim is about."""

CELLS: Final = {1: 1024, 2: 96, 3: 24, 4: 10}
"""Cells per axis of a basin, by the number of axes."""


@final
class Scenes:
    """The portraits of a behavior at different settings, each made once.

    Over all states that move by themselves and are not held by the setting.
    """

    def __init__(self, program: Program) -> None:
        self.program = program
        self._made: dict[tuple[Settings, bool, bool], Portrait] = {}
        self._defaults = {control.name: control.default for control in program.controls}

    def axes(self, settings: Settings) -> tuple[str, ...]:
        """The states that move at `settings`."""
        held = {name for name, _ in settings}
        return tuple(
            state.name
            for state in self.program.states
            if (state.is_driven or state.closure is not None)
            and state.kind is not Kind.DISCRETE
            and state.name not in held
        )

    def at(self, settings: Settings, *, cycles: bool, basins: bool) -> Portrait:
        """The portrait at `settings`, with what is asked for.

        Raises:
            SliceError: nothing moves, or too much.
        """
        every = tuple(sorted((self._defaults | dict(settings)).items()))
        if (every, cycles, basins) in self._made:
            return self._made[every, cycles, basins]
        axes = self.axes(settings)
        detail = Detail(
            plane=NODES,
            trajectories=0,
            cycles=cycles,
            separatrices=False,
            nullclines=False,
            rays=RAYS,
            compared=False,
            basins=CELLS.get(len(axes), 0) if basins else 0,
        )
        made = portrait(self.program, axes, dict(settings), detail)
        if basins:
            self._made[every, cycles, False] = replace(made, basins=None)
        if cycles:
            self._made[every, False, False] = replace(made, cycles=(), basins=None)
        self._made[every, cycles, basins] = made
        return made
