"""The recording of a scenario: every node of every robot judged by its own spec."""

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

from runtime import architecture_artifact
from runtime.arbiter import Arbiter
from runtime.architecture import Architecture, Node
from runtime.container import ArtifactError
from runtime.program import Program
from specc.faults import fault
from specc.spec_finding import Found
from specc.verifying import Verification
from specc.verifying_architecture import examine_nodes
from verifier.architectures.recorded import read_nodes
from verifier.traces.files.open_log import attached_programs


def attached_architectures(trace: Path) -> dict[str, Architecture]:
    """By robot, the architectures that a recording carries; none where it is of something else.

    Raises:
        SpecError: one of them is damaged (V332).
    """
    if trace.suffix.lower() != ".mcap" or not trace.is_file():
        return {}
    found: dict[str, Architecture] = {}
    for name, data in attached_programs(trace):
        try:
            if architecture_artifact.is_architecture(data):
                found[name.removesuffix(".specc")], _ = architecture_artifact.from_bytes(data)
        except ArtifactError as error:
            message = f"the attached {name} can't be used: {error}"
            raise fault("V332", trace, message, "record it again") from error
    return found


def verify_recording(
    trace: Path,
    architectures: Mapping[str, Architecture],
    *,
    only_verdict: bool = False,
    progress: Callable[[str], None] | None = None,
) -> Iterator[Verification]:
    """A verdict on each node that is a behavior or an arbiter, and that can be judged.

    Raises:
        SpecError: the recording can't be read, or holds no node that can be judged (V391).
    """
    tell = progress or (lambda _phase: None)
    tell("reading")
    robots = read_nodes(trace, architectures)
    tell("judging")
    is_judged = False
    why = []
    for robot, architecture in architectures.items():
        for place, made in enumerate(
            examine_nodes(architecture, robots[robot], str(trace), only_verdict=only_verdict)
        ):
            if made.examination is None:
                why.append(f"{robot}.{made.name}: {made.why}")
                continue
            is_judged = True
            how = f"{robot}.specc, attached to the trace: {made.name} by {made.spec}"
            spec = _spec_of(architecture, architecture.nodes[place])
            yield Verification(Found(spec, how), made.examination, None)
    if not is_judged:
        raise fault("V391", trace, "no node of it can be judged", "; ".join(why))


def _spec_of(architecture: Architecture, node: Node) -> Program | Arbiter:
    if node.behavior >= 0:
        return architecture.programs[node.behavior]
    return architecture.arbiters[node.arbiter]
