"""The report's page: self-contained, well-formed, in order, and safe from hostile names."""

import math
import re
from collections import Counter
from dataclasses import replace
from html.parser import HTMLParser

import pytest

from runtime.program import Unit
from specc.pages.report_page import report_page
from specc.pages.sentences import ranged
from tests.specc.examination_scenes import examination
from tests.specc.report_scenes import coverage, report
from verifier.report.examination import Examination
from verifier.report.report import Interval, Verdict

VOID = {"meta", "br", "img", "link", "input", "hr"}
HOSTILE = (
    "</style></svg>--><script>alert(1)</script>\"'><img src=x onerror=alert(2)>{{ 7*7 }}$\\frac$"
)


class Reader(HTMLParser):
    """Notes tags, ids and attributes, and whether every tag is closed in order."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.tags: list[str] = []
        self.ids: list[str] = []
        self.attributes: list[tuple[str, str]] = []
        self.text: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.attributes += [(name, value or "") for name, value in attrs]
        self.ids += [value or "" for name, value in attrs if name == "id"]
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.handle_starttag(tag, attrs)
        if tag not in VOID:
            self.open.pop()

    def handle_endtag(self, tag: str) -> None:
        assert self.open, f"</{tag}> closes nothing"
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.text.append(data)


def read(page: str) -> Reader:
    reader = Reader()
    reader.feed(page)
    reader.close()
    return reader


@pytest.fixture(scope="module")
def page() -> str:
    return report_page(examination())


def test_the_page_is_well_formed_and_its_ids_are_unique(page: str) -> None:
    reader = read(page)

    assert reader.open == []
    assert [name for name, count in Counter(reader.ids).items() if count > 1] == []


def test_every_reference_within_the_page_has_a_target(page: str) -> None:
    targets = set(re.findall(r'href="#([^"]+)"|url\(#([^)]+)\)', page))

    assert targets
    assert {a or b for a, b in targets} <= set(read(page).ids)


def test_the_page_asks_for_nothing_from_elsewhere(page: str) -> None:
    reader = read(page)

    assert not {"script", "link", "iframe", "object", "embed"} & set(reader.tags)
    links = [v for n, v in reader.attributes if n in {"src", "href", "xlink:href", "srcset"}]
    assert all(value.startswith(("#", "data:")) for value in links)
    assert "@import" not in page
    assert not re.search(r"url\((?!#)", page)


def test_the_verdict_and_its_reason_come_first(page: str) -> None:
    text = " ".join(read(page[page.index("<main>") : page.index("</body>")]).text)

    assert text.split()[:2] == ["✗", "fail"]
    order = [
        "heading departs by 1.8 deg",
        "What to do next",
        "drive the left third",
        "Every judged variable",
        "Coverage",
        "What was left out",
        "Where this comes from",
        "a3a3a3",
    ]
    places = [text.index(part) for part in order]
    assert places == sorted(places)


def test_quantities_are_in_the_users_units(page: str) -> None:
    assert "1.15 deg" in page  # the tolerance of 0.02 rad
    assert "0.1 m" in page


def test_hostile_texts_stay_texts(page: str) -> None:
    honest = read(page)
    hostile_page = report_page(
        replace(
            examination(word=HOSTILE),
            report=report(cells=coverage(2), word=HOSTILE, heading=f"h{HOSTILE}"),
        )
    )
    hostile = read(hostile_page)

    assert "<script>" not in hostile_page
    assert "onerror" not in {name for name, _ in hostile.attributes}
    assert "{{ 7*7 }}" in hostile_page
    # Not one element more than with honest texts, but for the glyphs that spell them.
    glyphs = {"path", "use", "g", "defs"}
    assert Counter(t for t in hostile.tags if t not in glyphs) == Counter(
        t for t in honest.tags if t not in glyphs
    )
    assert hostile.open == []


@pytest.mark.parametrize("verdict", list(Verdict))
def test_every_verdict_has_its_page(verdict: Verdict) -> None:
    made = replace(report(verdict), variables=())

    assert f'class="verdict {verdict}"' in report_page(Examination(made))


def test_a_report_that_judged_nothing_still_has_a_page() -> None:
    nothing = replace(
        report(Verdict.INCONCLUSIVE, windows=0), variables=(), exclusions=(), losses=(), notes=()
    )

    page = report_page(Examination(nothing))

    assert "Nothing was excluded" in page
    assert "declares no region" in page
    assert read(page).open == []


def test_a_variable_without_windows_has_no_figures_but_a_row() -> None:
    made = read(report_page(Examination(report(Verdict.INCONCLUSIVE, windows=0))))

    assert made.tags.count("figure") == 1


def test_the_same_report_gives_the_same_page() -> None:
    made = replace(report(), variables=report().variables[:1])

    assert report_page(Examination(made)) == report_page(Examination(made))


def test_an_interval_of_too_few_switches_is_not_known() -> None:
    assert ranged(Interval(-math.inf, math.inf), Unit("s", 1.0)) == "not known"
    assert ranged(Interval(-0.1, 0.2), Unit("s", 1.0)) == "−0.1 … 0.2 s"
