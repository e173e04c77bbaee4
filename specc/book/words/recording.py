"""The section that says how a recording is written, with the first lines of one of this book."""

from collections.abc import Iterator
from typing import Final

import numpy as np

from runtime.arbiter import Arbiter
from runtime.architecture import Architecture, Node
from runtime.arrays import Array
from runtime.flow import flow_of, next_states, rates
from runtime.program import Control, Kind, Program, State
from specc.book.chapters import Block, Bullets, Listing, Paragraph, Section, Table
from specc.book.contents import Contents
from specc.book.naming import Names
from specc.book.words.wiring import link
from verifier.arbitration.reader import CHOICE

TITLE: Final = "How a recording is written"
ROWS: Final = 4
RATE: Final = 20.0
"""Rows a second of the example."""
OFF: Final = 0.6
"""The example begins at this share of the range of each driven state."""


def recording_section(contents: Contents, names: Names) -> Section:
    """Formats, columns, units, modes, and how runs are parted."""
    return Section(TITLE, tuple(_blocks(contents, names)))


def _blocks(contents: Contents, names: Names) -> Iterator[Block]:
    yield Paragraph(
        "A recording is a log of one module: a CSV file, an MCAP file (messages of ROS 2 or ROS 1,"
        " JSON or protobuf), a ROS 1 bag, a ROS 2 bag (folder or `.db3`), or a ULog file."
        " A CSV is the least trouble. Several recordings of a module count together."
    )
    yield Table(
        ("module", "file, such as", "columns of a CSV, in any order"),
        tuple(
            (link(of.architecture, node, names), f"`{node.name}_1.csv`", ", ".join(columns))
            for of in contents.architectures
            for node in of.architecture.nodes
            if (columns := _columns(of.architecture, node))
        ),
    )
    example = _example(contents)
    if example is not None:
        program, text = example
        yield Paragraph(
            f"The first lines of a recording of {program.name}, of a robot that does what the field"
            f" says, at {RATE:g} Hz:"
        )
        yield Listing(text, "csv")
    yield Bullets(tuple(_rules()))
    yield Paragraph(
        "In an MCAP file the same stands in JSON messages (message encoding `json`) on the topics"
        " `/SPEC/state` and `/SPEC/control`, SPEC being the name of the module's spec: an object"
        ' with a value for each variable, such as {"heading": 0.31, "side": "to_left"}; of an'
        " arbiter what it reads and its `choice` on `/SPEC/state`. The log time of a message is the"
        " time of its values. `specc simulate SPEC.yaml -o run.mcap` writes such a file."
    )
    yield Paragraph(
        "Logs under other names, in other units or of other topics need no conversion: copy the"
        " module's spec out of this book and say in it where things stand, under `trace:`. Then"
        " name the copy with `--spec`, or write a file `specc.yaml` into the folder in which you"
        " call specc:"
    )
    yield Listing(_trace_text(example[0] if example else None), "yaml")
    yield Listing(
        "specc: 1\nkind: project\nname: mine\nspecs: [SPEC.yaml]\n"
        'traces:\n  "runs/*.csv": SPEC.yaml   # for each pattern its spec; the first that fits',
        "yaml",
    )


def _columns(made: Architecture, node: Node) -> tuple[str, ...]:
    """What is logged of a node; nothing of what promises nothing."""
    if node.behavior >= 0:
        program = made.programs[node.behavior]
        return tuple(f"`{name}`" for name in _names(program))
    if node.arbiter >= 0:
        return tuple(f"`{name}`" for name in _read(made.arbiters[node.arbiter]))
    return ()


def _names(program: Program) -> tuple[str, ...]:
    """The time, states and controls."""
    return ("time", *(s.name for s in program.states), *(c.name for c in program.controls))


def _read(arbiter: Arbiter) -> tuple[str, ...]:
    """The time, what it reads, and its choice."""
    return ("time", *(read.name for read in arbiter.reads), CHOICE)


def _rules() -> Iterator[str]:
    yield (
        "Names: the first line names the columns, by the names on the module's page and without"
        " units. Other columns may stand there too. Cells are parted by `,`, `;` or tabs."
    )
    yield (
        "Which module it is of is seen from the columns. Where several modules would do, the file's"
        " name decides, if the module's name is a word of it, as in `NAME_1.csv`."
    )
    yield (
        "Time: a column `time` (or `t`, `timestamp`, `stamp`), in seconds from whenever you like."
        " Times in another unit need a name that says so: `time_ms`, `time_us`, `time_ns`."
    )
    yield "Units: those that stand on the module's page beside each variable."
    yield (
        "Angles that go round may stay within their range or count turns on. Modes and other"
        " discrete variables are the names of their values, as they stand on the page, or their"
        " numbers from 0. A mode stands in each row, as it is at that time."
    )
    yield (
        "Controls have a column even where they were never changed: what the field reads and nobody"
        " logged is not known, and leaves the verdict open. Controls of an arbiter may be left out;"
        " they then have their defaults."
    )
    yield (
        "Log what the module itself was given and decided by, at the time at which it was so;"
        " of an arbiter a row for each tick."
    )
    yield (
        "Acting or inhibited: a log of one module is judged as a whole, so record while it acts and"
        " leave out the rows in which it is inhibited. Or keep them, log a further column, such as"
        " `acting` with 1 and 0, and write `trace: {acting: acting}` and `judge_when: acting` in a"
        " copy of the spec."
    )
    yield (
        "Several runs in one file need a gap in time between them: more than half a second, and"
        " more than five times the usual distance of rows; one second does for 10 Hz and more."
        " Without it the way from the end of one run to the start of the next counts as motion."
        " A file for each run is as good."
    )


def _trace_text(program: Program | None) -> str:
    """Entries of a spec's `trace:`, of the first of the variables."""
    measured = [s for s in (program.states if program else ()) if s.unit.text not in {"", "1"}]
    name, unit = (measured[0].name, measured[0].unit.text) if measured else ("NAME", "UNIT")
    written = "deg" if unit == "rad" else unit
    return (
        f"trace:\n  {name}: {{path: COLUMN, unit: {written}}}  # a column of a CSV, and its unit\n"
        f"  # {name}: /TOPIC.FIELD  # or a field of a topic\n"
        "  # ANOTHER: {constant: 0.5}  # what was not logged and did not change"
    )


def _example(contents: Contents) -> tuple[Program, str] | None:
    """The first rows of a recording of one behavior, with a mode if there is such a one."""
    programs = [
        of.architecture.programs[node.behavior]
        for of in contents.architectures
        for node in of.architecture.nodes
        if node.behavior >= 0
    ]
    if not programs:
        return None
    program = next((each for each in programs if each.field.mode), programs[0])
    rows = [",".join(_names(program))]
    for place, state in enumerate(_course(program)):
        cells = [_cell(part, value) for part, value in zip(program.states, state, strict=True)]
        cells += [_cell(part, part.default) for part in program.controls]
        rows.append(",".join((f"{place / RATE:.3f}", *cells)))
    return program, "\n".join(rows)


def _course(program: Program) -> Iterator[Array]:
    """States (n,) of a few rows: driven ones by the field, the others at their usual value."""
    state = np.array([_start(each) for each in program.states])
    controls = np.array([each.default for each in program.controls])
    flow = flow_of(program)
    for _ in range(ROWS):
        yield state
        if flow.is_map:
            moved = next_states(flow, state, controls)
        else:
            moved = state + rates(flow, state, controls) / RATE
        is_own = np.array([each.is_driven for each in program.states]) & np.isfinite(moved)
        state = np.where(is_own, moved, state)


def _start(state: State) -> float:
    if not state.is_driven or state.kind is Kind.DISCRETE:
        return state.hold
    return state.low + OFF * (state.high - state.low)


def _cell(part: State | Control, value: float) -> str:
    if isinstance(part, State) and part.values:
        return part.values[round(value)]
    return f"{value / part.unit.scale:.6g}"
