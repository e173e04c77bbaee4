"""The commands, in the order in which a user meets them, and how a failure ends."""

import sys
from collections.abc import Sequence
from typing import Annotated

import typer
from typer.exceptions import TyperException

import specc
from spec_schema.diagnostics import SpecError
from specc.cli.check import check
from specc.cli.compare import compare
from specc.cli.compile import compile_
from specc.cli.console import print_annotations, print_json, say, show_diagnostics
from specc.cli.init import init
from specc.cli.portrait import portrait
from specc.cli.schema import schema
from specc.cli.simulate import simulate
from specc.cli.status import Status
from specc.cli.verify import verify

EPILOG = (
    "Exit status: 0 yes, 1 no (not faithful), 2 bad spec, trace or usage, "
    "3 a bug in specc, 4 inconclusive, 130 interrupted."
)

app = typer.Typer(
    name="specc",
    help="Say precisely what a robot behavior shall do, and check whether the robot does it.",
    epilog=EPILOG,
    no_args_is_help=True,
    add_completion=True,
    pretty_exceptions_enable=False,
    rich_markup_mode="markdown",
    context_settings={"help_option_names": ["-h", "--help"]},
)


def _version(wanted: bool) -> None:  # noqa: FBT001  typer calls it with the flag's value
    if wanted:
        typer.echo(f"specc {specc.__version__}")
        raise typer.Exit


@app.callback()
def _specc(
    _show_version: Annotated[
        bool,
        typer.Option("--version", callback=_version, is_eager=True, help="Print the version."),
    ] = False,
) -> None:
    pass


app.command("init")(init)
app.command("check")(check)
app.command("compile")(compile_)
app.command("simulate")(simulate)
app.command("portrait")(portrait)
app.command("compare")(compare)
app.command("verify")(verify)
app.command("schema")(schema)


def run(arguments: Sequence[str] | None = None) -> int:
    """Parse the arguments, run the command, and turn how it ended into an exit status."""
    try:
        outcome = app(args=arguments, standalone_mode=False)
    except SpecError as error:
        given = sys.argv[1:] if arguments is None else arguments
        if _wants(given, "json"):
            print_json([diagnostic.as_json() for diagnostic in error.diagnostics])
        elif _wants(given, "github"):
            print_annotations(error.diagnostics)
        else:
            show_diagnostics(error.diagnostics)
        return Status.BAD_INPUT
    except typer.Abort:
        raise KeyboardInterrupt from None
    except TyperException as error:
        say(f"specc: {_usage(error)}", "bold red")
        say("see `specc --help`, or `specc COMMAND --help` for a command's options and examples")
        return Status.BAD_INPUT
    except OSError as error:
        say(f"{error.filename}: {error.strerror}" if error.filename else str(error), "bold red")
        return Status.BAD_INPUT
    return outcome if isinstance(outcome, int) else Status.YES


def _usage(error: TyperException) -> str:
    """What is wrong with the arguments, and with which."""
    words = str(error).removeprefix("Value error, ")
    option = next(iter(getattr(getattr(error, "param", None), "opts", ())), "")
    return f"{option}: {words}" if option.startswith("-") and option not in words else words


def _wants(arguments: Sequence[str], form: str) -> bool:
    """Whether the command prints for programs: then they get its diagnostics, too."""
    pairs = zip(arguments, [*arguments[1:], ""], strict=True)
    return any(
        one in {f"--format={form}", f"-f{form}"} or (one in {"--format", "-f"} and value == form)
        for one, value in pairs
    )
