"""Experiments that are done, for tests of what they leave and of going on with them."""

from pathlib import Path

import pytest

from specc.cli import main


@pytest.fixture(scope="session")
def kept(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of an experiment of two runs of 1,000 cycles, seeds 0 and 1; copy it to write."""
    folder = tmp_path_factory.mktemp("kept") / "out"
    asked = ["learn", "checkerboard_3x3", "--cycles", "1000", "--tests", "500", "--runs", "2"]
    assert main([*asked, "-o", str(folder)]) == 0
    return folder


@pytest.fixture(scope="session")
def walked(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a run of 60 episodes in a world; copy it to write."""
    folder = tmp_path_factory.mktemp("walked") / "out"
    asked = ["learn", "gridworld", "--episodes", "60", "--tests", "50"]
    asked += ["--set", "first=800", "--set", "families=2"]
    assert main([*asked, "-o", str(folder)]) == 0
    return folder
