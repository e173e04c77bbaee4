"""When a behavior acts, on what, and how fast: the sections on timing and on channels."""

from runtime.architecture import Architecture, Node, Way
from runtime.program import Program
from specc.book.chapters import Block, Bullets, Paragraph, Section, Table
from specc.book.contents import Drawn
from specc.book.formulas import labels_of, written
from specc.book.naming import Names
from specc.book.words.quantities import listed, milliseconds
from specc.book.words.wiring import governors, link

MODES = {
    "rate": "its rate is commanded: the channel moves the state",
    "set-point": "its value is commanded",
    "acceleration": "its rate is commanded as the rate of the channel",
}


def timing_sentences(node: Node) -> str:
    """When it reads, and when it acts upon that."""
    late = (
        f" and what it tells and does takes effect {milliseconds(node.response_time)} later"
        if node.response_time
        else ", and what it tells and does takes effect at once"
    )
    return f"It reads its inputs every {milliseconds(node.period)}{late}."


def acting_section(of: Drawn, node: Node, names: Names) -> Section:
    """When it acts, on which channels, and who else does."""
    made = of.architecture
    program = made.programs[node.behavior]
    blocks: list[Block] = [Paragraph(timing_sentences(node)), Bullets(_when(made, node, names))]
    rows = tuple(_command(made, node, place, names) for place in range(len(node.commands)))
    if rows:
        titles = ("channel", "gets", "as", "where several act")
        blocks.append(Table(titles, rows))
    else:
        blocks.append(Paragraph("It acts on no channel: it only tells others what it works out."))
    readers = tuple(_readers(made, node, program, names))
    if readers:
        blocks.append(Table(("output", "read by"), readers))
    return Section("Acting and timing", tuple(blocks))


def _when(made: Architecture, node: Node, names: Names) -> tuple[str, ...]:
    told = [
        f"It acts while {link(made, other, names)} chooses `{choice}`."
        for other, choice in governors(made, node)
    ]
    if node.acts_when is not None:
        labels = labels_of(made.programs[node.behavior])
        told.append(f"It acts only where `{written(node.acts_when, labels)}`.")
    if node.replaces:
        parts = " and ".join(link(made, made.nodes[place], names) for place in node.replaces)
        told.append(f"Where {parts} would act at once, it acts in their place.")
    if not told and node.commands:
        told.append("It always acts: nobody inhibits it.")
    if len(governors(made, node)) > 0:
        told.append(
            "While it does not act it commands nothing. It goes on reading and telling, and its"
            " memory goes on."
        )
    return tuple(told)


def _command(made: Architecture, node: Node, place: int, names: Names) -> tuple[str, ...]:
    command = node.commands[place]
    channel = made.channels[command.channel]
    sign = "−" if command.sign < 0.0 else ""
    others = [n for n in channel.resolution.nodes if made.nodes[n] is not node]
    way = channel.resolution.way
    told = "nobody else acts on it"
    if others:
        who = listed(link(made, made.nodes[n], names) for n in others)
        told = f"{WAYS[way]}: {who}"
    how = f"{command.mode}: {MODES.get(command.mode, 'commanded')}"
    return (f"`{channel.name}`", f"`{sign}{command.entry}`", how, told)


WAYS = {
    Way.SINGLE: "nobody else",
    Way.EXCLUSIVE: "never at once with",
    Way.SUM: "added to",
    Way.BLEND: "blended with",
    Way.PRIORITY: "by priority with",
    Way.FUNCTION: "mixed by a function with",
}


def _readers(
    made: Architecture, node: Node, program: Program, names: Names
) -> list[tuple[str, str]]:
    found = []
    for output in program.outputs:
        signal = f"{node.name}.{output.name}"
        who = [
            f"{link(made, other, names)} as `{wire.entry}`"
            for other in made.nodes
            for wire in other.inputs
            if wire.signal >= 0 and made.board[wire.signal].name == signal
        ]
        if who:
            found.append((f"`{output.name}`", listed(who)))
    return found
