"""The manifest of a book, from its contents."""

from runtime.arbiter import Read
from runtime.architecture import Architecture, Channel, Node
from runtime.program import Control, Output, Program, State
from specc.book.contents import Drawn, Shown
from specc.book.gridded import PROBES
from specc.book.manifest import (
    Action,
    ArchitectureEntry,
    ChannelEntry,
    Choice,
    Faithful,
    Module,
    Quantity,
    Tabulated,
    Wire,
)
from specc.book.naming import Names
from specc.book.tables import Sheet


def architecture_entry(of: Drawn, names: Names) -> ArchitectureEntry:
    """An architecture with all its modules and channels."""
    made = of.architecture
    return ArchitectureEntry(
        name=made.name,
        about=made.about,
        spec=made.source.file,
        body=of.body.source.file,
        robots=of.robots,
        modules=tuple(_module(made, shown, names) for shown in of.nodes),
        channels=tuple(_channel(made, each) for each in made.channels),
    )


def _module(made: Architecture, shown: Shown, names: Names) -> Module:
    node = shown.node
    program = made.programs[node.behavior] if node.behavior >= 0 else None
    arbiter = made.arbiters[node.arbiter] if node.arbiter >= 0 else None
    spec = program or arbiter
    agreement = arbiter.agreement if arbiter is not None else None
    feasible = program.feasibility if program is not None else None
    return Module(
        node=node.name,
        kind="behavior" if program else "arbiter" if arbiter else "module",
        name=spec.name if spec else node.module,
        about=spec.about if spec else "",
        spec=spec.source.file if spec else "",
        page=names.page(made, node),
        level=node.level,
        period=node.period,
        response_time=node.response_time,
        states=tuple(map(_state, program.states if program else ())),
        reads=tuple(map(_read, arbiter.reads if arbiter else ())),
        controls=tuple(map(_control, spec.controls if spec else ())),
        outputs=tuple(map(_output, spec.outputs if spec else ())),
        wires=tuple(_wires(made, node)),
        actions=tuple(
            Action(made.channels[c.channel].name, c.entry, c.mode, c.sign) for c in node.commands
        ),
        choices=tuple(_choices(made, node)),
        settings=shown.settings,
        tables=tuple(map(_table, shown.sheets)),
        data=_data(made, shown, names),
        figures=names.figures(made, shown),
        faithful=_faithful(program),
        agreement=agreement.share if agreement is not None else None,
        feasibility=feasible.level if feasible else "",
        evidence=feasible.evidence if feasible else "",
        trial=shown.trial,
    )


def _data(made: Architecture, shown: Shown, names: Names) -> tuple[str, ...]:
    """Its tables, and the runs of its test procedure."""
    tables = names.data(made, shown.node) if shown.sheets else ()
    procedure = shown.trial.procedure
    has_runs = procedure is not None and bool(procedure.drives)
    return (*tables, names.procedure(made, shown.node)) if has_runs else tables


def _state(state: State) -> Quantity:
    return Quantity(
        name=state.name,
        kind=str(state.kind),
        role=str(state.role),
        unit=state.unit.text,
        scale=state.unit.scale,
        low=state.low,
        high=state.high,
        default=state.hold,
        values=state.values,
        agent=state.relates[0],
        environment=state.relates[1],
        about=state.about,
    )


def _read(read: Read) -> Quantity:
    return Quantity(
        name=read.name,
        kind=str(read.kind),
        role="",
        unit=read.unit.text,
        scale=read.unit.scale,
        low=read.low,
        high=read.high,
        default=0.0,
        values=read.values,
        agent="",
        environment="",
        about=read.about,
    )


def _control(control: Control) -> Quantity:
    return _number(control, control.low, control.high, control.default)


def _output(output: Output) -> Quantity:
    return _number(output, 0.0, 0.0, 0.0)


def _number(part: Control | Output, low: float, high: float, default: float) -> Quantity:
    return Quantity(
        name=part.name,
        kind="continuous",
        role="",
        unit=part.unit.text,
        scale=part.unit.scale,
        low=low,
        high=high,
        default=default,
        values=(),
        agent="",
        environment="",
        about=part.about,
    )


def _wires(made: Architecture, node: Node) -> list[Wire]:
    return [
        Wire(
            one.entry,
            made.board[one.signal].name if one.signal >= 0 else "",
            one.value if one.signal < 0 else 0.0,
            one.scale,
            str(one.outside) if one.signal >= 0 else "",
        )
        for one in node.inputs
    ]


def _choices(made: Architecture, node: Node) -> list[Choice]:
    return [
        Choice(
            choice.name,
            tuple(made.nodes[place].name for place in choice.acts),
            {f"{made.nodes[one.node].name}.{one.entry}": one.value for one in choice.sets},
        )
        for choice in node.choices
    ]


def _table(sheet: Sheet) -> Tabulated:
    return Tabulated(
        quantity=sheet.quantity,
        setting=sheet.setting,
        unit=sheet.unit,
        axes=sheet.axes,
        counts=tuple(len(nodes) for nodes in sheet.grid.nodes),
        error=sheet.grid.error,
        size=sheet.grid.size,
        points=PROBES,
    )


def _faithful(program: Program | None) -> Faithful | None:
    if program is None or program.fidelity is None:
        return None
    of = program.fidelity
    return Faithful(of.tolerance, of.scatter, of.horizon, of.region, of.coverage)


def _channel(made: Architecture, channel: Channel) -> ChannelEntry:
    resolution = channel.resolution
    return ChannelEntry(
        name=channel.name,
        unit=channel.unit.text,
        scale=channel.unit.scale,
        low=channel.low,
        high=channel.high,
        rest=channel.rest,
        way=resolution.way.value,
        nodes=tuple(made.nodes[place].name for place in resolution.nodes),
        proof=resolution.proof,
    )
