"""Ctrl-C ends a command at once, with 130 and a sentence; and what can't be printed is told."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any, NoReturn

import pytest

import specc.loading
from specc.cli import main
from specc.cli.interrupts import INTERRUPTED, PATIENCE
from verifier.topology.claims import judge

ROOT = Path(__file__).parents[2]
VDP = str(ROOT / "specs" / "van_der_pol.yaml")
HEARING = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler)\n"
COMMAND = "from specc.cli import entry; entry()"

pytestmark = pytest.mark.skipif(os.name != "posix", reason="signals as POSIX has them")


def started(*arguments: str, code: str = COMMAND) -> "subprocess.Popen[str]":
    """The command in a process of its own, in which Ctrl-C is not ignored."""
    return subprocess.Popen(
        [sys.executable, "-c", HEARING + code, *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def test_ctrl_c_acts_while_a_kernel_runs_for_seconds() -> None:
    run = started("simulate", VDP, "-d", "1e9", "--format", "json")
    time.sleep(2.0)

    begun = time.monotonic()
    run.send_signal(signal.SIGINT)
    out, err = run.communicate(timeout=30)

    assert time.monotonic() - begun < PATIENCE + 2.0
    assert (run.returncode, out, err) == (130, "", INTERRUPTED)


def test_ctrl_c_while_libraries_are_loaded_is_no_traceback() -> None:
    code = (
        "import builtins, os, signal\n"
        "load = builtins.__import__\n"
        "def hook(name, *rest):\n"
        "    if name == 'typer': os.kill(os.getpid(), signal.SIGINT)\n"
        "    return load(name, *rest)\n"
        "builtins.__import__ = hook\n"
    )
    run = started("check", VDP, code=code + COMMAND)

    out, err = run.communicate(timeout=30)

    assert (run.returncode, out, err) == (130, "", INTERRUPTED)


def test_ctrl_c_after_the_last_output_changes_nothing() -> None:
    code = (
        "import atexit, os, signal\natexit.register(lambda: os.kill(os.getpid(), signal.SIGINT))\n"
    )
    run = started("--version", code=code + COMMAND)

    out, err = run.communicate(timeout=30)

    assert run.returncode == 0
    assert out.startswith("specc ")
    assert err == ""


@pytest.mark.parametrize("command", [["portrait"], ["compile"], ["simulate"], ["compare", VDP]])
def test_every_command_hands_ctrl_c_on_to_where_it_is_told(
    command: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def impatient(*_arguments: Any, **_named: Any) -> NoReturn:
        raise KeyboardInterrupt

    monkeypatch.setattr(specc.loading, "compile_spec", impatient)

    with pytest.raises(KeyboardInterrupt):
        main([*command, VDP])


def test_claims_of_which_none_was_judged_are_not_called_none(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def impatient(*_arguments: Any, **_named: Any) -> NoReturn:
        raise KeyboardInterrupt

    monkeypatch.setattr(judge, "_judged_at", impatient)
    monkeypatch.setattr(specc.loading, "load_program", impatient)

    assert main(["check", "--claims", str(ROOT / "specs" / "patrol.yaml")]) == 130
    out, err = capsys.readouterr()
    assert out == ""
    assert err.splitlines() == ["interrupted; 3 claims were not judged"]


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="a device of Linux")
@pytest.mark.parametrize("arguments", [["schema", "behavior"], ["--version"]])
def test_output_that_can_not_be_written_is_told(arguments: list[str]) -> None:
    with Path("/dev/full").open("w", encoding="utf-8") as full:
        run = subprocess.run(
            [sys.executable, "-c", COMMAND, *arguments],
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )

    assert run.returncode == 2
    assert run.stderr == "standard output can't be written: no space left on device\n"
