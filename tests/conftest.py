"""Fixtures for all tests: golden files."""

from collections.abc import Callable
from pathlib import Path
from typing import TypeAlias

import pytest

Expect: TypeAlias = Callable[[Path, str], None]


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--bless", action="store_true", help="rewrite expected files from what came out"
    )


@pytest.fixture
def expect(request: pytest.FixtureRequest) -> Expect:
    """Compare text with a golden file; `pytest --bless` rewrites the file."""

    def check(golden: Path, actual: str) -> None:
        if request.config.getoption("--bless"):
            golden.write_text(actual, encoding="utf-8")
        assert golden.exists(), f"{golden.name} is missing: look at the output, then pytest --bless"
        assert golden.read_text(encoding="utf-8") == actual

    return check
