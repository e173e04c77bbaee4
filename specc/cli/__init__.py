"""The command line: parsing and printing only; the work is done in the modules of `specc`.

Little is imported here, so that hardly anything comes before `entry`, which knows what Ctrl-C is.
"""

import sys

THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")
"""What numpy reads when it is loaded: on small matrices threads of BLAS only wait for each other,
and on a busy machine that makes a command five to ten times slower."""

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Sequence


def main(arguments: "Sequence[str] | None" = None) -> int:
    """Run `specc` and return its exit status (see `specc.cli.status`)."""
    import io
    import os

    # Looking for pydantic's plugins costs a tenth of a second, and we have none.
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")
    for name in THREADS:
        os.environ.setdefault(name, "1")
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            # A terminal that can't show a letter gets a question mark, never a traceback.
            stream.reconfigure(errors="replace")
    from specc.cli.app import run

    return run(arguments)


def entry() -> None:
    """What the installed `specc` command calls; the one place where an exception becomes a 3."""
    try:
        status = _watched()
    except KeyboardInterrupt:
        from specc.cli.interrupts import INTERRUPTED, deaf

        deaf()
        sys.stderr.write(INTERRUPTED)
        status = 130
    sys.exit(status)


def _watched() -> int:
    """The status of a run during which Ctrl-C acts at once, and after which it does nothing."""
    import gc

    from specc.cli.interrupts import deaf, hear_at_once
    from specc.cli.streams import flushed, let_readers_leave

    # Loading libraries makes no garbage, and looking for it takes a tenth of the start-up.
    gc.set_threshold(100_000)
    hear_at_once()
    let_readers_leave()
    try:
        status = main()
        status = flushed() or status
    except Exception:  # noqa: BLE001  the last line of defence
        import traceback

        from specc.cli.status import Status

        traceback.print_exc()
        sys.stderr.write("\nthis is a bug in specc, not in your spec or trace; please report it\n")
        status = Status.BUG
    deaf()
    return status
