"""An arbiter's rules in words."""

from pathlib import Path

from compiler.architecture.arbiters import compile_arbiter
from runtime.arbiter import Arbiter
from specc.texts.arbiters import arbiter_sentences, arbiter_summary, rule_sentences

ROOT = Path(__file__).parents[2]
HEAD = """specc: 1
kind: arbiter
name: tried
reads:
  ahead: {unit: cm, domain: [0, 200]}
  used: {unit: "1", domain: [0, 1]}
  lamp: {kind: discrete, values: [hidden, shown]}
  door: {kind: discrete, values: [open, ajar, shut]}
constants:
  near: {value: 30, unit: cm}
  far: {value: 1.1, unit: m}
choices: [avoid, dock, look]
by:
  rules:
"""


def tried(folder: Path, *rules: str) -> Arbiter:
    """The arbiter with these rules."""
    path = folder / "tried.yaml"
    lines = "".join(f"    - {{{rule}}}\n" for rule in rules)
    path.write_text(HEAD + lines, encoding="utf-8")
    return compile_arbiter(path).arbiter


def test_a_rule_is_a_sentence_in_the_units_of_what_it_reads(tmp_path: Path) -> None:
    arbiter = tried(
        tmp_path,
        "choose: avoid, when: ahead < near and lamp == 'shown'",
        "choose: dock, when: 'ahead >= near and ahead <= far and door != \"shut\"'",
        "choose: look",
    )

    assert arbiter_sentences(arbiter) == (
        "rule 1: avoid, where ahead < near (30 cm) and lamp is shown",
        "rule 2: dock, where near (30 cm) <= ahead <= far (1.1 m) and door is not shut",
        "rule 3: look, otherwise",
    )


def test_rules_of_one_choice_stand_together_and_what_is_left_comes_last(tmp_path: Path) -> None:
    arbiter = tried(
        tmp_path,
        "choose: look, when: used > 0.9",
        "choose: avoid, when: ahead < near",
        "choose: look, when: used > 0.5",
        "choose: look",
    )

    assert [each.partition(":")[0] for each in arbiter_sentences(arbiter)] == [
        "rule 1",
        "rule 3",
        "rule 2",
        "rule 4",
        "dock, never",
    ]


def test_what_no_earlier_rule_says_already_is_not_said_again(tmp_path: Path) -> None:
    arbiter = tried(
        tmp_path,
        "choose: avoid, when: ahead < near",
        "choose: dock, when: ahead >= near and used > 0.5",
        "choose: look, when: used <= 0.5 and ahead > near",
        "choose: avoid",
    )

    found = rule_sentences(arbiter)
    assert found[1].sentence == "dock, where used > 0.5"
    assert found[1].is_shorter
    assert found[2].sentence == "look, where ahead > near (30 cm)", "at 30 cm rule 4 decides"


def test_a_rule_that_latches_keeps_all_that_it_says(tmp_path: Path) -> None:
    arbiter = tried(
        tmp_path,
        "choose: avoid, when: ahead < near",
        "choose: dock, when: ahead >= near and used > 0.5, until: used < 0.1, lasts: 2 s",
        "choose: look",
    )

    assert rule_sentences(arbiter)[1].sentence == (
        "dock, where ahead >= near (30 cm) and used > 0.5; once begun, until used < 0.1; "
        "for 2 s at least"
    )


def test_a_rule_that_earlier_rules_cover_is_said_never_to_decide(tmp_path: Path) -> None:
    arbiter = tried(
        tmp_path,
        "choose: avoid, when: ahead < near",
        "choose: look, when: used > 0.2",
        "choose: dock, when: ahead < near and used < 0.1 or used > 0.3",
        "choose: look",
    )

    assert not rule_sentences(arbiter)[2].decides
    assert arbiter_sentences(arbiter)[-1] == "dock, never"


def test_the_numbers_are_those_of_the_controls_as_they_are_set() -> None:
    arbiter = compile_arbiter(ROOT / "specs/arbiters/safe_first.yaml").arbiter

    assert "ahead < near (0.19 m)" in arbiter_summary(arbiter)
    assert "until ahead > near + margin (0.62 m)" in arbiter_summary(arbiter, {"near": 0.6})


def test_learned_rules_without_any_name_are_told_in_units_and_by_values(tmp_path: Path) -> None:
    path = tmp_path / "learned.yaml"
    head = HEAD[: HEAD.index("constants:")]
    path.write_text(
        f"""{head}choices: [look, avoid, dock]
by:
  alcsr:
    otherwise: look
    rules:
      - {{choose: avoid, when: "ahead < 0.31 and used > 0.2"}}
      - {{choose: dock, when: "ahead >= 0.31 and used > 0.2 and lamp == 'shown'"}}
""",
        encoding="utf-8",
    )

    assert arbiter_sentences(compile_arbiter(path).arbiter) == (
        "rule 1: avoid, where ahead < 31 cm and used > 0.2",
        "rule 2: dock, where used > 0.2 and lamp is shown",
        "rule 3: look, otherwise",
    )
