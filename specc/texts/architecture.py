"""What was proved and chosen of an architecture, or how an arbiter decides, in sentences."""

from collections.abc import Sequence
from typing import Any

from compiler.architecture.arbiters import CompiledArbiter
from compiler.architecture.passes import CompiledArchitecture
from compiler.world.scenario_passes import CompiledScenario
from runtime.architecture import Architecture, Channel
from specc.texts.arbiters import arbiter_record, arbiter_sentences, way_of


def conclusions(
    made: CompiledArchitecture | CompiledScenario | CompiledArbiter, *, named: bool = False
) -> list[str]:
    """A sentence for each channel and note; of a scenario the proofs of its architectures.

    Of an arbiter how it decides, rule by rule. named: whether the name of the architecture or the
    arbiter stands before each, as it does in a scenario.
    """
    if isinstance(made, CompiledArbiter):
        before = f"{made.arbiter.name}: " if named else ""
        told = (f"decides {way_of(made.arbiter)}", *arbiter_sentences(made.arbiter))
        return [before + sentence for sentence in told]
    if isinstance(made, CompiledArchitecture):
        before = f"{made.architecture.name}: " if named else ""
        sentences = (*map(_channel, made.architecture.channels), *made.notes)
        return [before + sentence for sentence in sentences]
    return [
        f"{one.name}: {_channel(channel)}"
        for one in architectures_of(made)
        for channel in one.channels
        if channel.resolution.proof
    ]


def conclusions_records(
    made: CompiledArchitecture | CompiledScenario | CompiledArbiter,
) -> list[dict[str, Any]]:
    """The same of each architecture, or of the arbiter, for JSON."""
    if isinstance(made, CompiledArbiter):
        return [arbiter_record(made.arbiter)]
    if isinstance(made, CompiledArchitecture):
        return [_record(made.architecture, made.notes)]
    return [_record(each, ()) for each in architectures_of(made)]


def _record(architecture: Architecture, notes: Sequence[str]) -> dict[str, Any]:
    named = {"name": architecture.name, "spec": architecture.source.file}
    return {**named, **conclusions_record(architecture, notes)}


def conclusions_record(architecture: Architecture, notes: Sequence[str]) -> dict[str, Any]:
    """How each channel is resolved, what was proved of it, and the notes, for JSON."""
    channels = {each.name: each.resolution for each in architecture.channels}
    return {
        "channels": {name: how.way.value for name, how in channels.items()},
        "proofs": {name: how.proof for name, how in channels.items() if how.proof},
        "notes": list(notes),
    }


def architectures_of(made: CompiledScenario) -> tuple[Architecture, ...]:
    """Those of the robots, each once."""
    found = {each.architecture.source.file: each.architecture for each in made.scenario.robots}
    return tuple(found.values())


def _channel(channel: Channel) -> str:
    proof = f": {channel.resolution.proof}" if channel.resolution.proof else ""
    return f"{channel.name} {channel.resolution.way.value}{proof}"
