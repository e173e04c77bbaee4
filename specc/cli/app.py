"""The commands, in the order in which a user meets them, and how a failure ends."""

import errno
import sys
from collections.abc import Sequence
from typing import Annotated, Final

import typer
from typer.exceptions import TyperException

import specc
from spec_schema.diagnostics import SpecError
from spec_schema.suggest import did_you_mean
from specc.cli.check import check
from specc.cli.compare import compare
from specc.cli.compile import compile_
from specc.cli.console import print_annotations, print_json, say, show_diagnostics
from specc.cli.explain import explain
from specc.cli.export import export
from specc.cli.fit import fit
from specc.cli.init import init
from specc.cli.learn import learn
from specc.cli.portrait import portrait
from specc.cli.replay import replay
from specc.cli.schema import schema
from specc.cli.simulate import simulate
from specc.cli.status import Status
from specc.cli.train import train
from specc.cli.verify import verify
from specc.cli.wiring import wiring

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

NUMBERS: Final = {
    "Input should be a valid integer": "write a whole number, in digits alone, such as 1000",
    "Input should be a valid number": "write a number, such as 0.5",
    "Input should be a finite number": "write a number, such as 0.5",
    "Input should be greater than or equal to ": "the least is ",
    "Input should be less than or equal to ": "the most is ",
    "Input should be greater than ": "write more than ",
    "Input should be less than ": "write less than ",
}
"""What the parser says of a number, and what specc says."""


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
app.command("replay")(replay)
app.command("portrait")(portrait)
app.command("wiring")(wiring)
app.command("export")(export)
app.command("compare")(compare)
app.command("verify")(verify)
app.command("explain")(explain)
app.command("fit")(fit)
app.command("learn")(learn)
app.command("train")(train)
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
        say(_see(sys.argv[1:] if arguments is None else arguments))
        return Status.BAD_INPUT
    except OSError as error:
        return failed(error)
    if outcome == Status.INTERRUPTED and not isinstance(outcome, Status):
        raise KeyboardInterrupt  # typer's own; a command with something to tell returns ours
    return outcome if isinstance(outcome, int) else Status.YES


def failed(error: OSError) -> Status:
    """Say what the system refused: a file, or standard output where it names none."""
    why = str(error.strerror or error).lower()
    if error.filename:
        say(f"{error.filename}: {why}", "bold red")
    else:
        full = error.errno in {errno.ENOSPC, errno.EIO, errno.EBADF}
        say(f"standard output can't be written: {why}" if full else why, "bold red")
    return Status.BAD_INPUT


def _see(arguments: Sequence[str]) -> str:
    """Where the options are told: those of the command, where one is named."""
    commands = {command.name for command in app.registered_commands}
    named = next((word for word in arguments if word in commands), None)
    if named is None:
        return "see `specc --help`, or `specc COMMAND --help` for a command's options and examples"
    return f"see `specc {named} --help` for its options and examples"


def _usage(error: TyperException) -> str:
    """What is wrong with the arguments, and with which."""
    words = _in_our_words(str(error).removeprefix("Value error, "))
    if words.startswith("No such option"):
        meant = did_you_mean(getattr(error, "option_name", ""), _options(error))
        return f"{words}; {meant}" if meant else words
    if words.startswith("Missing parameter"):
        wanted = getattr(getattr(error, "param", None), "metavar", None)
        return f"{wanted} is missing" if wanted else words
    option = next(iter(getattr(getattr(error, "param", None), "opts", ())), "")
    return f"{option}: {words}" if option.startswith("-") and option not in words else words


def _in_our_words(words: str) -> str:
    """What the parser says of a number, as what to write instead."""
    for theirs, ours in NUMBERS.items():
        if words.startswith(theirs):
            return ours + words.removeprefix(theirs).partition(",")[0]
    return words


def _options(error: TyperException) -> list[str]:
    """The options of the command that was called."""
    command = getattr(getattr(error, "ctx", None), "command", None)
    return [option for part in getattr(command, "params", ()) for option in part.opts]


def _wants(arguments: Sequence[str], form: str) -> bool:
    """Whether the command prints for programs: then they get its diagnostics, too."""
    pairs = zip(arguments, [*arguments[1:], ""], strict=True)
    return any(
        one in {f"--format={form}", f"-f{form}"} or (one in {"--format", "-f"} and value == form)
        for one, value in pairs
    )
