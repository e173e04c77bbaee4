"""What is not finite at the ends of a domain is told by `check`, before any table is made."""

import math
from pathlib import Path

import pytest

from compiler.check import check
from compiler.compile_file import compile_file
from spec_schema.diagnostics import SpecError

SPEC = """specc: 1
kind: behavior
name: tried
state:
  x:
    unit: m
    domain: [{low}, 1]
    role: both
    relates: {{agent: center of the base, environment: the goal}}
  y:
    unit: m
    domain: [0, 1]
    role: sensed
    relates: {{agent: center of the base, environment: the wall}}
control:
  k: {{unit: 1/s, domain: [1, 2], default: 1}}
constants:
  m: {{value: 1, unit: m}}
field:
  formula:
    x: "{rate}"
{more}
"""
PLACES = {
    "k * sqrt(x / m) * m": "x = -1",
    "k * m * m / (x + m)": "x = -1",
    "k * m * m / x": "x = 0",
    "k * m * log(y / m)": "y = 0",
    "k * m * m / (x + y)": "x = -1, y = 1",
}


def told(path: Path, rate: str, low: float = -1.0, more: str = "") -> list[str]:
    path.write_text(SPEC.format(rate=rate, low=low, more=more), encoding="utf-8")
    return [found.message for found in check(path) if found.code == "S243"]


@pytest.mark.parametrize("rate", PLACES)
def test_check_tells_where_a_formula_is_not_finite_as_compile_does(
    rate: str, tmp_path: Path
) -> None:
    path = tmp_path / "tried.yaml"

    assert told(path, rate) == [f"the field is not finite at {PLACES[rate]} (SI units)"]
    with pytest.raises(SpecError) as refused:
        compile_file(path, lambda _what, _done, _of: None)
    assert [each.code for each in refused.value.diagnostics] == ["S243"]


@pytest.mark.parametrize("rate", PLACES)
def test_guarded_or_kept_as_code_it_is_no_mistake(rate: str, tmp_path: Path) -> None:
    path = tmp_path / "tried.yaml"
    guarded = rate.replace("x", "(x + 2 * m)").replace("y", "(y + m)")

    assert not told(path, guarded, low=0.1)
    assert not told(path, rate, more="table: {keep: code}")


def test_a_domain_that_leaves_the_place_out_is_sound(tmp_path: Path) -> None:
    assert not told(tmp_path / "tried.yaml", "k * m * m / x", low=math.exp(-3))
