"""The YAML file that a program was compiled from, as it is now."""

import hashlib
from pathlib import Path

from runtime.program import Program
from spec_schema.diagnostics import SpecError
from spec_schema.load import Loaded, load
from specc.faults import fault


def own_text(program: Program) -> Loaded:
    """The spec's file, of the very text that the program was compiled from.

    Raises:
        SpecError: it is not there, or has another text (V371).
    """
    file, sha256 = program.source.file, program.source.sha256
    try:
        loaded = load(Path(file))
    except SpecError as error:
        message = f"the text of spec '{program.name}' is not at hand: {file} can't be read"
        raise fault("V371", file, message, "name the .yaml with --spec") from error
    if sha_of(loaded.source.text) != sha256:
        message = (
            f"the recording was judged by another text of '{program.name}' (sha256 {sha256[:12]}) "
            f"than this file has now"
        )
        raise fault("V371", file, message, f"name the text to edit: --spec {file}")
    return loaded


def sha_of(text: str) -> str:
    """The digest by which texts are told apart."""
    return hashlib.sha256(text.encode()).hexdigest()
