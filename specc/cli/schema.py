"""`specc schema`: the language as JSON Schema, for editors."""

from typing import Annotated, Literal, TypeAlias

import typer

from specc.cli.console import print_json

Kind: TypeAlias = Literal[
    "behavior", "body", "arbiter", "architecture", "world", "scenario", "project"
]


def schema(
    kind: Annotated[Kind, typer.Argument(help="The kind of spec.")] = "behavior",
) -> None:
    """Print the JSON Schema of a kind of spec, so that an editor completes and checks keys.

    **Examples**

    `specc schema behavior > behavior.schema.json`

    and atop the spec: `# yaml-language-server: $schema=behavior.schema.json`
    """
    from spec_schema.json_schema import json_schema

    print_json(json_schema(kind))
