"""Pages and the PDF of a book: what texts of strangers become, and that they are the same twice."""

import re
import zlib

import pytest

from runtime.code import Code
from specc.book.chapters import (
    Bullets,
    Chapter,
    Figure,
    Formulas,
    Heading,
    Listing,
    Paragraph,
    Section,
    Table,
)
from specc.book.formulas import in_mode, of_tree, written
from specc.book.typesetting.pdf import typeset
from specc.book.typesetting.runs import runs_of
from specc.book.words.source import author_words
from specc.pages.book_page import book_pages, said
from specc.pages.listing import listing

SVG = b'<svg xmlns="http://www.w3.org/2000/svg" width="9" height="9"><path d="M0 0h9v9z"/></svg>'
BAD = "#panic() $x$ *b* <script>alert(1)</script> `a<b` [x](javascript:alert) [there](two) \\"


def chapters(text: str = BAD) -> tuple[Chapter, ...]:
    blocks = (
        Heading(text),
        Paragraph(text),
        Paragraph(text, is_small=True),
        Bullets((text, text), is_ordered=True),
        Table((text, "n"), ((text, "1"), (text, "2")), (1,)),
        Formulas(((text, text, text), ("a", "b", ""))),
        Listing(text, "python"),
        Figure("square", text, text),
    )
    spec = Section(text, (Listing(text, "yaml"),))
    return (
        Chapter("index", "book", text, text, (Section(text, blocks), spec)),
        Chapter("two", "page", "two", "", (Section("s", (Paragraph("[back](index)"),)),)),
    )


def test_texts_of_strangers_are_texts_in_pages() -> None:
    page = book_pages(BAD, chapters(), frozenset())["index.html"].decode()

    assert "<script>" not in page
    assert "javascript" in page  # as words
    assert 'href="javascript' not in page
    assert '<a href="pages/two.html">there</a>' in page
    assert "<code>a&lt;b</code>" in page


def test_pages_in_folders_link_upwards() -> None:
    page = book_pages("b", chapters(), frozenset({"data/x.csv"}))["pages/two.html"].decode()

    assert '<a href="../index.html">back</a>' in page


def test_texts_of_strangers_are_texts_in_the_document_and_it_is_the_same_twice() -> None:
    pytest.importorskip("typst")
    made = typeset(BAD, BAD, chapters(), {"square": SVG})

    assert made.startswith(b"%PDF-")
    assert made == typeset(BAD, BAD, chapters(), {"square": SVG})


def test_a_link_to_what_is_not_in_the_book_is_its_words() -> None:
    assert str(said("see [this](nowhere)", {})) == "see this"


def test_runs_hold_all_words_of_a_text() -> None:
    runs = runs_of("`a` and [b `c`](d), e")

    assert [(r.text, r.code, r.to) for r in runs] == [
        ("a", True, ""),
        (" and ", False, ""),
        ("b ", False, "d"),
        ("c", True, "d"),
        (", e", False, ""),
    ]


def test_formulas_are_written_with_signs_and_labels() -> None:
    labels = {"side": ("left", "right")}
    code = Code("side 1 eq gain neg x mul 2 pow 0 where")

    assert written(code, labels) == "where(side = 'right', (−gain·x)^2, 0)"
    assert of_tree(in_mode(code, "side", 0)) == "0"


def test_the_words_of_an_author_are_the_comment_at_the_head() -> None:
    text = "# One\n# line.\n#\n# Two.\nspecc: 1\n# no more\n"

    assert author_words(text) == ("One line.", "Two.")
    assert author_words("specc: 1\n") == ()


def test_a_listing_tells_comments_keys_and_texts_apart() -> None:
    shown = str(listing('about: "a # b"  # <c>\nx-y: 1\n'))

    assert '<span class="k">about</span>: <span class="s">&#34;a # b&#34;</span>' in shown
    assert '<span class="c"># &lt;c&gt;</span>' in shown


def test_a_wide_figure_is_scrolled_on_pages_and_has_a_page_of_its_size_in_the_document() -> None:
    figure = Figure("wires", "Caption.", "wires", is_wide=True)
    listing_ = Section("The spec", (Listing("kind: behavior", "yaml"),))
    chapter = Chapter("a", "k", "A", "", (Section("S", (figure,)), listing_))
    page = book_pages("b", (chapter,), frozenset())["index.html"].decode()
    assert '<figure class="wide">' in page
    assert "kind" in page
    width, height = 2000, 700
    svg = f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}pt" height="{height}pt"/>'
    made = typeset("b", "", (chapter,), {"wires": svg.encode()})
    streams = re.findall(rb"stream\r?\n(.*?)\r?\nendstream", made, re.DOTALL)
    opened = b"".join(zlib.decompressobj().decompress(s) for s in streams if s[:1] == b"x")
    widths = [float(w) for w in re.findall(rb"/MediaBox ?\[0 0 ([\d.]+) ", made + opened)]
    assert len(widths) == 3
    assert max(widths) > width
