"""The report as JUnit XML, for the test pages of Jenkins, GitLab and others.

A test suite is a trace, a test case one requirement of the spec: a `failure` where the robot is
shown to break it, an `error` where the trace does not decide (a build must not turn green on
that), or where the trace can't be used at all. What a trace leaves open that is judged together
with others is `skipped`: then the suite of all together decides. Valid against the schema of
Jenkins' xUnit plugin (junit-10.xsd), whose `file` and `line` of a test case GitLab shows as well.
"""

import re
from collections.abc import Collection, Sequence
from typing import Final
from xml.etree import ElementTree as ET

from verifier.report.examination import Examination
from verifier.report.places import place_of
from verifier.report.report import Report, Standing
from verifier.report.requirements import WHOLE, Requirement, requirements_of
from verifier.report.wording import date_of

FORBIDDEN: Final = re.compile("[^\t\n\r -\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
"""What XML 1.0 can't hold, not even escaped."""


def as_junit(
    examinations: Sequence[Examination],
    unusable: Sequence[tuple[str, str]] = (),
    parts: Collection[Examination] = (),
    skipped: Sequence[tuple[str, str]] = (),
) -> bytes:
    """All traces as one document; `unusable` are those without a report, `(source, why)`.

    parts: those examinations that are also judged together, as another one of them.
    skipped: what could not be judged, `(source, why)`, which makes no verdict worse.
    """
    suites = [_suite(each, is_part=each in parts) for each in examinations]
    suites += [_unjudged(source, why, "error", "unusable") for source, why in unusable]
    suites += [_unjudged(source, why, "skipped") for source, why in skipped]
    root = ET.Element("testsuites", {"name": "specc verify", **_counts(suites)})
    root.extend(suites)
    ET.indent(root)
    document: bytes = ET.tostring(root, encoding="utf-8", xml_declaration=True)
    return document + b"\n"


def _suite(examination: Examination, *, is_part: bool) -> ET.Element:
    report = examination.report
    whole, *parts = requirements_of(examination)
    told = [each.name for each in parts if each.standing is whole.standing]
    if whole.name == WHOLE and whole.standing is not Standing.WITHIN and told:
        cases = [_told_apart(whole, report, told)]  # else one mistake would count twice
    else:
        cases = [_case(whole, report, is_part=is_part)]
    cases += [_case(each, report, is_part=is_part) for each in parts]
    attributes = {"name": clean(report.trace.source), **_counted(cases)}
    date = date_of(report.trace.start)
    if date is not None:
        attributes["timestamp"] = f"{date:%Y-%m-%dT%H:%M:%S}"
    suite = ET.Element("testsuite", attributes)
    suite.append(_properties(report))
    suite.extend(cases)
    return suite


def _properties(report: Report) -> ET.Element:
    properties = ET.Element("properties")
    named = {
        "verdict": str(report.verdict),
        "spec": report.spec.file,
        "spec sha256": report.spec.sha256,
        "judged seconds": f"{report.trace.judged:.6g}",
    }
    for name, value in named.items():
        ET.SubElement(properties, "property", {"name": name, "value": clean(value)})
    return properties


def _case(requirement: Requirement, report: Report, *, is_part: bool) -> ET.Element:
    case = _bare_case(requirement.name, report.spec.name, requirement.origin)
    outcome = {Standing.EXCEEDED: "failure", Standing.UNDECIDED: "error"}
    lines = clean(requirement.message).splitlines() or [""]
    if is_part and requirement.standing is Standing.UNDECIDED:
        ET.SubElement(case, "skipped", {"message": lines[0]})
    elif requirement.standing in outcome:
        attributes = {"message": lines[0], "type": str(requirement.standing)}
        told = ET.SubElement(case, outcome[requirement.standing], attributes)
        told.text = "\n".join([*lines, requirement.origin]).strip()
    return case


def _told_apart(whole: Requirement, report: Report, told: Sequence[str]) -> ET.Element:
    """The verdict as a whole, where test cases of its own say what makes it."""
    case = _bare_case(whole.name, report.spec.name, whole.origin)
    message = f"{report.verdict.upper()}, told by the test cases: {'; '.join(told)}"
    ET.SubElement(case, "skipped", {"message": clean(message)})
    return case


def _bare_case(name: str, classname: str, origin: str) -> ET.Element:
    attributes = {"name": clean(name), "classname": clean(classname)}
    place = place_of(origin)
    if place is not None:
        attributes["file"] = clean(place.file)
        if place.line:
            attributes["line"] = str(place.line)
    return ET.Element("testcase", attributes)


def _unjudged(source: str, why: str, outcome: str, kind: str = "") -> ET.Element:
    case = _bare_case("can be judged", "specc verify", "")
    first = (clean(why).splitlines() or [""])[0]
    told = ET.SubElement(case, outcome, {"message": first} | ({"type": kind} if kind else {}))
    told.text = clean(why)
    suite = ET.Element("testsuite", {"name": clean(source), **_counted([case])})
    suite.append(case)
    return suite


def _counted(cases: Sequence[ET.Element]) -> dict[str, str]:
    """The counts of one suite."""
    found = {name: sum(c.find(name) is not None for c in cases) for name in ("failure", "error")}
    failures, errors = str(found["failure"]), str(found["error"])
    skipped = sum(case.find("skipped") is not None for case in cases)
    counts = {"tests": str(len(cases)), "failures": failures, "errors": errors}
    return counts | ({"skipped": str(skipped)} if skipped else {})


def _counts(suites: Sequence[ET.Element]) -> dict[str, str]:
    """The sums over all suites."""
    return {
        name: str(sum(int(suite.attrib[name]) for suite in suites))
        for name in ("tests", "failures", "errors")
    }


def clean(text: str) -> str:
    """The text without what XML can't hold."""
    return FORBIDDEN.sub("�", text)
