"""The command line: parsing and printing only; the work is done in the modules of `specc`."""

import gc
import io
import os
import sys
import traceback
from collections.abc import Sequence

from specc.cli.status import Status


def main(arguments: Sequence[str] | None = None) -> int:
    """Run `specc` and return its exit status (see `specc.cli.status`)."""
    # Looking for pydantic's plugins costs a tenth of a second, and we have none.
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            # A terminal that can't show a letter gets a question mark, never a traceback.
            stream.reconfigure(errors="replace")
    from specc.cli.app import run

    return run(arguments)


def entry() -> None:
    """What the installed `specc` command calls; the one place where an exception becomes a 3."""
    # Loading libraries makes no garbage, and looking for it takes a tenth of the start-up.
    gc.set_threshold(100_000)
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        sys.stderr.write("\ninterrupted; nothing was left half-written\n")
        sys.exit(130)
    except Exception:  # noqa: BLE001  the last line of defence
        traceback.print_exc()
        sys.stderr.write("\nthis is a bug in specc, not in your spec or trace; please report it\n")
        sys.exit(Status.BUG)
