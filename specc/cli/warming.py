"""The kernels are compiled once per installation; the user is told, and sees it progress."""

from collections.abc import Callable
from pathlib import Path

from specc.cli.console import progress_bar, say
from specc.cli.interrupts import at_once


def warmed(spec: Path | None) -> None:
    """Compile the kernels now if this installation has not done so yet.

    The spec's own mistakes come first: nobody waits half a minute to be told of a typing error.

    Raises:
        SpecError: the spec has mistakes.
    """
    from runtime.warm import is_warm, warm

    if is_warm():
        return
    if spec is not None and spec.suffix != ".specc":
        _refuse_mistakes(spec)
    say("first use: compiling specc's numerical kernels, about half a minute, once", "bold")
    with progress_bar("kernels") as progress:
        warm(progress)


def warmed_learner(name: str) -> None:
    """Compile the kernels of a learner now if this installation has not done so yet."""
    from specc.learning.warming import is_warm, warm

    if not is_warm(name):
        _compile(name, warm)


def warmed_policies(name: str) -> None:
    """Compile the kernels of a learner of policies now if this installation has not done so yet."""
    from specc.training.warming import is_warm, warm

    if not is_warm(name):
        _compile(name, warm)


def _compile(name: str, warm: Callable[[str], None]) -> None:
    say(f"first use: compiling the kernels of {name}, about a minute, once", "bold")
    with at_once(), progress_bar("kernels") as progress:
        progress(name, 0, 1)
        warm(name)


def _refuse_mistakes(spec: Path) -> None:
    from compiler.check import check
    from spec_schema.diagnostics import Severity, SpecError
    from specc.loading import refuse_log

    refuse_log(spec)
    found = check(spec)
    if any(diagnostic.severity is Severity.ERROR for diagnostic in found):
        raise SpecError(found)
