"""`specc init`: a first spec, from a template or from a log."""

from pathlib import Path
from typing import Annotated

import typer

from spec_schema.wording import listed
from specc.cli.console import print_text, say


def init(
    name: Annotated[str, typer.Argument(help="The name of the new spec.", metavar="NAME")] = "",
    template: Annotated[
        str, typer.Option("--template", "-t", help="Which template to begin with.")
    ] = "van_der_pol",
    listing: Annotated[
        bool, typer.Option("--list", "--templates", help="List the templates.")
    ] = False,
    log: Annotated[
        Path | None,
        typer.Option(
            "--from", help="List what a log holds and write a spec for it.", metavar="TRACE"
        ),
    ] = None,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="Where it goes; default NAME.yaml here.")
    ] = None,
) -> None:
    """Write a first spec: from a template, or from a log with its `trace:` filled in.

    The templates `scenario`, `training`, `architecture`, `body`, `arbiter` and `world` bring all
    that they name: `specc init night --template scenario` writes a robot in a world that runs as it
    stands, and `--template training` one whose arbiter `specc train` teaches in some minutes.

    **Examples**

    `specc init --list`

    `specc init patrol --template wall_follow`

    `specc init drive --from run.mcap`

    `specc init night --template scenario`
    """
    from specc.files import write_atomically
    from specc.first_spec import beginnings
    from specc.first_spec.sets import NEXT

    if listing:
        print_text(beginnings.list_templates())
        return
    name = beginnings.identifier(name or (log.stem if log else template))
    path = output or Path(f"{name}.yaml")
    companions = {} if log else beginnings.companions(template)
    if path.name in companions:
        raise typer.BadParameter(f"{path.name} is the name of a file that comes with it")
    for wanted in (path, *(path.parent / module for module in companions)):
        if wanted.exists():
            raise typer.BadParameter(f"{wanted} exists already; name another file with -o")
    text = _from_log(log, name) if log else beginnings.from_template(template, name)
    for module, source in companions.items():
        write_atomically(path.parent / module, source.encode())
    write_atomically(path, text.encode())
    todo = "specc check {0}" if log else NEXT.get(template, "specc check {0}")
    written = listed(map(str, (path, *companions)), last="and")
    say(f"wrote {written}; next: {todo.format(path)}", "bold")


def _from_log(log: Path, name: str) -> str:
    """A first spec for a log, which is listed on the way."""
    from specc.first_spec.inventory_text import describe
    from specc.first_spec.written import spec_for
    from verifier.traces.inventory import inspect

    inventory = inspect(log)
    print_text(describe(inventory))
    return spec_for(inventory, name)
