"""The document of a scenario in its recording: what was run, and what is required of it."""

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, final

from runtime.arrays import Array
from runtime.container import ArtifactError
from runtime.program_json import from_plain
from runtime.requirement import Requirement
from runtime.requirement_faults import faults_of
from runtime.scenario_artifact import is_time
from runtime.world.model import World
from runtime.world.model_faults import faults_of_world
from verifier.traces.files.open_log import attachments

SUFFIX: Final = ".scenario.json"
FORMAT: Final = 1


@final
@dataclass(frozen=True, eq=False, slots=True)
class ScenarioDocument:
    """What a recording says of its scenario."""

    name: str
    about: str
    world: World
    step: float
    duration: float
    seed: int
    beginnings: dict[str, float]
    requirements: tuple[Requirement, ...]
    robots: tuple[str, ...]


def attached_scenario(path: Path) -> ScenarioDocument | None:
    """The scenario that a recording carries; None where it carries none.

    Raises:
        ArtifactError: the document is damaged, or of another version.
        SpecError: the file can't be read (V301).
    """
    found = attachments(path, SUFFIX)
    return read_document(found[0][1]) if found else None


def read_document(data: bytes) -> ScenarioDocument:
    """The document of a scenario, from its JSON.

    Raises:
        ArtifactError: it is none, or says what no scenario can.
    """
    try:
        document = json.loads(data)
        found = _typed(document)
    except (KeyError, TypeError, ValueError, RecursionError) as error:
        raise ArtifactError("it is no document of a scenario") from error
    for fault in _faults(found):
        raise ArtifactError(fault)
    return found


def _typed(document: Mapping[str, Any]) -> ScenarioDocument:
    """Each of its values, which is of the type that it should be."""
    if document["format"] != FORMAT:
        raise ArtifactError(f"its format is {document['format']}, this is {FORMAT}")

    def value(kind: Any, key: str) -> Any:
        return from_plain(kind, document[key], key, _no_table)

    return ScenarioDocument(
        name=value(str, "name"),
        about=value(str, "about"),
        world=value(World, "world"),
        step=value(float, "step"),
        duration=value(float, "duration"),
        seed=value(int, "seed"),
        beginnings=value(dict[str, float], "beginnings"),
        requirements=value(tuple[Requirement, ...], "requirements"),
        robots=tuple(value(dict[str, dict[str, str]], "robots")),
    )


def _faults(document: ScenarioDocument) -> Iterator[str]:
    """What no scenario can say, each in a sentence."""
    if not is_time(document.step, document.duration):
        yield f"it has a step of {document.step!r} s in a run of {document.duration!r} s"
    for requirement in document.requirements:
        yield from faults_of(requirement)
    yield from faults_of_world(document.world)


def _no_table(name: str, shape: tuple[int, ...]) -> Array:
    raise ArtifactError(f"a scenario has no table ({name}, {shape})")
