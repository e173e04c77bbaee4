"""Fixtures for all tests: golden files. And one thread for each of them."""

import os
from collections.abc import Callable
from pathlib import Path
from typing import TypeAlias

import pytest
from hypothesis import HealthCheck, settings

# Before numpy is loaded: on small matrices threads of BLAS only wait for one another.
for _name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_name, "1")

# A busy machine draws slowly, too: that says nothing about the code.
settings.register_profile(
    "any machine", suppress_health_check=[HealthCheck.too_slow], deadline=None
)
settings.load_profile("any machine")

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
