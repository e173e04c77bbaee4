"""What a book holds, as text and as JSON."""

from pathlib import Path
from typing import Any

from specc.book.manifest import Book, Module


def book_text(book: Book) -> str:
    """Its modules with their figures and tables, and what the run showed."""
    lines = [f"{book.name}: {len(book.modules)} modules"]
    width = max(len(module.node) for module in book.modules)
    lines += [f"  {module.node:{width}}  {_told(module)}" for module in book.modules]
    lines += [f"  {each.outcome}: {each.text}" for each in book.requirements]
    return "\n".join(lines)


def _told(module: Module) -> str:
    told = f"{module.kind} {module.name}, {_count(len(module.figures), 'portrait')}"
    if not module.tables:
        return told
    worst = max((100.0 * t.error / t.size for t in module.tables if t.size > 0.0), default=0.0)
    tables = _count(len(module.tables), "table")
    return f"{told}, {tables} off by {worst:.2g} % of the largest value at most"


def _count(count: int, what: str) -> str:
    return f"{count} {what}" + ("" if count == 1 else "s")


def book_record(book: Book, folder: Path) -> dict[str, Any]:
    """The same for programs; everything else stands in `book.json`."""
    return {
        "name": book.name,
        "kind": book.kind,
        "folder": str(folder),
        "manifest": str(folder / "book.json"),
        "files": len(book.files) + 1,
        "bytes": sum(file.bytes for file in book.files),
        "modules": [
            {"node": m.node, "kind": m.kind, "spec": m.spec, "page": m.page} for m in book.modules
        ],
        "requirements": [
            {"text": each.text, "outcome": each.outcome} for each in book.requirements
        ],
    }
