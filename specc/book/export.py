"""A book, from a spec to its folder."""

from pathlib import Path
from typing import Final

from runtime.progress import Progress, in_silence
from specc import __version__
from specc.book import manifest
from specc.book.contents import Contents, gathered
from specc.book.entries import architecture_entry
from specc.book.folder import MANIFEST, refuse_early, write_folder
from specc.book.illustrations import figures_of
from specc.book.manifest import Book, Required
from specc.book.naming import Names, names_of
from specc.book.reader import READER, reader_text
from specc.book.table_files import as_csv, as_npz
from specc.book.typesetting.pdf import require_typst, typeset
from specc.book.words.all import chapters_of
from specc.book.words.legs import as_rows
from specc.pages.book_page import book_pages

PDF: Final = "book.pdf"


def export_book(
    spec: Path | str,
    folder: Path | str,
    progress: Progress = in_silence,
    *,
    allow_code: bool = False,
    with_pdf: bool = True,
) -> Book:
    """Write the book of an architecture or a scenario, and return its manifest.

    Args:
        spec: of the architecture or the scenario (.yaml).
        folder: where the book shall be; an older book there is replaced.
        progress: is told what is done, how much of it, and of how much.
        allow_code: whether Python that the specs name may be run.
        with_pdf: whether `book.pdf` is made, for which typst is needed.

    Raises:
        SpecError: the spec is wrong, or the book can't be put there.
    """
    prepare(Path(folder), with_pdf=with_pdf)
    contents = gathered(Path(spec), progress, allow_code=allow_code)
    return write_book(contents, Path(folder), progress, with_pdf=with_pdf)


def prepare(folder: Path, *, with_pdf: bool) -> None:
    """Stops before the work begins where no book could be written in the end.

    Raises:
        SpecError: as `refuse_early` and `require_typst`.
    """
    refuse_early(folder)
    if with_pdf:
        require_typst(folder / PDF)


def write_book(contents: Contents, folder: Path, progress: Progress, *, with_pdf: bool) -> Book:
    """Write a book of these contents, and return its manifest.

    Raises:
        SpecError: it can't be put there.
    """
    found = files_of(contents, progress, with_pdf=with_pdf)
    write_folder(folder, found)
    return manifest.from_bytes(found[MANIFEST])


def files_of(contents: Contents, progress: Progress, *, with_pdf: bool = True) -> dict[str, bytes]:
    """Every file of the book, by its path in it."""
    names = names_of(contents)
    found = {name: path.read_bytes() for path, name in contents.sources.names.items()}
    found[manifest.ARTIFACTS[contents.kind]] = contents.artifact
    found[READER] = reader_text().encode()
    found |= _data(contents, names)
    found |= figures_of(contents, names, progress)
    chapters = chapters_of(contents, names, with_pdf=with_pdf)
    if with_pdf:
        progress("laying out the PDF", 0, 1)
        found[PDF] = typeset(contents.name, contents.about, chapters, _on_paper(found))
    found |= book_pages(contents.name, chapters, frozenset((*found, MANIFEST)))
    book = _book(contents, names, found)
    return {MANIFEST: manifest.to_bytes(book), **found}


def _on_paper(found: dict[str, bytes]) -> dict[str, bytes]:
    """The light figures by their names."""
    light = [p for p in found if p.startswith("figures/") and not p.endswith(".dark.svg")]
    return {path.removeprefix("figures/").removesuffix(".svg"): found[path] for path in light}


def _data(contents: Contents, names: Names) -> dict[str, bytes]:
    found = {}
    for of in contents.architectures:
        for shown in of.nodes:
            if shown.sheets:
                npz, text = names.data(of.architecture, shown.node)
                found[npz] = as_npz(shown.sheets)
                found[text] = as_csv(shown.sheets)
            procedure = shown.trial.procedure
            if procedure is not None and procedure.drives:
                found[names.procedure(of.architecture, shown.node)] = as_rows(procedure)
    return found


def _book(contents: Contents, names: Names, found: dict[str, bytes]) -> Book:
    return Book(
        kind=contents.kind,
        name=contents.name,
        about=contents.about,
        specc=__version__,
        spec=contents.spec,
        artifact=manifest.ARTIFACTS[contents.kind],
        seed=None if contents.scenario is None else contents.scenario.seed,
        architectures=tuple(architecture_entry(of, names) for of in contents.architectures),
        requirements=tuple(
            Required(each.text, str(each.outcome), each.sentence) for each in contents.results
        ),
        files=tuple(manifest.file_entry(path, data) for path, data in sorted(found.items())),
    )
