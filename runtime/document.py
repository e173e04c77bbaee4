"""The JSON member of an artifact that holds others: its format, and one value under one key."""

import json
from dataclasses import dataclass
from typing import Any, final

from runtime.arrays import Array
from runtime.container import ArtifactError
from runtime.program_json import from_plain, to_plain


@final
@dataclass(frozen=True, slots=True)
class Document:
    """How a value of type `kind` is written.

    what: `architecture`, for messages and the file's name. key: what the value stands under.
    version: of its format; a change of meaning raises it.
    """

    what: str
    key: str
    version: int
    kind: type[Any]

    @property
    def name(self) -> str:
        """The member's name."""
        return f"{self.what}.json"

    def written(self, value: Any) -> bytes:
        """The document's bytes.

        Raises:
            ArtifactError: a number is not finite, or a text is no Unicode.
        """
        document = {"format": self.version, self.key: to_plain(self.kind, value)}
        try:
            text = json.dumps(
                document, sort_keys=True, allow_nan=False, ensure_ascii=False, indent=1
            )
            return (text + "\n").encode()
        except ValueError as problem:
            raise ArtifactError(f"the {self.what} cannot be written: {problem}") from problem

    def read(self, content: bytes) -> Any:
        """The value that `written` wrote.

        Raises:
            ArtifactError: the content is not exactly what would be written.
        """
        try:
            document = json.loads(content.decode())
        except (ValueError, RecursionError) as problem:
            raise ArtifactError(f"{self.name} is not JSON: {problem}") from problem
        if not isinstance(document, dict) or set(document) != {"format", self.key}:
            raise ArtifactError(f"{self.name} holds no {self.what}")
        if document["format"] != self.version:
            raise ArtifactError(
                f"the artifact has format {document['format']!r}, this version reads "
                f"{self.version}; compile the spec again"
            )
        return from_plain(self.kind, document[self.key], self.what, _no_tables)


def _no_tables(name: str, _shape: tuple[int, ...]) -> Array:
    raise ArtifactError(f"the document names a table '{name}', which belongs to a behavior")
