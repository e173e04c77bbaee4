"""What an arbiter needs of a log, put as a program whose states are all sensed, to be read."""

from dataclasses import replace
from typing import Final

from runtime.arbiter import Arbiter
from runtime.program import Binding, Field, Kind, Program, Role, State, Unit

CHOICE: Final = "choice"
"""What the chosen one is called in a log's bindings."""


def reader_of(arbiter: Arbiter) -> Program:
    """A program without a field: its states are what is read, and the choice."""
    read = tuple(
        State(
            name=one.name,
            unit=one.unit,
            low=one.low,
            high=one.high,
            role=Role.SENSED,
            kind=one.kind,
            hold=one.low,
            closure=None,
            values=one.values,
            relates=("", ""),
            about=one.about,
            origin=one.origin,
        )
        for one in arbiter.reads
    )
    return Program(
        name=arbiter.name,
        about=arbiter.about,
        states=(*read, _choice(arbiter)),
        controls=arbiter.controls,
        constants=arbiter.constants,
        outputs=(),
        field=Field((), "arbiter", 0.0, (), (), (), None, arbiter.source.file),
        fidelity=None,
        bindings=tuple(_by_name(each, arbiter) for each in arbiter.bindings),
        judge_when=arbiter.judge_when,
        realizes=(),
        feasibility=None,
        source=arbiter.source,
    )


def _choice(arbiter: Arbiter) -> State:
    bound = next((b.origin for b in arbiter.bindings if b.name == CHOICE), "")
    return State(
        name=CHOICE,
        unit=Unit("1", 1.0),
        low=0.0,
        high=float(len(arbiter.choices) - 1),
        role=Role.SENSED,
        kind=Kind.DISCRETE,
        hold=0.0,
        closure=None,
        values=arbiter.choices,
        relates=("", ""),
        about="what it chose",
        origin=bound or arbiter.source.file,
    )


def _by_name(binding: Binding, arbiter: Arbiter) -> Binding:
    """A choice that is bound without texts is logged by its own names."""
    if binding.name != CHOICE or binding.values:
        return binding
    return replace(binding, values=tuple((name, i) for i, name in enumerate(arbiter.choices)))
