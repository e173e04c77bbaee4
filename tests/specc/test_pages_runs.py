"""Many recordings: which of them failed, and why, is seen at a glance; sentences in a page."""

from dataclasses import replace
from typing import cast

import pytest

from runtime.program import Program
from spec_schema.diagnostics import Diagnostic, Severity, SpecError
from spec_schema.source import Source
from specc.pages.prose import prose
from specc.pages.runs_page import gathered_runs, top_advice, top_reasons
from specc.texts.runs import runs_table
from specc.verifying.runs import Pool, Runs, Unusable
from specc.verifying.spec_finding import Found
from specc.verifying.trace import Verification
from tests.specc.examination_scenes import diagnosis, examination, passed, switching
from verifier.fidelity.verify import Judgement
from verifier.report.advice import advised
from verifier.report.diagnosis import CandidateKind, Told
from verifier.report.examination import Examination
from verifier.report.report import Standing, Verdict
from verifier.report.why import why

NOBODY = Found(cast("Program", None), "")


def verification(made: Examination, source: str) -> Verification:
    report = replace(made.report, trace=replace(made.report.trace, source=source))
    judgement = Judgement(report, None, None, None)
    return Verification(NOBODY, replace(made, report=report), judgement)


@pytest.fixture(scope="module")
def runs() -> Runs:
    """A PASS, a FAIL, one that can't be read, and the first two together: INCONCLUSIVE."""
    good = verification(passed(), "good.mcap")
    bad = verification(examination(), "bad.mcap")
    source = Source("torn.mcap", "")
    why_not = Diagnostic("V302", Severity.ERROR, "this is no log that specc knows", source, None)
    open_one = verification(examination(Verdict.INCONCLUSIVE), "2 recordings together")
    return Runs(
        (good, Unusable("torn.mcap", SpecError([why_not])), bad),
        (Pool((good, bad), open_one.examination),),
    )


def test_the_text_tells_first_which_recording_fails_and_why(runs: Runs) -> None:
    text = runs_table(runs)

    after = text[text.index("\nwhy\n") :]
    order = [
        "bad.mcap, FAIL: heading departs",
        "torn.mcap can't be used: this is no log",
        "FAIL  3",
    ]
    assert [after.index(part) for part in order] == sorted(after.index(part) for part in order)


def test_a_table_says_where_the_planted_faults_stand_that_it_has_no_room_for(runs: Runs) -> None:
    text = runs_table(runs)

    told = text.index("which faults a PASS would have caught: `--format json`")
    assert text.index("torn.mcap") < told < text.index("\nwhy\n")
    assert "which faults" not in runs_table(Runs(runs.outcomes[1:2], ()))


def test_where_one_recording_fails_no_more_data_is_asked_for(runs: Runs) -> None:
    advice = runs.pools[0].report.advice[0]
    good = runs.pools[0].members[0]

    assert advice not in runs_table(runs)
    assert top_advice(runs) == ()
    open_runs = Runs(runs.outcomes[:1], (replace(runs.pools[0], members=(good, good)),))
    assert advice in runs_table(open_runs)
    assert advice in top_advice(open_runs)


def test_the_page_tells_of_whom_each_reason_is(runs: Runs) -> None:
    reasons = top_reasons(runs)

    assert reasons[0].startswith("bad.mcap, FAIL: ")
    assert reasons[1].startswith("torn.mcap can't be used: ")
    assert all(r.startswith("2 recordings together, INCONCLUSIVE: ") for r in reasons[2:])


def test_what_passes_together_stands_not_among_the_reasons_of_a_failure(runs: Runs) -> None:
    good = verification(passed(), "2 recordings together").examination
    pools = (replace(runs.pools[0], examination=good),)

    assert not any("PASS" in each for each in top_reasons(replace(runs, pools=pools)))
    assert any("PASS" in each for each in top_reasons(Runs(runs.outcomes[:1], pools)))


def test_who_is_left_out_of_a_node_that_passes_is_told_below_the_nodes() -> None:
    left = "a.mcap: r.seek is left out: it never had its way"
    both = tuple(
        replace(verification(passed(), f"{name}.mcap: r.seek"), part="r.seek") for name in "ab"
    )
    of_one = verification(passed(), "1 recording: r.seek").examination
    report = replace(of_one.report, reasons=(*of_one.report.reasons, left))
    made = Runs(both, (Pool(both, replace(of_one, report=report)),))

    assert "- r.seek: a.mcap is left out: it never had its way" in runs_table(made)
    titles = [table.title for table in gathered_runs(made).tables]
    assert titles == ["Nodes, of all recordings together", "Nodes, of each recording by itself"]
    assert "a.mcap is left out" in gathered_runs(made).tables[0].how


# --- what to do next


def test_numbers_of_the_spec_that_explain_a_failure_are_the_first_advice() -> None:
    made = examination()
    named = diagnosis()
    one = replace(named.candidates[0], kind=CandidateKind.PARAMETER, label="v1", is_taken=True)
    same = replace(named, told=Told.SAME_STRUCTURE, candidates=(one,))

    found = advised(made.report, same, None)

    assert "the spec has to say v1 = " in found.advice[0]
    assert f"specc fit {made.report.trace.source} --spec {made.report.spec.file}" in found.advice[0]
    assert found.advice[1:] == made.report.advice


def test_a_pass_and_a_trace_without_figures_keep_their_advice() -> None:
    good = passed()
    for report in (good.report, replace(examination().report, variables=())):
        assert advised(report, diagnosis(), None) == report


def test_late_changes_of_mode_are_no_absence_of_a_difference() -> None:
    nothing = replace(diagnosis(), told=Told.NO_DIFFERENCE)
    late = replace(switching(), standing=Standing.EXCEEDED)

    assert why(nothing, late)[0] == f"the changes of {late.mode}"
    assert why(nothing, replace(late, standing=Standing.WITHIN))[0] == "no difference"
    assert why(nothing, None)[0] == "no difference"


# --- sentences in a page


@pytest.mark.parametrize(
    ("text", "page"),
    [
        ("x ends at -0.5 m", "x ends at −0.5 m"),
        ("(-1 to -.5)", "(−1 to −.5)"),
        ("from 2026-11-22, run-3.mcap, 1e-09", "from 2026-11-22, run-3.mcap, 1e-09"),
        (
            "write `offset: -1 m` in `trace:`",
            "write <code>offset: -1 m</code> in <code>trace:</code>",
        ),
        ("a <b> & `<i>`", "a &lt;b&gt; &amp; <code>&lt;i&gt;</code>"),
        ("a lone ` stays", "a lone ` stays"),
        ("95 % and 1 ± 2", "95\u00a0% and 1\u00a0±\u00a02"),
    ],
)
def test_sentences_get_minus_signs_and_code_and_stay_text(text: str, page: str) -> None:
    assert str(prose(text)) == page
