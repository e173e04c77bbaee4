"""Standard output and standard error that a reader may leave: `specc verify run.mcap | head -3`.

What comes after goes nowhere, and the command ends as it would have: with its reports written, and
with the status of its verdict. Any other status, such as the 141 of a process that the signal ends,
would be drawn by lot: whether `head` has closed the pipe by the time of the last line depends on
how busy the machine is. And 1 would say that the robot is not faithful.
"""

import errno
import io
import os
import sys
from typing import TYPE_CHECKING, Final, TextIO, final

if TYPE_CHECKING:
    from _typeshed import ReadableBuffer

STDOUT: Final = 1
STDERR: Final = 2


def let_readers_leave() -> None:
    """From now on nothing that is printed fails because nobody reads on."""
    sys.stdout = _kept_open(sys.stdout, STDOUT)
    sys.stderr = _kept_open(sys.stderr, STDERR)


def flushed() -> int:
    """0 where all results have reached standard output; else a status, and the reason is told."""
    try:
        sys.stdout.flush()
    except OSError as error:
        from specc.cli.app import failed

        return failed(error)
    return 0


def _kept_open(stream: TextIO | None, number: int) -> TextIO:
    """The stream in such a file; a stream to nowhere where the user has closed it (`>&-`)."""
    if stream is None:
        return open(os.devnull, "w", encoding="utf-8")  # noqa: PTH123  open to the end
    if not (isinstance(stream, io.TextIOWrapper) and _number_of(stream) == number):
        return stream
    return io.TextIOWrapper(
        io.BufferedWriter(_Left(number, "wb", closefd=False)),
        encoding=stream.encoding,
        errors=stream.errors,
        line_buffering=stream.line_buffering or number == STDERR,
        write_through=stream.write_through,
    )


def _number_of(stream: TextIO) -> int | None:
    """Of the file that the stream writes to; None where it writes to none."""
    try:
        return stream.fileno()
    except OSError:
        return None


@final
class _Left(io.FileIO):
    """A file whose reader may leave."""

    def write(self, data: "ReadableBuffer", /) -> int:
        try:
            return super().write(data)
        except OSError as error:
            # What is left in buffers would fail again, and be told again.
            _point_nowhere(self.fileno())
            # Standard output that is full is an error; a message that no one gets is not.
            if self.fileno() == STDOUT and error.errno != errno.EPIPE:
                raise
            return super().write(data)


def _point_nowhere(number: int) -> None:
    """What is written to the file of this number is dropped from now on."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, number)
    os.close(nowhere)
