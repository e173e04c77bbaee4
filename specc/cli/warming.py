"""The kernels are compiled once per installation; the user is told, and sees it progress."""

from specc.cli.console import progress_bar, say


def warmed() -> None:
    """Compile the kernels now if this installation has not done so yet."""
    from runtime.warm import is_warm, warm

    if is_warm():
        return
    say("first use: compiling specc's numerical kernels, about half a minute, once", "bold")
    with progress_bar("kernels") as progress:
        warm(progress)
