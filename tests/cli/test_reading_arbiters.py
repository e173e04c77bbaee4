"""Arbiters as a user reads them: portraits and explanations, as text, as pictures, as JSON."""

import json
from pathlib import Path

import numpy as np
import pytest

from specc.cli import main
from specc.explaining import cropped, explain
from specc.figures.decision_strip import draw_strip
from specc.figures.decisions import draw_decisions
from specc.figures.style_names import Style
from specc.portraying_arbiters import arbiter_portrait, arbiter_sweep

SPECS = Path(__file__).parents[2] / "specs"
ARBITERS = SPECS / "arbiters"
KEEP_LEFT = ARBITERS / "keep_left_arbiter.yaml"
LOG = SPECS / "recordings" / "scitos" / "wall_following.csv"


def out_of(capsys: pytest.CaptureFixture[str], *arguments: str | Path) -> str:
    """What a command prints that succeeds."""
    assert main([str(each) for each in arguments]) == 0
    return capsys.readouterr().out


def told(capsys: pytest.CaptureFixture[str], *arguments: str | Path) -> str:
    """What is said of bad input."""
    assert main([str(each) for each in arguments]) == 2
    return capsys.readouterr().err


def texts(figure: object) -> list[str]:
    """All words on a figure's axes."""
    axes = getattr(figure, "axes", [])
    return [text.get_text() for each in axes for text in each.texts]


def test_a_portrait_has_the_boundaries_of_the_spec(capsys: pytest.CaptureFixture[str]) -> None:
    record = json.loads(out_of(capsys, "portrait", KEEP_LEFT, "--format", "json"))

    assert record["exact"]
    assert [ruling["rules"] for ruling in record["rulings"]] == [[1], [2], [3], [4]]
    ends = {tuple(p) for border in record["borders"] for p in border["points"]}
    assert {(0.9, 0.0), (0.9, 0.9), (5.0, 0.9), (0.9, 0.4945), (5.0, 0.4945)} <= {
        (round(x, 9), round(y, 9)) for x, y in ends
    }


@pytest.mark.parametrize("style", list(Style))
def test_each_area_is_labelled_with_choice_and_rule(style: Style) -> None:
    figure = draw_decisions(arbiter_portrait(KEEP_LEFT), style)

    words = " ".join(texts(figure)).replace("\n", " ")
    for label in ("sharp_right rule 1", "slight_left rule 2", "slight_right rule 3"):
        assert label in words
    assert "0.4945 m" in words


def test_the_reads_that_matter_most_are_drawn_and_said_why(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    who_goes = ARBITERS / "who_goes.yaml"
    text = out_of(capsys, "portrait", who_goes, "--at", "goal=1", "-o", tmp_path / "x.svg")

    assert text.startswith("who_goes over ahead, right, at left = 1 m, goal = 1, near = 0.2 m\n")
    assert "these matter most: another value of it alone changes what is decided" in text
    assert "turn_away (rule 1) if it held already, else go (rule 2)" in text


def test_a_sweep_over_a_discrete_read_has_a_panel_for_each_value() -> None:
    found = arbiter_sweep(ARBITERS / "layers_of_patrol.yaml", "charger", "hidden,shown")
    figure = draw_decisions(found)

    assert [axes.get_title(loc="left") for axes in figure.axes] == [
        "charger = hidden",
        "charger = shown",
    ]
    shares = [
        sum(p.plane.share_of(k) for k, r in enumerate(p.plane.rulings) if 1 in r.choices)
        for p in found.portraits
    ]
    assert shares[0] == 0.0 < shares[1]


def test_a_recording_of_a_robot_is_explained(capsys: pytest.CaptureFixture[str]) -> None:
    """What is said of one decision is in the log: 0.494 m to the left, and 1.334 m ahead."""
    text = out_of(capsys, "explain", LOG, "--spec", KEEP_LEFT, "--at", "26.2s")

    assert text.splitlines() == [
        "keep_left_arbiter at 26.111 s: slight_right",
        "  rule 3: slight_right, where left < near (0.4945 m)",
        "  because left is 0.494 m",
        "  front  1.33 m   0.435 m above the boundary to sharp_right (0.9 m)",
        "  left   0.494 m  0.5 mm below the boundary to forward (0.4945 m)",
    ]


def test_how_often_each_was_chosen_is_told_as_the_recording_has_it(
    capsys: pytest.CaptureFixture[str],
) -> None:
    """The counts of its classes are those that were published with it (Freire et al., 2010)."""
    published = {"forward": 2205, "sharp_right": 2097, "slight_right": 826, "slight_left": 328}
    (record,) = json.loads(out_of(capsys, "explain", LOG, "--spec", KEEP_LEFT, "--format", "json"))

    found = {each["choice"]: each["share"] * record["decisions"] for each in record["shares"]}
    assert found == pytest.approx(published)
    assert list(found) == list(published), "that with most decisions comes first"
    assert [each["rules"] for each in record["shares"]] == [[4], [1], [3], [2]]
    assert sum(each["stretches"] for each in record["shares"]) == len(record["stretches"])
    text = out_of(capsys, "explain", LOG, "--spec", KEEP_LEFT)
    assert "\n  sharp_right   39 %       137        1\n" in text


def test_an_arbiter_that_reads_nothing_is_explained(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    run = tmp_path / "run.mcap"
    scenario = SPECS / "scenarios" / "light_random.yaml"
    assert main(["simulate", str(scenario), "-d", "1 s", "-o", str(run)]) in {0, 1, 4}

    capsys.readouterr()
    told = out_of(capsys, "explain", run)
    assert "by a competition of its choices" in told
    assert "  by rule" not in told


def test_stretches_follow_one_another_and_hold_all_decisions() -> None:
    (found,) = explain(LOG, KEEP_LEFT)

    assert sum(each.decisions for each in found.stretches) == 5456
    assert all(each.agrees for each in found.stretches)
    for one, following in zip(found.stretches, found.stretches[1:], strict=False):
        assert (one.end, one.last + 1) == (following.start, following.first)
        assert (one.chosen, one.place) != (following.chosen, following.place)
    assert found.margins is not None
    assert np.isfinite(found.margins.share.min(axis=1)).all()


def test_where_robot_and_spec_differ_it_is_marked(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    wrong = tmp_path / "wrong.yaml"
    spec = KEEP_LEFT.read_text(encoding="utf-8").replace("0.4945", "0.55")
    wrong.write_text(spec, encoding="utf-8")

    text = out_of(capsys, "explain", LOG, "--spec", wrong, "--from", "20", "--to", "60")
    assert "(376 differ)" in text
    assert "26.222 to 27.444 s: DIFFERS: the robot chose forward, the spec slight_right" in text
    (found,) = explain(LOG, wrong)
    figure = draw_strip(cropped(found, 20.0, 60.0))
    assert [axes.get_ylabel() for axes in figure.axes][:2] == ["robot", "spec"]


@pytest.mark.parametrize(
    ("arguments", "code", "help_"),
    [
        (["portrait", ARBITERS / "mission_of_light.yaml"], "V421", "draw the plan"),
        (["portrait", ARBITERS / "coin.yaml"], "V421", "specc explain"),
        (["portrait", KEEP_LEFT, "--axes", "front,lef"], "V422", "did you mean 'left'?"),
        (["portrait", KEEP_LEFT, "--axes", "left,left"], "V422", "--axes X,Y"),
        (["portrait", KEEP_LEFT, "--at", "left=7"], "V342", "left=5"),
        (["explain", LOG], "V423", "--spec ARBITER.yaml"),
        (["explain", LOG, "--spec", KEEP_LEFT, "--at", "9999"], "V424", "0 to 606.111 s"),
        (["explain", LOG, "--spec", KEEP_LEFT, "--at", "noon"], "V342", "write 12.3"),
    ],
)
def test_what_can_not_be_read_is_said_with_what_to_write(
    arguments: list[str | Path],
    code: str,
    help_: str,
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    if arguments[0] == "portrait":
        monkeypatch.chdir(tmp_path)
    text = told(capsys, *arguments)

    assert f"error[{code}]" in text
    assert help_ in text
