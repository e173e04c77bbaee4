"""The document of a scenario in its recording: what was run, and what is required of it."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, final

from runtime.arrays import Array
from runtime.container import ArtifactError
from runtime.program_json import from_plain
from runtime.requirement import Requirement
from verifier.traces.files.open_log import attachments

SUFFIX: Final = ".scenario.json"
FORMAT: Final = 1


@final
@dataclass(frozen=True, slots=True)
class ScenarioDocument:
    """What a recording says of its scenario."""

    name: str
    step: float
    duration: float
    seed: int
    requirements: tuple[Requirement, ...]
    robots: tuple[str, ...]


def attached_scenario(path: Path) -> ScenarioDocument | None:
    """The scenario that a recording carries; None where it carries none.

    Raises:
        ArtifactError: the document is damaged, or of another version.
        SpecError: the file can't be read (V301).
    """
    found = attachments(path, SUFFIX)
    return _read(found[0][1]) if found else None


def _read(data: bytes) -> ScenarioDocument:
    try:
        document = json.loads(data)
        if document["format"] != FORMAT:
            raise ArtifactError(f"its format is {document['format']}, this is {FORMAT}")
        return ScenarioDocument(
            name=str(document["name"]),
            step=float(document["step"]),
            duration=float(document["duration"]),
            seed=int(document["seed"]),
            requirements=_requirements(document["requirements"]),
            robots=tuple(document["robots"]),
        )
    except (KeyError, TypeError, ValueError) as error:
        raise ArtifactError("it is no document of a scenario") from error


def _requirements(found: Sequence[Mapping[str, Any]]) -> tuple[Requirement, ...]:
    return tuple(
        from_plain(Requirement, one, f"requirements[{i}]", _no_table) for i, one in enumerate(found)
    )


def _no_table(name: str, shape: tuple[int, ...]) -> Array:
    raise ArtifactError(f"a requirement has no table ({name}, {shape})")
