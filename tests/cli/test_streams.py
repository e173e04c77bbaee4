"""A reader who leaves takes nothing from the verdict, and is shown no traceback."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from specc.cli import main

ROOT = Path(__file__).parents[2]
VDP = str(ROOT / "specs" / "van_der_pol.yaml")
COMMAND = (sys.executable, "-c", "from specc.cli import entry; entry()")

pytestmark = pytest.mark.skipif(os.name != "posix", reason="pipes as POSIX has them")


def unread(*arguments: str, stderr: int = subprocess.PIPE) -> tuple[int, str]:
    """Status and messages of the command when nobody reads what it prints."""
    reader, writer = os.pipe()
    os.close(reader)
    try:
        run = subprocess.run(
            [*COMMAND, *arguments], stdout=writer, stderr=stderr, text=True, check=False
        )
    finally:
        os.close(writer)
    return run.returncode, run.stderr or ""


def test_the_verdict_is_the_status_and_its_report_is_written(tmp_path: Path) -> None:
    log, report = tmp_path / "run.csv", tmp_path / "report.json"
    main(["simulate", VDP, "--start", "x=1", "-d", "40", "-o", str(log)])

    status, told = unread("verify", str(log), "--spec", VDP, "--quick", "-o", str(report))

    assert json.loads(report.read_text())["verdict"] == "pass"
    assert status == 0
    assert "Traceback" not in told


@pytest.mark.parametrize("arguments", [["--help"], ["schema", "behavior"], ["init", "--list"]])
def test_what_is_printed_to_nobody_is_printed(arguments: list[str]) -> None:
    assert unread(*arguments) == (0, "")


def test_mistakes_are_mistakes_though_nobody_hears_of_them() -> None:
    assert unread("check", "nowhere.yaml", stderr=subprocess.STDOUT)[0] == 2


def test_streams_that_are_closed_from_the_start_are_no_bug() -> None:
    command = "import os, sys; os.close(1); os.close(2); os.execv(sys.argv[1], sys.argv[1:])"
    run = subprocess.run([sys.executable, "-c", command, *COMMAND, "init", "--list"], check=False)

    assert run.returncode == 0
