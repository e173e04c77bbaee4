"""The page of an architecture: how its modules are wired, and to what body."""

from collections.abc import Iterator

from runtime.architecture import Architecture, Channel, Signal, Way
from runtime.program import Kind, Unit
from runtime.world.model import Body, DriveKind, Pose, Sensor, SensorKind
from specc.book.chapters import Block, Bullets, Chapter, Figure, Paragraph, Section, Table
from specc.book.contents import Drawn
from specc.book.naming import Names
from specc.book.words.quantities import NOTHING, exact, listed, milliseconds, span
from specc.book.words.source import author_words, spec_section
from specc.book.words.wiring import governors, link
from specc.figures.quantities import number

METRE, DEGREE = Unit("m", 1.0), Unit("deg", 0.017453292519943295)
KINDS = {
    SensorKind.BUMP: "whether something is touched",
    SensorKind.RANGE: "distance to the nearest thing in its view",
    SensorKind.LIGHT: "illuminance",
    SensorKind.SIGHT: "whether and where something is seen",
    SensorKind.ODOMETRY: "dead reckoning by its wheels",
    SensorKind.GYRO: "turn rate",
    SensorKind.POSE: "where it is, without error",
}
RESOLVED = {
    Way.SINGLE: "one behavior alone acts on it",
    Way.EXCLUSIVE: "they never act at once",
    Way.SUM: "what they want is added",
    Way.BLEND: "what they want is weighed",
    Way.PRIORITY: "the first of them that acts has its way",
    Way.FUNCTION: "a function of its author's mixes what they want",
}
RESTS = {"stop": "0", "hold": "what it was last", "coast": "nothing: it coasts"}


def overview_chapter(of: Drawn, names: Names) -> Chapter:
    """The architecture as a whole."""
    made, body = of.architecture, of.body
    words = author_words(made.source.text)
    sections = (
        Section("What it is for", tuple(map(Paragraph, words))),
        Section("How it is wired", tuple(_wiring(made, names))),
        Section("Levels and timing", tuple(_levels(made, names))),
        Section("Channels and conflicts", tuple(_channels(of, names))),
        Section("Signals", tuple(_signals(made, names))),
        Section("The body", tuple(_body(body))),
        Section("Sensors", tuple(_sensors(body, made))),
        spec_section(made.source, "The spec of the architecture"),
        spec_section(body.source, "The spec of the body"),
    )
    return Chapter(
        names.overview(made),
        "architecture",
        f"Architecture {made.name}",
        made.about,
        tuple(section for section in sections if section.blocks),
    )


def _wiring(made: Architecture, names: Names) -> Iterator[Block]:
    alt = f"wiring of {made.name}: {', '.join(node.name for node in made.nodes)}"
    caption = (
        "Sensors at the left; the body's channels below, the base behaviors above them, control"
        " modules on the levels above. A box has its inputs and its commands at its lower edge, its"
        " control interface and its outputs at the upper one. A line with an arrow carries a"
        " signal; a choice lets act, or sets, what it points to. The same as tables stands below."
    )
    yield Figure(names.wiring(made), caption, alt, is_wide=True)


def _levels(made: Architecture, names: Names) -> Iterator[Block]:
    rows = tuple(
        (
            link(made, node, names),
            str(node.level),
            _what(made, node.behavior, node.arbiter, node.module),
            milliseconds(node.period),
            milliseconds(node.response_time),
            listed(dict.fromkeys(link(made, o, names) for o, _ in governors(made, node))),
        )
        for node in sorted(made.nodes, key=lambda node: -node.level)
    )
    titles = ("module", "level", "runs", "period", "response time", "acts by leave of")
    yield Table(titles, rows, (1, 3, 4))
    yield Paragraph(
        "All modules run in parallel. At every multiple of its period a module reads its inputs;"
        " what it tells and does takes effect its response time later, and holds until the next"
        " takes effect. A module on the robot may be faster inside: these two are what others see"
        " of it, and what its recording is held against."
    )


def _what(made: Architecture, behavior: int, arbiter: int, module: str) -> str:
    if behavior >= 0:
        return f"behavior `{made.programs[behavior].name}`"
    if arbiter >= 0:
        one = made.arbiters[arbiter]
        return f"arbiter `{one.name}`, by {one.learner or one.paradigm.value}"
    return f"module `{module}`"


def _channels(of: Drawn, names: Names) -> Iterator[Block]:
    made = of.architecture
    yield Table(
        ("channel", "range", "where nobody acts", "who acts on it", "conflicts"),
        tuple(_channel(made, channel, names) for channel in made.channels),
    )
    proofs = [
        f"`{channel.name}`: proved, because {channel.resolution.proof}."
        for channel in made.channels
        if channel.resolution.proof
    ]
    if proofs:
        yield Paragraph(
            "That no two of them act at once was proved from the modules' specs, for every state"
            " and every reading:"
        )
        yield Bullets(tuple(proofs))
    if of.notes:
        yield Bullets(tuple(f"{note}." for note in of.notes))


def _channel(made: Architecture, channel: Channel, names: Names) -> tuple[str, ...]:
    resolution = channel.resolution
    nodes = [made.nodes[place] for place in resolution.nodes]
    who = listed((link(made, node, names) for node in nodes), "nobody")
    how = RESOLVED[resolution.way] if nodes else NOTHING
    if resolution.way is Way.PRIORITY:
        how += ", in the order given"
    if resolution.arbiter >= 0:
        how += f", by {link(made, made.nodes[resolution.arbiter], names)}"
    if resolution.function:
        how += f": `{resolution.function}`"
    ends = span(channel.low, channel.high, channel.unit)
    return (f"`{channel.name}`", ends, RESTS.get(channel.rest, channel.rest), who, how)


def _signals(made: Architecture, names: Names) -> Iterator[Block]:
    rows = []
    for place, signal in enumerate(made.board):
        readers = [
            f"{link(made, node, names)} as `{wire.entry}`"
            for node in made.nodes
            for wire in node.inputs
            if wire.signal == place
        ]
        if readers:
            rows.append((f"`{signal.name}`", _range(signal), listed(readers)))
    choices = {place for node in made.nodes if node.choices for place in node.outputs}
    unread = [
        signal.name
        for k, signal in enumerate(made.board)
        if k not in choices and not _is_read(made, k)
    ]
    yield Table(("signal", "range", "read by"), tuple(rows))
    if unread:
        told = listed(f"`{name}`" for name in unread)
        yield Paragraph(f"Nobody reads {told}.", is_small=True)


def _is_read(made: Architecture, place: int) -> bool:
    return any(wire.signal == place for node in made.nodes for wire in node.inputs)


def _range(signal: Signal) -> str:
    if signal.values:
        return listed(f"`{value}`" for value in signal.values)
    text = span(signal.low, signal.high, signal.unit)
    return f"{text}, periodic" if signal.kind is Kind.PERIODIC else text


def _body(body: Body) -> Iterator[Block]:
    drive = body.drive
    is_holonomic = drive.kind is DriveKind.HOLONOMIC
    how = "in any direction" if is_holonomic else f"two wheels {exact(drive.track, METRE)} apart"
    yield from map(Paragraph, author_words(body.source.text))
    rows = (
        ("what it is", body.about or body.name),
        ("reaches up", span(body.low, body.high, METRE)),
        ("mass", f"{number(body.mass, 6)} kg"),
        ("friction of its sides", number(body.friction, 6)),
        ("drive", how),
        ("fastest", f"{number(drive.speed, 6)} m/s, turning {number(drive.turn, 6)} rad/s"),
        (
            "fastest change of that",
            f"{number(drive.acceleration, 6)} m/s², {number(drive.spin, 6)} rad/s²",
        ),
    )
    yield Paragraph(
        "The behaviors were tried with the body below. Nothing in their specs asks for it: another"
        " one serves that senses what they read and can do what they ask of its channels."
    )
    yield Table(("of the body", ""), rows)


def _sensors(body: Body, made: Architecture) -> Iterator[Block]:
    rows = []
    for sensor in body.sensors:
        for reading in sensor.readings:
            signal = f"{sensor.name}.{reading.name}"
            place = next(k for k, one in enumerate(made.board) if one.name == signal)
            if not _is_read(made, place):
                continue
            unit = reading.unit
            rows.append(
                (
                    f"`{signal}`",
                    _looks(sensor),
                    span(reading.low, reading.high, unit),
                    exact(reading.noise, unit) if reading.noise else "none",
                    exact(reading.step, unit) if reading.step else NOTHING,
                    milliseconds(sensor.every),
                    milliseconds(sensor.latency),
                )
            )
    titles = ("reading", "what it is", "range", "noise (σ)", "resolution", "every", "late by")
    yield Paragraph(
        "What the modules read of the world, as it was simulated. A sensor of the robot's that"
        " tells less exactly or later makes behaviors less faithful; one that tells more does no"
        " harm."
    )
    yield Table(titles, tuple(rows))


def _looks(sensor: Sensor) -> str:
    pose = sensor.pose
    told = [KINDS[sensor.kind]]
    if sensor.of:
        told.append(f"of {listed(f'`{name}`' for name in sensor.of)}")
    if sensor.kind in {SensorKind.RANGE, SensorKind.SIGHT, SensorKind.BUMP} and sensor.width:
        told.append(f"{exact(sensor.width, DEGREE)} wide")
        told.append(_towards(pose.heading))
    told.append(_from(pose))
    return ", ".join(filter(None, told))


def _towards(heading: float) -> str:
    """Where it looks, empty for straight ahead."""
    if heading == 0.0:
        return ""
    side = "left" if heading > 0.0 else "right"
    return f"turned {exact(abs(heading), DEGREE)} to the {side}"


def _from(pose: Pose) -> str:
    """Where it sits, empty for the middle of the base."""
    ahead = f"{exact(abs(pose.x), METRE)} {'ahead of' if pose.x > 0.0 else 'behind'} the middle"
    beside = f"{exact(abs(pose.y), METRE)} to the {'left' if pose.y > 0.0 else 'right'}"
    told = [ahead] * (pose.x != 0.0) + [beside] * (pose.y != 0.0)
    return f"sitting {' and '.join(told)}" if told else ""
