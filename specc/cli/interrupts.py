"""Ctrl-C: it acts at once, also while a kernel runs, and never ends in a traceback.

Python looks at signals between two of its own instructions, so a kernel that runs for seconds
would keep a user waiting for as long. Our kernels let other threads run meanwhile: one of them
waits for the signal, and ends the process where the main thread does not do so by itself.
"""

import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from types import FrameType
from typing import Final

INTERRUPTED: Final = "\ninterrupted; nothing was left half-written\n"
PATIENCE: Final = 0.5
"""Seconds that the main thread has to notice Ctrl-C."""
SHOW_CURSOR: Final = "\x1b[?25h"
"""A bar hides the cursor of a terminal."""


def hear_at_once() -> None:
    """From now on Ctrl-C interrupts within `PATIENCE`.

    Nothing changes where Ctrl-C is ignored (`nohup`), and on Windows, whose pipes no signal writes
    to. The write to the pipe is that of `signal.set_wakeup_fd`: it happens inside the handler in C.
    """
    if os.name != "posix" or signal.getsignal(signal.SIGINT) is not signal.default_int_handler:
        return
    reader, writer = os.pipe()
    os.set_blocking(writer, False)
    noticed = threading.Event()

    def notice(_number: int, _frame: FrameType | None) -> None:
        noticed.set()
        raise KeyboardInterrupt

    signal.signal(signal.SIGINT, notice)
    signal.set_wakeup_fd(writer, warn_on_full_buffer=False)
    threading.Thread(target=_watch, args=(reader, noticed), daemon=True).start()


@contextmanager
def postponed() -> Iterator[threading.Event]:
    """Within it Ctrl-C interrupts nothing, but sets the event: what is begun is ended first.

    It still ends the process where the main thread does not look for `PATIENCE`.
    """
    wanted = threading.Event()
    before = signal.getsignal(signal.SIGINT)

    def note(number: int, frame: FrameType | None) -> None:
        wanted.set()
        if callable(before):
            with suppress(KeyboardInterrupt):
                before(number, frame)

    with _heard_by(note):
        yield wanted


@contextmanager
def at_once() -> Iterator[None]:
    """Within it Ctrl-C ends the process there and then.

    What compiles calls back into Python, where an interruption would get lost.
    """
    with _heard_by(lambda _number, _frame: _end()):
        yield


@contextmanager
def _heard_by(handler: Callable[[int, FrameType | None], None]) -> Iterator[None]:
    """Within it a handler hears Ctrl-C, where anybody does."""
    before = signal.getsignal(signal.SIGINT)
    if not callable(before):
        yield
        return
    signal.signal(signal.SIGINT, handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


def deaf() -> None:
    """From now on Ctrl-C does nothing: the status is decided, and the process about to end."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def _watch(reader: int, noticed: threading.Event) -> None:
    """End the process after a Ctrl-C that the main thread does not notice in time."""
    while True:
        numbers = os.read(reader, 1)
        if numbers == bytes([signal.SIGINT]) and not noticed.wait(PATIENCE):
            _end()
        noticed.clear()


def _end() -> None:
    """The end of the process, with a sentence."""
    os.write(2, (SHOW_CURSOR * sys.stderr.isatty() + INTERRUPTED).encode())
    os._exit(130)
