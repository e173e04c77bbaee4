"""What the passes find wrong: gathered, never raised before a pass is through."""

from typing import final

from spec_schema.diagnostics import Diagnostic, Severity
from spec_schema.faults import Fault
from spec_schema.load import Loaded
from spec_schema.places import Path


@final
class Findings:
    """The diagnostics of one spec, as the passes add to them."""

    def __init__(self, loaded: Loaded) -> None:
        self._loaded = loaded
        self._found: list[Diagnostic] = []
        self._notes: list[str] = []

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """Everything found so far."""
        return tuple(self._found)

    @property
    def notes(self) -> tuple[str, ...]:
        """What the compiler chose or added by itself, in sentences."""
        return tuple(self._notes)

    @property
    def has_errors(self) -> bool:
        """Whether anything found so far stops the compiler."""
        return any(found.severity is Severity.ERROR for found in self._found)

    def note(self, sentence: str) -> None:
        """Add a sentence on what was chosen or added."""
        self._notes.append(sentence)

    def origin(self, path: Path) -> str:
        """`file:line:column` of the key at `path`."""
        return self._loaded.origin(path)

    def written(self, path: Path) -> Path:
        """The path in the text, where lists may have items that were refused."""
        return self._loaded.places.written(path)

    def lacks_items(self, path: Path) -> bool:
        """Whether a list under `path` has lost items that were refused."""
        return any(known[: len(path)] == path for known in self._loaded.places.kept)

    def error(self, code: str, path: Path, message: str, remedy: str, *, key: bool = False) -> None:
        """Add an error at the value of `path`, or at its key."""
        self._found.append(self._loaded.error(code, path, message, remedy, key=key))

    def warning(
        self, code: str, path: Path, message: str, remedy: str, *, key: bool = False
    ) -> None:
        """Add a warning, placed like an error."""
        self._found.append(self._loaded.warning(code, path, message, remedy, key=key))

    def fault(self, path: Path, fault: Fault, *, key: bool = False) -> None:
        """Add a fault in the text at `path`, or in its key, under the very characters."""
        within = (fault.start, fault.end)
        found = self._loaded.error(
            fault.code, path, fault.message, fault.help, within=within, key=key
        )
        self._found.append(found)
