"""The pages of control modules: arbiters, and modules that are programs of their author's."""

from collections.abc import Iterator

from runtime.arbiter import Arbiter, Paradigm
from runtime.architecture import Architecture, Node
from runtime.program import Program
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
from specc.book.formulas import labels_of, plain, written
from specc.book.naming import Names
from specc.book.words.acting import timing_sentences
from specc.book.words.behavior import HOW_TO_READ, PORTRAIT, mode_ways
from specc.book.words.declared import constants_table, controls_table
from specc.book.words.quantities import NOTHING, exact, listed, milliseconds, range_of
from specc.book.words.source import author_words, spec_section
from specc.book.words.testing import bench_section
from specc.book.words.topology import topology_blocks
from specc.book.words.wiring import governors, link, source_of
from specc.figures.quantities import percent
from specc.texts.arbiter_portraits import ruling_phrase
from specc.texts.arbiters import rule_sentences, way_of
from verifier.arbitration.judging import AGREED
from verifier.report.wording import percents


def arbiter_chapter(of: Drawn, shown: Shown, names: Names) -> Chapter:
    """The page of a node that decides."""
    node, made = shown.node, of.architecture
    arbiter = made.arbiters[node.arbiter]
    sections = (
        _purpose(arbiter, node),
        Section("What it reads", tuple(_reads(arbiter, made, node, names))),
        Section("How it decides", tuple(_decides(arbiter, shown, made, names))),
        Section("What each choice does", tuple(_choices(made, node, names))),
        _when(made, node, names),
        _faithful(arbiter),
        bench_section(shown.trial),
        spec_section(arbiter.source),
        *([spec_section(arbiter.plan.source, "The spec of its plan")] if arbiter.plan else []),
    )
    return Chapter(
        names.stem(made, node),
        f"control module, level {node.level}",
        node.name,
        arbiter.about,
        tuple(section for section in sections if section.blocks),
    )


def module_chapter(of: Drawn, shown: Shown, names: Names) -> Chapter:
    """The page of a module that is a program of its author's."""
    node, made = shown.node, of.architecture
    rows = tuple(
        (f"`{w.entry}`", made.board[w.signal].name if w.signal >= 0 else f"{w.value:g}")
        for w in node.inputs
    )
    told = ", ".join(f"`{made.board[place].name}`" for place in node.outputs)
    blocks = (
        Paragraph(
            f"This module is Python of its author's, `{node.module}`; what it works out is stated"
            f" nowhere else. {timing_sentences(node)}"
        ),
        Table(("it reads", "from"), rows),
        Paragraph(f"It tells {told or 'nothing'}."),
    )
    return Chapter(
        names.stem(made, node),
        f"module, level {node.level}",
        node.name,
        "",
        (Section("What it does", blocks),),
    )


def _purpose(arbiter: Arbiter, node: Node) -> Section:
    called = "" if arbiter.name == node.name else f" Its spec calls it `{arbiter.name}`."
    choices = listed(f"`{choice}`" for choice in arbiter.choices)
    told = f"It decides between {choices}.{called} {timing_sentences(node)}"
    words = (*author_words(arbiter.source.text), told)
    return Section("What it is for", tuple(map(Paragraph, words)))


def _reads(arbiter: Arbiter, made: Architecture, node: Node, names: Names) -> Iterator[Block]:
    rows = tuple(
        (f"`{r.name}`", range_of(r), source_of(made, node, r, names), r.about or NOTHING)
        for r in arbiter.reads
    )
    yield Table(("reads", "range", "comes from", "what it is"), rows)
    if arbiter.controls:
        yield Paragraph("Its control parameters are set from outside, each by itself.")
        yield controls_table(arbiter.controls, made, node, names)
    if arbiter.constants:
        yield constants_table(arbiter.constants)
    if arbiter.outputs:
        labels = labels_of(arbiter)
        yield Paragraph("What it tells beside its choice:")
        yield Formulas(tuple((o.name, written(o.code, labels), o.about) for o in arbiter.outputs))


def _decides(arbiter: Arbiter, shown: Shown, made: Architecture, names: Names) -> Iterator[Block]:
    yield Paragraph(f"It decides {plain(way_of(arbiter))}.")
    rules = rule_sentences(arbiter)
    if rules:
        rows = tuple((str(r.number), f"`{r.choice}`", _sentence(r.sentence)) for r in rules)
        yield Table(("", "choice", "holds"), rows)
        if arbiter.controls:
            yield Paragraph(
                "In brackets stand the values at the defaults of its controls.", is_small=True
            )
        if any(rule.until is not None for rule in arbiter.rules):
            yield Paragraph(
                "A rule that has begun to hold goes on until its end is met, even where its own"
                " condition holds no longer.",
                is_small=True,
            )
    yield from _decisions(arbiter, shown, made, names)
    labels = labels_of(arbiter)
    if arbiter.weights:
        pairs = zip(arbiter.choices, arbiter.weights, strict=True)
        yield Formulas(tuple((f"weight of {n}", written(c, labels), "") for n, c in pairs))
    if arbiter.competition is not None:
        yield from _competition(arbiter)
    if arbiter.plan is not None:
        yield from _plan(arbiter.plan, shown, made, names)
    if arbiter.paradigm is Paradigm.MODULE:
        yield Paragraph(f"`{arbiter.module}` is Python of its author's: see the folder `specs/`.")


def _decisions(arbiter: Arbiter, shown: Shown, made: Architecture, names: Names) -> Iterator[Block]:
    """What it decides over the two readings that matter most, at each setting of its controls."""
    for k, each in enumerate(shown.decisions):
        plane = each.portrait.plane
        over = " and ".join(f"`{axis.name}`" for axis in plane.axes)
        yield Heading(f"Over {over}" + (f", where {each.title}" if each.title else ""))
        alt = f"what {arbiter.name} decides over {over}"
        yield Figure(names.portrait(made, shown.node, k), "", alt, PORTRAIT)
        shares = percents([plane.share_of(place) for place in range(len(plane.rulings))])
        told = [ruling_phrase(arbiter, ruling) for ruling in plane.rulings]
        rows = tuple(zip(told, shares, strict=True))
        yield Table(("decides", "share of what is shown"), rows, (1,))


def _sentence(text: str) -> str:
    """The sentence without the choice that stands before it."""
    rest = text.partition(", ")[2]
    return plain(rest) if rest else plain(text)


def _competition(arbiter: Arbiter) -> Iterator[Block]:
    of, labels = arbiter.competition, labels_of(arbiter)
    if of is None:
        return
    yield Paragraph(
        "Each choice i has an activation uᵢ that grows by its own advantage aᵢ and is suppressed by"
        " the others, by gⱼᵢ; the choices hold as strongly as |uᵢ| (Large, Christensen and Bajcsy"
        " 1999, equation 4):"
    )
    yield Formulas((("τ·duᵢ/dt", "aᵢ·uᵢ − |aᵢ|·uᵢ³ − Σⱼ≠ᵢ gⱼᵢ·uⱼ²·uᵢ + noise", ""),))
    yield Bullets(
        (
            f"τ is {milliseconds(of.time)}.",
            f"The noise of u has the standard deviation {of.noise:g} per square root of a second.",
        )
    )
    pairs = zip(arbiter.choices, of.advantage, strict=True)
    yield Formulas(tuple((f"a of {n}", written(c, labels), "") for n, c in pairs))
    yield Formulas(
        tuple(
            (f"g of {arbiter.choices[j]} on {arbiter.choices[i]}", written(code, labels), "")
            for j, row in enumerate(of.suppression)
            for i, code in enumerate(row)
            if i != j
        )
    )


def _plan(plan: Program, shown: Shown, made: Architecture, names: Names) -> Iterator[Block]:
    """A plan is a behavior of its own, whose modes are the choices."""
    values = next(s.values for s in plan.states if s.name == plan.field.mode)
    if plan.about:
        yield Paragraph(f"The plan: {plan.about}")
    if plan.controls:
        rows = tuple(
            (f"`{c.name}`", range_of(c), exact(c.default, c.unit), c.about or NOTHING)
            for c in plan.controls
        )
        yield Table(("the plan's control", "range", "held at", "what it does"), rows)
    if plan.constants:
        constants = tuple(
            (f"`{c.name}`", exact(c.value, c.unit), c.about or NOTHING) for c in plan.constants
        )
        yield Table(("the plan's constant", "value", "what it is"), constants)
    for index, value in enumerate(values):
        yield Heading(f"While the choice is `{value}`")
        yield Bullets(tuple(mode_ways(plan, index, values)) or ("It is never left.",))
    if shown.portraits:
        yield Heading("Its phase space")
    for k, view in enumerate(shown.portraits):
        yield Paragraph(f"Where {view.title}:")
        caption = HOW_TO_READ if k == 0 else ""
        alt = f"phase portrait of {plan.name}: {view.title}"
        yield Figure(names.portrait(made, shown.node, k), caption, alt, PORTRAIT)
        yield from topology_blocks(view.portrait)


def _choices(made: Architecture, node: Node, names: Names) -> Iterator[Block]:
    rows = []
    for choice in node.choices:
        acts = listed(link(made, made.nodes[place], names) for place in choice.acts)
        sets = listed(_setting(made, one.node, one.entry, one.value) for one in choice.sets)
        rows.append((f"`{choice.name}`", acts, sets))
    yield Table(("choice", "lets act", "and sets, while it holds"), tuple(rows))
    yield Paragraph(
        "Whom no choice that holds lets act is inhibited: it commands nothing.", is_small=True
    )


def _setting(made: Architecture, place: int, entry: str, value: float) -> str:
    node = made.nodes[place]
    spec = made.programs[node.behavior] if node.behavior >= 0 else made.arbiters[node.arbiter]
    control = next((c for c in spec.controls if c.name == entry), None)
    text = exact(value, control.unit) if control is not None else f"{value:g}"
    return f"`{node.name}.{entry}` to {text}"


def _when(made: Architecture, node: Node, names: Names) -> Section:
    told = tuple(
        f"Its choices count while {link(made, other, names)} chooses `{choice}`."
        for other, choice in governors(made, node)
    )
    kept = [
        channel.name
        for channel in made.channels
        if channel.resolution.arbiter >= 0 and made.nodes[channel.resolution.arbiter] is node
    ]
    if kept:
        told = (*told, f"It is the one that resolves {listed(f'`{name}`' for name in kept)}.")
    return Section("When it has a say", (Bullets(told),) if told else ())


def _faithful(arbiter: Arbiter) -> Section:
    share = percent(AGREED if arbiter.agreement is None else arbiter.agreement.share)
    told = (
        f"Given what it reads, the robot's own module decides at each of its ticks as this one: in"
        f" {share} of decisions at least."
    )
    return Section("What counts as faithful", (Paragraph(told),))
