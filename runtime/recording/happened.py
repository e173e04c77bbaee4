"""What a recording says of its run that is no series of values: the layout, touches, and jams.

Things that were laid at random stand in no spec, and what robots touched, and where, in no topic.
"""

import json
from dataclasses import dataclass
from typing import Any, Final, final

from runtime.arrays import Array
from runtime.container import ArtifactError
from runtime.program_json import from_plain, to_plain
from runtime.recording.tracks import Touch
from runtime.world.audit import Jam
from runtime.world.model import Thing

SUFFIX: Final = ".happened.json"
FORMAT: Final = 1


@final
@dataclass(frozen=True, slots=True)
class Happened:
    """things: all of them, where they stood at first. touches and jams: in the order of time."""

    things: tuple[Thing, ...]
    touches: tuple[Touch, ...]
    jams: tuple[Jam, ...]


def to_bytes(happened: Happened) -> bytes:
    """As JSON; the same is always written the same."""
    document = {"format": FORMAT, "happened": to_plain(Happened, happened)}
    text = json.dumps(document, sort_keys=True, allow_nan=False, ensure_ascii=False, indent=1)
    return (text + "\n").encode()


def from_bytes(data: bytes) -> Happened:
    """Read back.

    Raises:
        ArtifactError: this is not what `to_bytes` writes.
    """
    try:
        document: Any = json.loads(data)
        if document["format"] != FORMAT:
            raise ArtifactError(f"its format is {document['format']}, this is {FORMAT}")
        found: Happened = from_plain(Happened, document["happened"], "happened", _no_table)
    except (KeyError, TypeError, ValueError, RecursionError) as error:
        raise ArtifactError("it does not tell what happened in a run") from error
    return found


def _no_table(name: str, shape: tuple[int, ...]) -> Array:
    raise ArtifactError(f"what happened has no table ({name}, {shape})")
