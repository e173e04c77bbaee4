"""`specc compare` at the edge: what it prints, writes and returns."""

import json
from pathlib import Path

import pytest

from specc.cli.app import run

SPECS = Path(__file__).parents[2] / "specs"


@pytest.fixture
def shifted(tmp_path: Path) -> Path:
    """Van der Pol's oscillator with its place of rest elsewhere."""
    text = (SPECS / "van_der_pol.yaml").read_text(encoding="utf-8")
    path = tmp_path / "shifted.yaml"
    path.write_text(text.replace("*v - x\n", "*v - x + 0.6\n"), encoding="utf-8")
    assert path.read_text(encoding="utf-8") != text
    return path


def test_compare_says_what_moved_and_draws_it(
    shifted: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    picture = tmp_path / "difference.svg"
    wanted = str(SPECS / "van_der_pol.yaml")

    status = run(["compare", str(shifted), wanted, "-o", str(picture)])

    assert status == 1
    assert "moved: unstable focus at x = 0.6" in capsys.readouterr().out
    assert picture.read_bytes().startswith(b"<?xml")


def test_compare_returns_zero_and_json_where_all_is_the_same(
    capsys: pytest.CaptureFixture[str],
) -> None:
    wanted = str(SPECS / "van_der_pol.yaml")

    assert run(["compare", wanted, wanted, "--format", "json"]) == 0
    assert json.loads(capsys.readouterr().out)["adheres"] is True


def test_compare_refuses_behaviors_over_other_states(
    capsys: pytest.CaptureFixture[str],
) -> None:
    status = run(["compare", str(SPECS / "van_der_pol.yaml"), str(SPECS / "pendulum.yaml")])

    assert status == 2
    assert "error[V361]" in capsys.readouterr().err
