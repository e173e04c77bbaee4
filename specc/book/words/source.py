"""A spec as its author wrote it: its words, its text, and its parts."""

from collections.abc import Mapping
from itertools import takewhile

from runtime.program import Origin, Program
from spec_schema.behavior import BehaviorSpec
from spec_schema.field_forms import Formula, Step
from spec_schema.field_modes import Modes
from spec_schema.load import examine_source
from spec_schema.source import Source
from specc.book.chapters import Listing, Paragraph, Section


def author_words(text: str) -> tuple[str, ...]:
    """The comment at the head of a spec: what its author says of it, in paragraphs."""
    lines = takewhile(lambda line: line.startswith("#"), text.splitlines())
    pieces = "\n".join(line.lstrip("#").strip() for line in lines).split("\n\n")
    return tuple(" ".join(piece.split()) for piece in pieces if piece.strip())


def words_above(text: str, key: str) -> tuple[str, ...]:
    """What its author says right above a key at the left edge."""
    lines = text.splitlines()
    place = next((k for k, line in enumerate(lines) if line.startswith(key)), 0)
    above = list(takewhile(lambda line: line.startswith("#"), reversed(lines[:place])))
    told = " ".join(line.lstrip("#").strip() for line in reversed(above))
    return (told,) if told else ()


def behavior_spec(program: Program) -> BehaviorSpec | None:
    """The spec that a program was compiled from, out of the text that it carries."""
    loaded = examine_source(Source(program.source.file, program.source.text)).loaded
    spec = None if loaded is None else loaded.spec
    return spec if isinstance(spec, BehaviorSpec) else None


def formulas_of(program: Program, index: int) -> Mapping[str, str]:
    """The formulas of a field as their author wrote them, in the mode of that index; or none."""
    spec = behavior_spec(program)
    match spec.field.form if spec is not None else None:
        case Modes(of=name, each=each) if index >= 0:
            values = next(state.values for state in program.states if state.name == name)
            return each[values[index]].formula
        case Step(next=rates):
            return rates
        case Formula(rates=rates):
            return rates
        case _:
            return {}


def conditions_of(program: Program, mode: str) -> list[str]:
    """The conditions of the ways out of a mode, as their author wrote them."""
    spec = behavior_spec(program)
    form = spec.field.form if spec is not None else None
    if not isinstance(form, Modes) or mode not in form.each:
        return []
    return [way.when for way in form.each[mode].leave]


def spec_section(source: Origin, title: str = "The spec") -> Section:
    """The text of a spec, whole."""
    told = f"The file [{source.file}]({source.file}), SHA-256 `{source.sha256}`."
    return Section(title, (Paragraph(told, is_small=True), Listing(source.text, "yaml")))
