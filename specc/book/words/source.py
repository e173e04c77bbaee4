"""A spec as its author wrote it: its words, its text, and its parts."""

from itertools import takewhile

from runtime.program import Origin, Program
from spec_schema.behavior import BehaviorSpec
from spec_schema.load import examine_source
from spec_schema.source import Source
from specc.book.chapters import Listing, Paragraph, Section


def author_words(text: str) -> tuple[str, ...]:
    """The comment at the head of a spec: what its author says of it, in paragraphs."""
    lines = takewhile(lambda line: line.startswith("#"), text.splitlines())
    pieces = "\n".join(line.lstrip("#").strip() for line in lines).split("\n\n")
    return tuple(" ".join(piece.split()) for piece in pieces if piece.strip())


def behavior_spec(program: Program) -> BehaviorSpec | None:
    """The spec that a program was compiled from, out of the text that it carries."""
    loaded = examine_source(Source(program.source.file, program.source.text)).loaded
    spec = None if loaded is None else loaded.spec
    return spec if isinstance(spec, BehaviorSpec) else None


def spec_section(source: Origin, title: str = "The spec") -> Section:
    """The text of a spec, whole."""
    told = f"The file [{source.file}]({source.file}), SHA-256 `{source.sha256}`."
    return Section(title, (Paragraph(told, is_small=True), Listing(source.text, "yaml")))
