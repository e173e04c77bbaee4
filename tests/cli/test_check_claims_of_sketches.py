"""`specc check --claims` of a sketch whose author claims nothing beside it."""

from pathlib import Path

import pytest

from specc.cli import main

SKETCH = """
specc: 1
kind: behavior
name: rest
state:
  x: {unit: m, domain: [-2, 2], role: both, relates: {agent: base, environment: mark}}
  y: {unit: m, domain: [-2, 2], role: both, relates: {agent: base, environment: mark}}
field:
  sketch:
    over: [x, y]
    points:
      - {name: home, is: attractor, at: [0.5, 0]}
"""


def test_a_sketch_without_expect_is_held_to_what_it_draws(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("rest.yaml").write_text(SKETCH, encoding="utf-8")

    assert main(["check", "--claims", "rest.yaml"]) == 0
    told = capsys.readouterr()
    assert "(home)" in told.out
    assert "3 claims" in told.err
