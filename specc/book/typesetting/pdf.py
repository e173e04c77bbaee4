"""`book.pdf`: chapters as JSON, a layout that reads it, and Typst, which makes one of both.

Texts never become Typst's own markup: the layout gets them as data. The same chapters give the same
bytes: the fonts are those within Typst, and the time that it writes down is fixed.
"""

import json
from collections.abc import Mapping
from dataclasses import fields
from importlib.resources import files
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final

from specc.book.chapters import Chapter, Listing, Section
from specc.book.typesetting.runs import runs_of
from specc.faults import fault

LAYOUT: Final = "book.typ"
LITERAL: Final = {"Figure": {"name"}, "Listing": {"text", "language"}}
"""Fields of blocks that are shown, or used, as they stand."""
MISSING: Final = "book.pdf is laid out by typst, which is not installed"


def require_typst(named: Path) -> None:
    """Stops before the work begins where there is nothing to lay the document out with.

    Raises:
        SpecError: typst is not installed (V436).
    """
    try:
        import typst  # noqa: F401, PLC0415  an extra: only the PDF needs its 80 MB
    except ImportError as error:
        remedy = "pip install 'specc[pdf]', or make the book without it: --no-pdf"
        raise fault("V436", named, MISSING, remedy) from error


def typeset(
    title: str, about: str, chapters: tuple[Chapter, ...], svgs: Mapping[str, bytes]
) -> bytes:
    """The document's bytes. svgs: the figures by name, for paper."""
    import typst  # noqa: PLC0415  an extra

    document = {
        "title": title,
        "about": about,
        "chapters": [_chapter(chapter) for chapter in chapters],
    }
    with TemporaryDirectory(prefix="specc-book-") as folder:
        root = Path(folder)
        (root / "book.json").write_text(json.dumps(document, ensure_ascii=False), "utf-8")
        layout = files("specc.book.typesetting").joinpath(LAYOUT).read_text("utf-8")
        (root / LAYOUT).write_text(layout, "utf-8")
        for name, data in svgs.items():
            (root / f"{name}.svg").write_bytes(data)
        made = typst.compile(
            str(root / LAYOUT), root=folder, ignore_system_fonts=True, timestamp=0, format="pdf"
        )
    assert isinstance(made, bytes), "one format gives one document"
    return made


def _chapter(chapter: Chapter) -> dict[str, Any]:
    return {
        "name": chapter.name,
        "kind": chapter.kind,
        "title": chapter.title,
        "lead": _runs(chapter.lead),
        "sections": [
            {"title": section.title, "blocks": [_block(block) for block in section.blocks]}
            for section in chapter.sections
            if not _is_spec(section)
        ],
    }


def _is_spec(section: Section) -> bool:
    """Whether it shows a spec, which is a file of the book: not worth paper, all of it is told."""
    return any(isinstance(each, Listing) and each.language == "yaml" for each in section.blocks)


def _block(block: Any) -> dict[str, Any]:
    """A block as data: its texts in runs, but for what is shown as it stands."""
    found: dict[str, Any] = {"is": type(block).__name__}
    literal = LITERAL.get(found["is"], set())
    for field in fields(block):
        value = getattr(block, field.name)
        found[field.name] = value if field.name in literal else _as_runs(value)
    return found


def _as_runs(value: Any) -> Any:
    if isinstance(value, str):
        return _runs(value)
    return [_as_runs(each) for each in value] if isinstance(value, tuple) else value


def _runs(text: str) -> list[dict[str, Any]]:
    return [{"text": run.text, "code": run.code, "to": run.to} for run in runs_of(text)]
