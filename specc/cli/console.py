"""Where the program speaks: results to standard output, messages and progress to standard error."""

import json
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import final

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn
from rich.text import Text

from spec_schema.diagnostics import Diagnostic, in_file_order, render_one, summary

COLOURS = {"error": "bold red", "warning": "bold yellow", "pass": "bold green", "fail": "bold red"}


def messages() -> Console:
    """Standard error, with colour where a terminal wants it (rich respects NO_COLOR)."""
    return Console(stderr=True, highlight=False, soft_wrap=True)


def results() -> Console:
    """Standard output, likewise."""
    return Console(highlight=False, soft_wrap=True)


def say(message: str, style: str = "") -> None:
    """A message for the user; never part of a result."""
    messages().print(Text(message, style=style))


def print_json(value: object) -> None:
    """A result for machines, alone on standard output; never NaN, which isn't JSON."""
    sys.stdout.write(json.dumps(value, indent=2, ensure_ascii=False, allow_nan=False) + "\n")


def print_annotations(diagnostics: Iterable[Diagnostic]) -> None:
    """Diagnostics as GitHub shows them beside the code, on standard output."""
    from verifier.report.annotations import annotation

    for each in in_file_order(diagnostics):
        message = "\n".join(part for part in (each.message, each.help) if part)
        sys.stdout.write(annotation(str(each.severity), each.place, each.code, message) + "\n")


def print_text(text: str) -> None:
    """A result for people."""
    results().print(Text(text))


def print_styled(text: str, phrase: str, style: str) -> None:
    """A result for people, with one phrase of it in a style."""
    shown = Text(text)
    start = text.find(phrase)
    shown.stylize(style, start, start + len(phrase))
    results().print(shown)


def show_diagnostics(diagnostics: Iterable[Diagnostic]) -> None:
    """Diagnostics in file order, with a last line that counts them, on standard error."""
    found = in_file_order(diagnostics)
    if not found:
        return
    console = messages()
    for diagnostic in found:
        console.print(_coloured(diagnostic))
        console.print()
    console.print(Text(summary(found), style="bold"))


def _coloured(diagnostic: Diagnostic) -> Text:
    text = Text(render_one(diagnostic))
    text.highlight_regex(rf"{diagnostic.severity}\[\w+\]", COLOURS[diagnostic.severity])
    text.highlight_regex(r"\^+", COLOURS[diagnostic.severity])
    text.highlight_regex(r"= (at|help):", "cyan")
    return text


@final
class Bar:
    """A bar on standard error that steps aside while something is printed."""

    def __init__(self, title: str) -> None:
        self._title = title
        columns = (TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn())
        console = messages()
        self._shown = console.is_interactive
        self._bar = Progress(
            *columns, console=console, transient=True, redirect_stdout=False, redirect_stderr=False
        )
        self._task = self._bar.add_task(title, total=None)

    def advance(self, what: str, done: int, total: int) -> None:
        """What is being done, how much is done, and of how much."""
        self._bar.update(
            self._task, description=f"{self._title}: {what}", completed=done, total=total
        )

    def start(self) -> None:
        """Show it, where somebody looks: elsewhere even an empty bar leaves a line."""
        if self._shown:
            self._bar.start()

    def stop(self) -> None:
        """Take it away."""
        if self._shown:
            self._bar.stop()

    @contextmanager
    def aside(self) -> Iterator[None]:
        """While something else is printed."""
        self.stop()
        yield
        self.start()


@contextmanager
def shown_bar(title: str) -> Iterator[Bar]:
    """A bar while something is worked out; none where standard error is no terminal."""
    bar = Bar(title)
    bar.start()
    try:
        yield bar
    finally:
        bar.stop()


@contextmanager
def progress_bar(title: str) -> Iterator[Callable[[str, int, int], None]]:
    """A bar on standard error; what it yields takes (what, done, of how many)."""
    with shown_bar(title) as bar:
        yield bar.advance
