"""Arbiters from their files."""

from pathlib import Path

import pytest

from compiler.architecture.arbiters import compile_arbiter
from compiler.check import check
from runtime.arbiter import Paradigm
from spec_schema.diagnostics import SpecError

PARTS = Path(__file__).parents[2] / "golden" / "bad" / "parts"
HEAD = (
    "specc: 1\nkind: arbiter\nname: tried\nreads: {ahead: {unit: m, domain: [0, 2]}, "
    "door: {kind: discrete, values: [open, shut]}}\n"
    "constants: {near: {value: 30 cm, unit: m}}\nchoices: [flee, go]\n"
)


def write(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "tried.yaml"
    path.write_text(HEAD + text, encoding="utf-8")
    return path


def test_rules_keep_their_conditions_hysteresis_and_times() -> None:
    arbiter = compile_arbiter(PARTS / "safe_first.yaml").arbiter
    flee, go = arbiter.rules

    assert arbiter.paradigm is Paradigm.RULES
    assert (flee.choice, go.choice) == (0, 1)
    assert flee.when is not None
    assert flee.when.text == "ahead near lt"
    assert flee.until is not None
    assert flee.until.text == "ahead near margin add gt"
    assert flee.lasts == pytest.approx(0.5)
    assert go.when is None
    assert arbiter.register == ("ahead", "near", "margin")


def test_values_by_name_become_their_index(tmp_path: Path) -> None:
    path = write(tmp_path, "by: {rules: [{choose: flee, when: door == 'shut'}, {choose: go}]}\n")

    when = compile_arbiter(path).arbiter.rules[0].when

    assert when is not None
    assert when.text == "door 1 eq"


def test_weights_come_in_the_order_of_the_choices(tmp_path: Path) -> None:
    path = write(tmp_path, 'by: {weights: {go: "1", flee: exp(-ahead / near)}}\n')

    assert [code.text[-3:] for code in compile_arbiter(path).arbiter.weights] == ["exp", "1"]


def test_suppression_stands_in_the_row_of_who_suppresses(tmp_path: Path) -> None:
    text = 'by: {competition: {advantage: {flee: "0.5", go: "1"}, suppresses: {go: {flee: 2}}}}\n'
    found = compile_arbiter(write(tmp_path, text)).arbiter.competition

    assert found is not None
    rows = [[float(code.text) for code in row] for row in found.suppression]
    assert rows == [[0, 0], [2, 0]]
    assert found.time == pytest.approx(0.1)


def test_the_choice_stands_in_a_log_by_its_names(tmp_path: Path) -> None:
    text = "by: {rules: [{choose: flee, when: ahead < near}, {choose: go}]}\n"
    text += "trace: {ahead: front, choice: {path: action, values: {RUN: flee, Go: go}}, hand: h}\n"
    text += "judge_when: not hand\n"
    arbiter = compile_arbiter(write(tmp_path, text)).arbiter
    choice = next(one for one in arbiter.bindings if one.name == "choice")

    assert choice.values == (("RUN", 0), ("Go", 1))
    assert arbiter.judge_when is not None


def test_a_plans_choices_come_in_the_order_of_its_modes(tmp_path: Path) -> None:
    (tmp_path / "plan.yaml").write_text(
        "specc: 1\nkind: behavior\nname: plan\nstate:\n"
        "  ahead: {unit: m, domain: [0, 2], role: sensed, relates: {agent: a, environment: b}}\n"
        "  eager: {unit: m, domain: [0, 2], role: driven, relates: {agent: a, environment: b}}\n"
        "  doing: {kind: discrete, values: [go, flee], role: both, "
        "relates: {agent: a, environment: b}}\n"
        "constants: {near: {value: 0.3, unit: m}, far: {value: 1, unit: m}, "
        "k: {value: 1, unit: 1/s}}\n"
        "field: {modes: {of: doing, each: {"
        "go: {formula: {eager: k*ahead}, leave: [{when: ahead <= near, to: flee}]}, "
        "flee: {formula: {eager: -k*ahead}, leave: [{when: ahead >= far, to: go}]}}}}\n",
        encoding="utf-8",
    )
    arbiter = compile_arbiter(write(tmp_path, "by: {plan: plan.yaml}\n")).arbiter

    assert arbiter.choices == ("go", "flee")
    assert arbiter.plan is not None


@pytest.mark.parametrize(
    ("by", "code"),
    [
        ("{rules: [{choose: fle}]}", "S323"),
        ("{rules: [{choose: flee, when: aheda < near}, {choose: go}]}", "S139"),
        ("{rules: [{choose: flee, when: ahead < 1}, {choose: go}]}", "S141"),
        ("{rules: [{choose: flee, when: ahead, lasts: 1 s}, {choose: go}]}", "S211"),
        ("{rules: [{choose: flee, lasts: -1 s}, {choose: go}]}", "S212"),
        ("{weights: {flee: ahead / near}}", "S323"),
        ("{plan: nowhere.yaml}", "S320"),
    ],
)
def test_a_mistake_is_told(tmp_path: Path, by: str, code: str) -> None:
    path = write(tmp_path, f"by: {by}\n")

    assert code in {found.code for found in check(path)}
    with pytest.raises(SpecError):
        compile_arbiter(path)
