"""Python of the user's own: imported as any module is, and gone without a trace if it can't be."""

import sys
from pathlib import Path

import pytest

from runtime.user_code import UserCodeError, load_callee, load_module

MOOD = """
from __future__ import annotations

import dataclasses
from typing import ClassVar


@dataclasses.dataclass
class Mood:
    high: ClassVar[float] = 2.0
    level: float = 1.0


def level() -> float:
    return Mood().level
"""


def test_a_module_with_dataclasses_whose_annotations_are_text_is_imported(tmp_path: Path) -> None:
    (tmp_path / "moods.py").write_text(MOOD)

    assert load_callee("moods:level", tmp_path)() == 1.0


def test_a_module_is_read_anew_each_time(tmp_path: Path) -> None:
    (tmp_path / "moods.py").write_text("LEVEL = 1\n")
    first = load_module("moods", tmp_path)
    (tmp_path / "moods.py").write_text("LEVEL = 22\n")

    assert (first.LEVEL, load_module("moods", tmp_path).LEVEL) == (1, 22)


def test_a_module_that_fails_leaves_nothing_behind(tmp_path: Path) -> None:
    (tmp_path / "broken.py").write_text("raise ValueError('no')\n")
    before = set(sys.modules)

    with pytest.raises(UserCodeError, match="ValueError: no"):
        load_callee("broken:level", tmp_path)

    assert set(sys.modules) == before
