"""The page of a behavior: everything that whoever builds it has to know."""

from collections.abc import Iterator

from runtime.architecture import Architecture, Node
from runtime.program import Guard, Kind, Program, Role, State
from specc.book.chapters import (
    Block,
    Bullets,
    Chapter,
    Figure,
    Formulas,
    Heading,
    Paragraph,
    Section,
    Table,
)
from specc.book.contents import Drawn, Shown
from specc.book.formulas import in_mode, labels_of, of_tree, plain, written
from specc.book.naming import Names
from specc.book.tables import per_second
from specc.book.words.acting import acting_section
from specc.book.words.data import data_section
from specc.book.words.declared import constants_table, controls_table
from specc.book.words.faithful import faithful_section
from specc.book.words.quantities import NOTHING, SECOND, exact, listed, range_of, unit_of
from specc.book.words.source import author_words, conditions_of, formulas_of, spec_section
from specc.book.words.testing import procedure_section
from specc.book.words.topology import topology_blocks
from specc.book.words.wiring import source_of, value_of
from specc.figures.quantities import rate_of
from verifier.fidelity.stretches.needs import names_guarded, names_read

ROLES = {
    Role.SENSED: "sensed",
    Role.DRIVEN: "driven",
    Role.BOTH: "sensed and driven",
}


def behavior_chapter(of: Drawn, shown: Shown, names: Names) -> Chapter:
    """The page of a node that runs a behavior."""
    node, made = shown.node, of.architecture
    program = made.programs[node.behavior]
    called = "" if program.name == node.name else f" Its spec calls it `{program.name}`."
    sections = (
        _purpose(program, called),
        Section("State variables", tuple(_states(program, made, node, names))),
        Section("Control interface", tuple(_controls(program, made, node, names))),
        Section("The field", tuple(_field(program, node))),
        acting_section(of, node, names),
        faithful_section(program, shown.trial),
        procedure_section(program, shown.trial, names.procedure(made, node)),
        data_section(of, shown, names),
        _pictures(program, shown, made, names),
        spec_section(program.source),
    )
    return Chapter(
        names.stem(made, node),
        "base behavior" if node.level == 0 else f"behavior, level {node.level}",
        node.name,
        program.about,
        tuple(section for section in sections if section.blocks),
    )


def _purpose(program: Program, called: str) -> Section:
    blocks: list[Block] = [Paragraph(words) for words in author_words(program.source.text)]
    moved = [s for s in program.states if s.is_driven and s.name != program.field.mode]
    names = ", ".join(f"`{state.name}`" for state in moved)
    blocks.append(
        Paragraph(
            f"It is to move {names} as this page says, whatever sensors, motors and programs bring"
            f" that about.{called}"
        )
    )
    return Section("What it does", tuple(blocks))


def _states(program: Program, made: Architecture, node: Node, names: Names) -> Iterator[Block]:
    rows = tuple(
        (
            f"`{state.name}`",
            _relates(state),
            range_of(state),
            ROLES[state.role],
            source_of(made, node, state, names) if _is_read(state, node) else _kept(state, program),
        )
        for state in program.states
    )
    yield Table(("state", "relates", "range", "role", "comes from"), rows)
    told = [f"`{state.name}`: {state.about}." for state in program.states if state.about]
    told += _zeros(program)
    if told:
        yield Bullets(tuple(told))
    closures = tuple(
        (rate_of(state.name), written(state.closure, labels_of(program)), "assumed, not promised")
        for state in program.states
        if state.closure is not None
    )
    if closures:
        yield Paragraph(
            "What is only sensed is moved by the world. Where the behavior is looked at alone, its"
            " author assumes of it:"
        )
        yield Formulas(closures)


def _zeros(program: Program) -> list[str]:
    """What may be measured from anywhere."""
    read = names_read(program) | names_guarded(program)
    return [
        f"`{state.name}`: only its changes count, since no formula reads it. Measure it from any"
        " direction that stays the same."
        for state in program.states
        if state.kind is Kind.PERIODIC and state.name not in read
    ]


def _relates(state: State) -> str:
    agent, environment = state.relates
    return f"{agent} ↔ {environment}" if agent else NOTHING


def _is_read(state: State, node: Node) -> bool:
    return any(wire.entry == state.name for wire in node.inputs)


def _kept(state: State, program: Program) -> str:
    if state.name == program.field.mode:
        return "its own memory: the mode it is in"
    return "not read, only moved" if state.is_driven else f"held at {value_of(state, state.hold)}"


def _controls(program: Program, made: Architecture, node: Node, names: Names) -> Iterator[Block]:
    if program.controls:
        yield Paragraph("Control parameters are set from outside, each by itself.")
        yield controls_table(program.controls, made, node, names)
    if program.constants:
        yield Paragraph("Constants are part of the behavior; nobody sets them.")
        yield constants_table(program.constants)
    if program.outputs:
        labels = labels_of(program)
        yield Paragraph("Outputs are what others may read of it, or what it asks of the body.")
        yield Formulas(
            tuple(
                (o.name, written(o.code, labels), _remark(unit_of(o.unit), o.about))
                for o in program.outputs
            )
        )


def _remark(unit: str, about: str) -> str:
    told = [f"in {unit}"] if unit != NOTHING else []
    return "; ".join((*told, *([about] if about else [])))


def _field(program: Program, node: Node) -> Iterator[Block]:
    field = program.field
    if field.formula is None:
        yield Paragraph(
            f"The field is given as {FORMS.get(field.form, field.form)}: its numbers are in the"
            " tables of this book, and how it looks is in the portraits below."
        )
    elif field.mode:
        yield from _modes(program, node)
    else:
        yield Formulas(tuple(_rates(program)))
    if field.is_map:
        yield Paragraph(
            f"It moves in steps of {exact(field.every, SECOND)}: the formulas give each state one"
            " step later."
        )
    if program.noise:
        labels = labels_of(program)
        rows = tuple(
            (each.state, written(each.size, labels), "standard deviation that adds up in 1 s")
            for each in program.noise
        )
        yield Paragraph(
            "Chance is part of it: beside the field, white noise moves these states. What it adds"
            " up to grows with the square root of time."
        )
        yield Formulas(rows)
    if field.formula is not None:
        yield Paragraph(
            "In formulas every name stands for its value in SI (angles in radians), numbers too;"
            " `where(c, a, b)` is a where c holds, else b.",
            is_small=True,
        )


FORMS = {
    "arrows": "arrows that its author sketched, filled between by the compiler",
    "grid": "numbers on a grid",
    "module": "a program of its author's",
    "sketch": "features that its author drew, filled between by the compiler",
}


def _rates(program: Program, index: int = -1) -> Iterator[tuple[str, str, str]]:
    """A formula for each driven state, in one mode or in all; as their author wrote them."""
    field = program.field
    units = {state.name: state.unit.text for state in program.states}
    own = formulas_of(program, index)
    for name, code in zip(field.driven, field.formula or (), strict=False):
        left = f"{name} next" if field.is_map else rate_of(name)
        tree = in_mode(code, field.mode if index >= 0 else "", index)
        right = plain(own[name]) if name in own else of_tree(tree, labels_of(program))
        unit = units[name] if field.is_map else per_second(units[name])
        yield (left, right, f"in {unit}" if unit not in {"", "1"} else "")


def _modes(program: Program, node: Node) -> Iterator[Block]:
    field = program.field
    mode = next(s for s in program.states if s.name == field.mode)
    values = mode.values
    yield Paragraph(
        f"It has a memory: `{field.mode}` is the mode that it is in, one of"
        f" {', '.join(f'`{v}`' for v in values)}. Each mode has a field of its own, and is left"
        f" {_leaving(program, node)}. It begins in {value_of(mode, mode.hold)}, where nothing else"
        " is said."
    )
    for index, value in enumerate(values):
        yield Heading(f"While `{field.mode}` is `{value}`")
        yield Formulas(tuple(_rates(program, index)))
        ways = tuple(mode_ways(program, index, values))
        yield Bullets(ways or ("It is never left.",))


def _leaving(program: Program, node: Node) -> str:
    """When conditions are looked at: also between ticks where it is on states of its own."""
    moved = names_guarded(program) & set(program.field.driven) - {program.field.mode}
    own = sorted(name for name in moved if all(wire.entry != name for wire in node.inputs))
    told = "at the first tick at which one of its conditions holds of what was read then"
    if not own:
        return told
    return f"{told}; {listed(f'`{n}`' for n in own)}, its own, may make one hold between ticks, too"


def mode_ways(program: Program, index: int, values: tuple[str, ...]) -> Iterator[str]:
    """How a mode is left, a sentence for each way."""
    guards = [guard for guard in program.field.guards if guard.mode == index]
    own = conditions_of(program, values[index])
    for k, guard in enumerate(guards):
        when = plain(own[k]) if k < len(own) else f"{written(guard.condition)} ≥ 0"
        yield f"to `{values[guard.target]}` where `{when}`{_resets(program, guard)}"


def _resets(program: Program, guard: Guard) -> str:
    labels = labels_of(program)
    told = ", ".join(f"{name} := {written(code, labels)}" for name, code in guard.resets)
    return f"; then `{told}`" if told else ""


def _pictures(program: Program, shown: Shown, made: Architecture, names: Names) -> Section:
    """Its portraits, or what is told in their place."""
    title = "Phase portraits" if shown.portraits else "The field as a picture"
    return Section(title, tuple(_portraits(program, shown, made, names)))


def _portraits(program: Program, shown: Shown, made: Architecture, names: Names) -> Iterator[Block]:
    for k, view in enumerate(shown.portraits):
        yield Heading(view.title)
        caption = HOW_TO_READ if k == 0 else ""
        alt = f"phase portrait of {program.name}: {view.title}"
        yield Figure(names.portrait(made, shown.node, k), caption, alt, PORTRAIT)
        yield from topology_blocks(view.portrait)
    for k, plane in enumerate(shown.speeds, len(shown.portraits)):
        yield Heading(plane.title)
        caption = HOW_FAST if k == len(shown.portraits) else ""
        alt = f"{plane.title}, over what {program.name} senses"
        yield Figure(names.portrait(made, shown.node, k), caption, alt, PORTRAIT)


PORTRAIT = 0.8
"""Of the width of a page of the PDF."""
HOW_FAST = (
    "What it moves goes on alike wherever it is: what it senses alone decides how fast. Hatched:"
    " here the mode is left."
)
HOW_TO_READ = (
    "Lines follow the field, darker where it is faster; dots are fixed points (full: they attract),"
    " thick closed lines are cycles, tinted areas are basins of attraction. States that are not on"
    " the axes are held at the values written above."
)
