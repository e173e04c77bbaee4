"""What can be changed in a spec's text, one value at a time."""

from dataclasses import dataclass
from typing import TypeAlias, final

from spec_schema.node import Plain
from spec_schema.places import Path


@final
@dataclass(frozen=True, slots=True)
class NewNumber:
    """Another number at `path`; quotes and the unit behind the number stay."""

    path: Path
    number: str


@final
@dataclass(frozen=True, slots=True)
class NewText:
    """Another text at `path`, in the quotes that stand there."""

    path: Path
    text: str


@final
@dataclass(frozen=True, slots=True)
class NewKey:
    """A key that the mapping at `path[:-1]` lacks, with its value as it would stand in YAML.

    bare: where no mapping stands there but a single value, the key that this value is short for:
    it becomes a mapping of two keys.
    """

    path: Path
    text: str
    bare: str = ""


@final
@dataclass(frozen=True, slots=True)
class NewLines:
    """Other content at `path`, in lines of its own below its key; comments beside the key stay.

    lines: without the indent that they get. data: what is to be read of them.
    """

    path: Path
    lines: tuple[str, ...]
    data: Plain


Edit: TypeAlias = NewNumber | NewText | NewKey | NewLines


@final
class EditError(Exception):
    """A value that can't be changed where it stands, and why."""

    def __init__(self, path: Path, why: str) -> None:
        self.path, self.why = path, why
        super().__init__(why)
