"""What machines read: findings, JUnit XML, SARIF, GitHub annotations, JSON.

The rules that are checked here are those of the formats' own documents: junit-10.xsd of Jenkins'
xUnit plugin, SARIF 2.1.0 (OASIS, March 2020), GitHub's workflow commands.
"""

import json
import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any
from urllib.parse import unquote, urlparse
from xml.etree import ElementTree as ET

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.specc.examination_scenes import examination, passed
from verifier.report.annotations import annotation, as_annotations
from verifier.report.examination import Examination
from verifier.report.examination_record import examination_record
from verifier.report.examination_text import examination_text
from verifier.report.findings import Finding, Level, Rule, findings_of
from verifier.report.junit import as_junit
from verifier.report.places import place_of
from verifier.report.report import Standing, Verdict
from verifier.report.sarif import as_sarif

HOSTILE = "\x00\x1b[31m]]><x a='1'>&\"\ud800\uffff%0A::error::\r\nend"


def broken(word: str) -> Examination:
    """An examination with a stranger's text in its names."""
    made = examination(word=word)
    trace = replace(made.report.trace, source=f"run{word}.mcap")
    return replace(made, report=replace(made.report, trace=trace))


# --- findings


def test_each_finding_carries_the_line_of_the_spec_that_it_is_about() -> None:
    found = findings_of(examination())

    assert all(place_of(finding.origin) for finding in found)
    assert all(place.line > 0 for f in found if (place := place_of(f.origin)))
    rules = {finding.rule: finding.origin for finding in found}
    assert rules[Rule.EXCEEDED] == "husky_drive.yaml:12:3"
    assert rules[Rule.SWITCHING] == "husky_drive.yaml:33:5"
    assert rules[Rule.FEATURE] == "husky_drive.yaml:50:5"


def test_the_gravest_findings_come_first() -> None:
    levels = [finding.level for finding in findings_of(examination())]

    assert levels == sorted(levels, key=list(Level).index)
    assert levels[0] is Level.ERROR
    assert set(levels) == set(Level)


def test_a_robot_that_does_what_the_spec_says_is_no_finding() -> None:
    assert findings_of(passed()) == ()


def test_an_inconclusive_verdict_says_why_once() -> None:
    found = findings_of(examination(Verdict.INCONCLUSIVE))

    assert [f.message for f in found if f.rule is Rule.INCONCLUSIVE] == [
        "heading departs by 1.8 deg"
    ]


# --- JUnit


TESTSUITE = {"name", "tests", "failures", "errors", "skipped", "timestamp", "id", "package"}
TESTCASE = {"name", "classname", "time", "file", "line", "assertions", "status"}


def junit(*examinations: Examination) -> ET.Element:
    return ET.fromstring(as_junit(examinations, [("lost.mcap", "V301: no such file\nmore")]))  # noqa: S314  our own


def assert_valid(root: ET.Element) -> None:
    """The rules of junit-10.xsd that can be broken here."""
    assert root.tag == "testsuites"
    assert root.attrib.keys() <= {"name", "tests", "failures", "errors", "time", "disabled"}
    for suite in root:
        assert suite.tag == "testsuite"
        assert {"name", "tests"} <= suite.attrib.keys() <= TESTSUITE
        tags = [child.tag for child in suite]
        assert tags == sorted(tags, key=["properties", "testcase"].index)
        assert int(suite.attrib["tests"]) == tags.count("testcase")
        assert int(suite.attrib["failures"]) == len(suite.findall("testcase/failure"))
        assert int(suite.attrib["errors"]) == len(suite.findall("testcase/error"))
        if "timestamp" in suite.attrib:
            assert re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d", suite.attrib["timestamp"])
        for case in suite.iter("testcase"):
            assert {"name", "classname"} <= case.attrib.keys() <= TESTCASE
            assert {child.tag for child in case} <= {"failure", "error", "skipped"}
            assert all("message" in child.attrib.keys() <= {"message", "type"} for child in case)
    for name in ("tests", "failures", "errors"):
        assert int(root.attrib[name]) == sum(int(suite.attrib[name]) for suite in root)


@pytest.mark.parametrize("verdict", list(Verdict))
def test_junit_is_valid_and_red_unless_the_verdict_is_pass(verdict: Verdict) -> None:
    root = junit(examination(verdict), passed())

    assert_valid(root)
    found = {child.tag for case in root[0].iter("testcase") for child in case}
    red = {Verdict.PASS: set(), Verdict.FAIL: {"failure"}, Verdict.INCONCLUSIVE: {"error"}}
    assert found & {"failure", "error"} >= red[verdict]
    assert not list(root[1].iter("failure")) + list(root[1].iter("error"))


def test_junit_counts_one_failure_for_each_variable_that_fails() -> None:
    made = examination(Verdict.FAIL)
    failing = [v for v in made.report.variables if v.standing is Standing.EXCEEDED]
    ways = made.switching.ways if made.switching else ()
    failing_ways = [way for way in ways if way.standing is Standing.EXCEEDED]
    assert failing

    suite = junit(made)[0]

    assert int(suite.attrib["failures"]) == len(failing) + len(failing_ways)


def test_junit_has_a_case_for_each_variable_and_requirement() -> None:
    names = [case.attrib["name"] for case in junit(examination())[0].iter("testcase")]

    assert names == [
        "does what the spec says",
        "x within 0.1 m after 5 s",
        "heading within 1.15 deg after 5 s",
        "at least 60 % of the region seen",
        "phase: go to back",
        "phase: back to go",
    ]
    heading = junit(examination())[0].findall("testcase")[2]
    assert (heading.attrib["file"], heading.attrib["line"]) == ("husky_drive.yaml", "12")


def test_a_trace_that_cannot_be_used_is_an_error_in_junit() -> None:
    last = junit(passed())[-1]

    assert last.attrib["name"] == "lost.mcap"
    assert [e.attrib["message"] for e in last.iter("error")] == ["V301: no such file"]


def test_junit_survives_what_xml_cannot_hold() -> None:
    root = ET.fromstring(as_junit([broken(HOSTILE)]))  # noqa: S314  our own

    assert_valid(root)
    assert "]]><x a='1'>&\"" in root[0].attrib["name"]


# --- SARIF


def sarif(*examinations: Examination) -> dict[str, object]:
    runs = [(e.report.trace.source, findings_of(e)) for e in examinations]
    return json.loads(json.dumps(as_sarif(runs, "0.1.0"), allow_nan=False))


def assert_sarif(log: dict[str, object]) -> Iterator[dict[str, object]]:
    """The rules of SARIF 2.1.0 that can be broken here; yields the results."""
    assert log["version"] == "2.1.0"
    assert set(log) == {"$schema", "version", "runs"}
    (run,) = log["runs"]
    driver = run["tool"]["driver"]
    assert driver["name"]
    assert re.fullmatch(r"\d+\.\d+\.\d+", driver["semanticVersion"])
    rules = driver["rules"]
    assert len({rule["id"] for rule in rules}) == len(rules)
    assert all(rule["shortDescription"]["text"].endswith(".") for rule in rules)
    assert all(re.fullmatch("[A-Za-z]+", rule["name"]) for rule in rules)
    assert run["columnKind"] in {"utf16CodeUnits", "unicodeCodePoints"}
    for result in run["results"]:
        assert rules[result["ruleIndex"]]["id"] == result["ruleId"]
        assert result["level"] in {"none", "note", "warning", "error"}
        assert result["message"]["text"]
        (location,) = result["locations"]
        if "physicalLocation" in location:
            uri = location["physicalLocation"]["artifactLocation"]["uri"]
            assert not re.search(r"[\s\\<>{}|^`]", uri)
            region = location["physicalLocation"].get("region", {"startLine": 1, "startColumn": 1})
            assert region["startLine"] >= 1
            assert region["startColumn"] >= 1
        assert all(name["name"] for name in location["logicalLocations"])
        assert all("/v" in key for key in result["partialFingerprints"])
        yield result


def test_sarif_is_valid_and_points_into_the_spec() -> None:
    results = list(assert_sarif(sarif(examination(), passed())))

    assert len(results) == len(findings_of(examination()))
    place = results[0]["locations"][0]["physicalLocation"]
    assert place["artifactLocation"]["uri"] == "husky_drive.yaml"
    assert place["region"] == {"startLine": 12, "startColumn": 3}


def test_two_traces_do_not_share_fingerprints_but_two_judgements_of_one_do() -> None:
    made = examination()
    other = replace(
        made, report=replace(made.report, trace=replace(made.report.trace, source="b.mcap"))
    )

    def prints(log: dict[str, object]) -> list[str]:
        return [r["partialFingerprints"]["finding/v1"] for r in assert_sarif(log)]

    assert not set(prints(sarif(made))) & set(prints(sarif(other)))
    assert prints(sarif(made)) == prints(sarif(made))
    assert len(set(prints(sarif(made)))) == len(prints(sarif(made)))


@pytest.mark.parametrize(
    "file", ["specs/a b.yaml", "/srv/ä.yaml", "a:b.yaml", "C:/specs/a.yaml", "../x#1?.yaml"]
)
def test_uris_name_the_file(file: str) -> None:
    finding = Finding(Rule.EXCEEDED, Level.ERROR, "x", "it departs", f"{file}:3:7")

    (result,) = assert_sarif(json.loads(json.dumps(as_sarif([("run", [finding])], "0.1.0"))))

    uri = urlparse(result["locations"][0]["physicalLocation"]["artifactLocation"]["uri"])
    assert uri.scheme in {"", "file"}
    assert unquote(uri.path).lstrip("/") == file.lstrip("/")


# --- GitHub


COMMAND = re.compile(r"::(error|warning|notice) ([^\n]*?)::([^\n]*)")


def read(line: str) -> tuple[str, dict[str, str], str]:
    """A workflow command as GitHub's runner reads it (actions/toolkit, command.ts)."""
    found = COMMAND.fullmatch(line)
    assert found, line
    pairs = (pair.split("=", 1) for pair in found[2].split(","))
    undone = {"%0D": "\r", "%0A": "\n", "%3A": ":", "%2C": ",", "%25": "%"}
    parts = {name: _undone(value, undone) for name, value in pairs}
    return found[1], parts, _undone(found[3], undone)


def _undone(text: str, undone: dict[str, str]) -> str:
    return re.sub("%0D|%0A|%3A|%2C|%25", lambda m: undone[m[0]], text)


def test_annotations_stand_at_their_lines() -> None:
    first = as_annotations(findings_of(examination()), "husky.mcap").splitlines()[0]

    kind, parts, message = read(first)
    assert kind == "error"
    assert (parts["file"], parts["line"], parts["col"]) == ("husky_drive.yaml", "12", "3")
    assert message.startswith("husky.mcap: heading departs by 1.78 deg after 5 s")


@given(st.text(), st.text(), st.text(min_size=1).filter(lambda t: not t[-1].isdigit()))
def test_an_annotation_is_one_line_that_reads_as_it_was(
    title: str, message: str, file: str
) -> None:
    line = annotation("error", f"{file}:3:1", title, message)

    assert "\n" not in line
    assert "\r" not in line
    assert read(line) == (
        "error",
        {"file": file, "title": title, "line": "3", "col": "1"},
        message,
    )


# --- JSON and text


def test_the_record_is_json_with_every_section() -> None:
    record = json.loads(json.dumps(examination_record(examination()), allow_nan=False))

    assert record["format"] == 1
    assert record["diagnosis"]["candidates"][0]["numbers"][0]["interval"] == [0.44, None]
    assert record["limits"]["caught"][0]["smallest"] == pytest.approx(3.1)  # per cent
    assert record["limits"]["caught"][1]["smallest"] is None
    assert record["features"]["features"][0]["numbers"][0]["seen"]["value"] == 6.82
    assert record["switching"]["switches"][-1]["late"] is None
    assert record["scores"]["variables"]["x"]["iso_18571"]["overall"] == 0.957
    assert {finding["level"] for finding in record["findings"]} == {"error", "warning", "note"}


def test_a_section_that_was_not_computed_is_null() -> None:
    record = examination_record(passed())

    sections = ("diagnosis", "limits", "features", "switching", "scores")
    assert [record[name] for name in sections] == [None] * 5


def test_the_text_tells_every_section_within_its_width() -> None:
    text = examination_text(examination())

    titles = [
        "why: structure differs",
        "changes of phase: exceeded",
        "features of the field",
        "what this trace can't tell",
        "what would have been caught",
        "scores, for comparison only",
        "not judged",
        "next",
    ]
    places = [text.index(title) for title in titles]
    assert places == sorted(places)
    assert max(len(line) for line in text.splitlines()) <= 120


# --- the JSON Schema

SCHEMA = json.loads((Path(__file__).parents[2] / "docs/schema/report.schema.json").read_text())
KINDS = {
    "object": dict,
    "array": list,
    "string": str,
    "integer": int,
    "number": (int, float),
    "boolean": bool,
    "null": type(None),
}


def faults(value: Any, schema: dict[str, Any], at: str = "$") -> list[str]:
    """What of the schema's own words (those that it uses) a value breaks."""
    if "$ref" in schema:
        return faults(value, SCHEMA["$defs"][schema["$ref"].rsplit("/", 1)[1]], at)
    if "anyOf" in schema:
        tried = [faults(value, each, at) for each in schema["anyOf"]]
        return [] if [] in tried else tried[0]
    if "enum" in schema or "const" in schema:
        return [] if value in schema.get("enum", [schema.get("const")]) else [f"{at}: {value!r}"]
    kinds = [schema["type"]] if isinstance(schema["type"], str) else schema["type"]
    is_fit = any(isinstance(value, KINDS[kind]) for kind in kinds)
    if not is_fit or (isinstance(value, bool) and "boolean" not in kinds):
        return [f"{at}: {value!r} is no {kinds}"]
    found = [f"{at}.{name} is missing" for name in schema.get("required", ()) if name not in value]
    if isinstance(value, dict):
        for name, inner in value.items():
            rule = schema.get("properties", {}).get(name) or schema.get("additionalProperties")
            found += faults(inner, rule, f"{at}.{name}") if rule else []
    if isinstance(value, list) and "items" in schema:
        for k, inner in enumerate(value):
            found += faults(inner, schema["items"], f"{at}[{k}]")
    return found


@pytest.mark.parametrize("made", [examination(), passed()])
def test_the_record_is_what_its_schema_says(made: Examination) -> None:
    record = json.loads(json.dumps(examination_record(made)))

    assert faults(record, SCHEMA) == []
    assert set(record) <= set(SCHEMA["$defs"]["report"]["properties"])


def test_a_record_without_a_reason_or_with_another_verdict_breaks_the_schema() -> None:
    record = json.loads(json.dumps(examination_record(passed())))

    assert faults({**record, "verdict": "perhaps"}, SCHEMA)
    assert faults({k: v for k, v in record.items() if k != "reasons"}, SCHEMA)
