"""Options that several commands share."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated, TypeAlias, final

import typer


@final
class Format(StrEnum):
    """How a result is printed on standard output."""

    TEXT = "text"
    JSON = "json"


@final
class ReportFormat(StrEnum):
    """How mistakes and verdicts are printed on standard output."""

    TEXT = "text"
    JSON = "json"
    GITHUB = "github"


@final
class Clock(StrEnum):
    """Which stamps count as the time of a message."""

    AUTO = "auto"
    SENSOR = "sensor"
    LOG = "log"


SpecPath: TypeAlias = Annotated[
    Path, typer.Argument(help="A behavior spec (.yaml) or a compiled one (.specc).", metavar="SPEC")
]
FormatOption: TypeAlias = Annotated[
    Format, typer.Option("--format", "-f", help="Print for people (text) or for programs (json).")
]
ReportFormatOption: TypeAlias = Annotated[
    ReportFormat,
    typer.Option(
        "--format",
        "-f",
        help="Print for people (text), for programs (json), or as annotations (github).",
    ),
]
Logs: TypeAlias = Annotated[
    list[Path],
    typer.Argument(
        help="Logs: .mcap, ROS 1 .bag, ROS 2 bag (folder or .db3), .ulg, .csv.", metavar="TRACE"
    ),
]
JudgedBy: TypeAlias = Annotated[
    list[Path],
    typer.Option(
        "--spec",
        metavar="SPEC",
        help="The spec (.yaml or .specc); default: what is attached to the log, else what "
        "`specc.yaml` says.",
    ),
]
Reports: TypeAlias = Annotated[
    list[Path],
    typer.Option(
        "--output",
        "-o",
        metavar="FILE",
        help="Also write a report: .html, .json, .txt, .xml (JUnit) or .sarif. Repeatable.",
    ),
]
ClockOption: TypeAlias = Annotated[
    Clock, typer.Option("--clock", help="Sensor stamps, log times, or the better of both.")
]
Strict: TypeAlias = Annotated[
    bool, typer.Option("--strict", help="Any loss in a log (torn, corrupt) is an error.")
]
Settings: TypeAlias = Annotated[
    list[str],
    typer.Option(
        "--set",
        "-s",
        metavar="NAME=VALUE",
        help="Set a control parameter (for a portrait also hold a state): in its own unit "
        "(`speed=0.4`) or with one (`speed='40 cm/s'`). Repeatable.",
    ),
]


def one_spec(named: list[Path]) -> Path | None:
    """What `--spec` names; None where it names nothing.

    Raises:
        typer.BadParameter: it names several.
    """
    if len(named) > 1:
        raise typer.BadParameter(
            f"--spec: name one spec, for all logs (got {', '.join(map(str, named))}); which of"
            " several is whose, `traces:` in a specc.yaml says"
        )
    return named[0] if named else None


def assignments(settings: list[str]) -> dict[str, str]:
    """`["x=1", "v=2 m/s"]` as a mapping.

    Raises:
        typer.BadParameter: an entry without `=`, or a name given twice.
    """
    found: dict[str, str] = {}
    for setting in settings:
        name, equals, value = setting.partition("=")
        name = name.strip()
        if not equals or not name or not value.strip():
            raise typer.BadParameter(f"write {name or 'NAME'}=VALUE (got '{setting}')")
        if name in found:
            raise typer.BadParameter(f"'{name}' is set twice")
        found[name] = value.strip()
    return found


def one_assignment(setting: str) -> tuple[str, str]:
    """`"mu=0.1:3:6"` as a name and what it is set to.

    Raises:
        typer.BadParameter: an entry without `=`.
    """
    ((name, value),) = assignments([setting]).items()
    return name, value


def names_of(listed: str | None, option: str = "--axes") -> tuple[str, ...] | None:
    """`"x, v"` as two names; None where nothing was given.

    Raises:
        typer.BadParameter: a name is missing.
    """
    if listed is None:
        return None
    names = tuple(name.strip() for name in listed.split(","))
    if not all(names):
        what = "states, such as x,v" if option == "--axes" else "modules, such as seek,avoid"
        raise typer.BadParameter(f"{option}: write names of {what} (got '{listed}')")
    return names
