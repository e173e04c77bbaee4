"""The files that a book is made of: every spec that is named, and what specs have beside them."""

import ast
import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final, final

from runtime.architecture import Architecture
from runtime.program import Program
from runtime.scenario import Scenario
from spec_schema.behavior import BehaviorSpec
from spec_schema.load import examine
from spec_schema.node import plain
from spec_schema.source import Source
from spec_schema.yaml_reader import read
from specc.faults import fault
from specc.origins import files_named

SPECS: Final = "specs"
"""The folder of a book that holds them."""


@final
@dataclass(frozen=True, slots=True)
class Sources:
    """Files by absolute path with their names in the book, `specs/...`; the first is the book's."""

    names: dict[Path, str]

    def name_of(self, file: str) -> str:
        """The name in the book of a file as a program names it."""
        return self.names[absolute(file)]


def sources_of(path: Path, made: Architecture | Scenario, body: object = None) -> Sources:
    """All files that `made`, compiled from `path`, was made of, under one folder.

    Raises:
        SpecError: they have no folder in common, or name one another by absolute paths (V431).
    """
    for file in dict.fromkeys(files_named((made, body))):
        _refuse_absolute(Path(file))
    own = absolute(path)
    named = dict.fromkeys(absolute(f) for f in files_named((made, body)))
    files = dict.fromkeys((own, *named, *_beside(made)))
    try:
        root = Path(os.path.commonpath([file.parent for file in files]))
    except ValueError as error:
        raise fault("V431", path, "its specs lie on several disks", "put them together") from error
    return Sources({f: f"{SPECS}/{f.relative_to(root).as_posix()}" for f in files})


def _refuse_absolute(file: Path) -> None:
    """A spec that names a file by where it lies on this machine can't be copied."""
    root = read(Source(str(file), file.read_text(encoding="utf-8")))
    for text in _texts([plain(entry.value) for entry in root.entries.values()]):
        if Path(text).is_absolute() and Path(text).is_file():
            message = f"it names '{text}', which is another file, or none, on other machines"
            raise fault("V431", file, message, "name it by its path from this file: ../x.yaml")


def _texts(value: object) -> Iterator[str]:
    """All texts in plain data."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict):
        for each in value.values():
            yield from _texts(each)
    elif isinstance(value, list | tuple):
        for each in value:
            yield from _texts(each)


def _beside(made: Architecture | Scenario) -> Iterator[Path]:
    """Files that are no specs: tables of numbers, and Python of the author's own."""
    if isinstance(made, Scenario):
        for robot in made.robots:
            yield from _beside(robot.architecture)
        return
    folder = absolute(made.source.file).parent
    calls = [channel.resolution.function for channel in made.channels]
    calls += [node.module for node in made.nodes] + [one.module for one in made.arbiters]
    yield from _modules(folder, *calls)
    plans = [arbiter.plan for arbiter in made.arbiters if arbiter.plan is not None]
    for program in (*made.programs, *plans):
        yield from _beside_behavior(program)


def _beside_behavior(program: Program) -> Iterator[Path]:
    if program.field.form not in {"grid", "module"}:
        return
    file = absolute(program.source.file)
    loaded = examine(file).loaded
    if loaded is None or not isinstance(loaded.spec, BehaviorSpec):
        return
    form = loaded.spec.field
    if form.grid is not None and form.grid.file:
        yield file.parent / form.grid.file
    if form.module is not None:
        yield from _modules(file.parent, form.module.call)


def _modules(folder: Path, *calls: str) -> Iterator[Path]:
    """The files of `package.module:function` beside a spec, and what they import from beside it."""
    waiting = [folder / Path(*call.partition(":")[0].split(".")) for call in filter(None, calls)]
    seen: set[Path] = set()
    while waiting:
        file = waiting.pop().with_suffix(".py")
        if file not in seen and file.is_file():
            seen.add(file)
            yield file
            waiting += [folder / Path(*name.split(".")) for name in _imported(file)]


def _imported(file: Path) -> Iterator[str]:
    """The modules that a file imports, by their whole names; none of one that can't be read."""
    try:
        tree = ast.parse(file.read_bytes())
    except (SyntaxError, ValueError):
        return
    for each in ast.walk(tree):
        if isinstance(each, ast.Import):
            yield from (alias.name for alias in each.names)
        elif isinstance(each, ast.ImportFrom) and each.module and not each.level:
            yield each.module


def absolute(file: Path | str) -> Path:
    """Where a file is, without following links: specs name one another by where they lie."""
    return Path(os.path.normpath(Path(file).absolute()))
