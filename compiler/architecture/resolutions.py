"""How each channel of a body is resolved: as declared where several act on it, and checked."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Final, final

from compiler.architecture.bodies import Port
from compiler.architecture.exclusion.wiring import Wiring
from compiler.architecture.governing import exclusion_of
from compiler.architecture.parts import Part, Parts
from compiler.findings import Findings
from runtime.arbiter import Paradigm
from runtime.architecture import Channel, Command, Resolution, Way
from spec_schema.architecture import ResolutionSpec
from spec_schema.places import Path
from spec_schema.suggest import did_you_mean, nearest, there_are
from spec_schema.wording import listed

ALIKE: Final = frozenset({Way.SUM, Way.BLEND, Way.FUNCTION})
"""The ways that join several quantities into one."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Reach:
    """Who acts on a channel, in the order of the spec, and as what."""

    port: Port
    modes: Mapping[str, str]

    @property
    def nodes(self) -> tuple[str, ...]:
        """The names of the nodes."""
        return tuple(self.modes)


def channels_of(
    commands: Mapping[str, tuple[Command, ...]],
    parts: Parts,
    wiring: Wiring | None,
    findings: Findings,
) -> tuple[Channel, ...]:
    """Each channel of the body, resolved; findings for those that are not, or not so.

    wiring: what exclusion is proved from; None where nodes have mistakes.
    """
    if parts.body is None:
        return ()
    ports = parts.body.ports
    for name in parts.spec.channels:
        if name not in {port.name for port in ports}:
            known = [port.name for port in ports]
            remedy = did_you_mean(name, known) or there_are(known)
            message = f"the body has no channel '{name}'"
            findings.error("S340", ("channels", name), message, remedy, key=True)
    found = []
    for i, port in enumerate(ports):
        modes = {
            name: command.mode
            for name, many in commands.items()
            for command in many
            if command.channel == i
        }
        resolution = _resolved(Reach(port, modes), parts, wiring, findings)
        origin = resolution.origin
        found.append(
            Channel(port.name, port.unit, port.low, port.high, port.rest, resolution, origin)
        )
    return tuple(found)


def _resolved(reach: Reach, parts: Parts, wiring: Wiring | None, findings: Findings) -> Resolution:
    spec = parts.spec.channels.get(reach.port.name)
    path: Path = ("channels", reach.port.name)
    alone = Resolution(Way.SINGLE, _places(reach.nodes, parts), -1, "", "", findings.origin(path))
    if len(reach.nodes) < 2:
        if spec is not None and all(part.is_known for part in parts.nodes.values()):
            who = f"only {reach.nodes[0]} acts" if reach.nodes else "nobody acts"
            message = f"{who} on '{reach.port.name}': there is nothing to resolve"
            findings.warning("S347", path, message, "remove it", key=True)
        elif spec is None and not reach.nodes:
            findings.note(f"nobody acts on {reach.port.name}: it does what `rest` says")
        return alone
    if not all(part.is_known for part in parts.nodes.values()):
        return alone  # who else reaches it is not known
    if spec is None:
        if _is_misspelt(reach.port.name, parts):
            return alone  # which is told under `channels`
        return _unresolved(reach, parts, wiring, alone, findings)
    found = _declared(spec, reach, parts, wiring, path, findings)
    if found is not None and found.way in ALIKE:
        _check_alike(reach, path, findings)
    return found or alone


def _is_misspelt(channel: str, parts: Parts) -> bool:
    """Whether a resolution is probably meant for the channel, under another name."""
    assert parts.body is not None, "a channel is of a body"
    known = [port.name for port in parts.body.ports]
    return any(nearest(name, known) == channel for name in parts.spec.channels if name not in known)


def _unresolved(
    reach: Reach, parts: Parts, wiring: Wiring | None, alone: Resolution, findings: Findings
) -> Resolution:
    """What holds without a declaration: a combined behavior acts in the place of its parts."""
    pairs = conflicts(reach.nodes, parts)
    combined = {name: set(parts.nodes[name].spec.replaces) for name in reach.nodes}
    open_pairs = [p for p in pairs if not any(set(p) <= many for many in combined.values())]
    if not open_pairs:
        if wiring is None:
            return alone  # what acts when is not known
        answer = exclusion_of(wiring, [(parts.index(a), parts.index(b)) for a, b in pairs])
        if not answer.is_proved:
            name = next(name for name in reach.nodes if combined[name])
            findings.error("S345", ("nodes", name, "replaces"), answer.sentence, answer.help)
            return alone
        proof = answer.sentence or "a combined behavior acts in the place of the other"
        return Resolution(Way.EXCLUSIVE, _ordered(reach.nodes, parts), -1, "", proof, alone.origin)
    first, second = open_pairs[0]
    message = f"{first} and {second} both act on '{reach.port.name}'"
    more = len(reach.nodes) - 2
    if more:
        message = f"{listed(reach.nodes, last='and')} all act on '{reach.port.name}'"
    remedy = _ways(reach, parts)
    findings.error("S342", ("nodes", second), message, remedy, key=True)
    return alone


def _ways(reach: Reach, parts: Parts) -> str:
    names = ", ".join(reach.nodes)
    arbiters = [name for name, part in parts.nodes.items() if part.spec.arbiter is not None]
    ways = [f"priority: [{names}]", f"sum: [{names}]"]
    if arbiters:
        ways.insert(0, f"exclusive: {arbiters[0]}")
    shown = listed([f"{{{way}}}" for way in ways])
    return f"say under `channels` how it is resolved, such as '{reach.port.name}: ...' with {shown}"


def conflicts(nodes: tuple[str, ...], parts: Parts) -> list[tuple[str, str]]:
    """Pairs of nodes that no combined behavior keeps from acting at once."""
    apart = {frozenset(pair) for name in nodes for pair in _replaced(name, parts)}
    return [
        (first, second)
        for i, first in enumerate(nodes)
        for second in nodes[i + 1 :]
        if frozenset((first, second)) not in apart
    ]


def _replaced(name: str, parts: Parts) -> Iterator[tuple[str, str]]:
    """The pairs that never act at once: a combined behavior, and each of its parts.

    And another one that combines some of its parts only, or the same.
    """
    mine = set(parts.nodes[name].spec.replaces)
    for other, part in parts.nodes.items():
        theirs = set(part.spec.replaces)
        if other in mine or (other != name and theirs and theirs <= mine):
            yield name, other


def _declared(
    spec: ResolutionSpec,
    reach: Reach,
    parts: Parts,
    wiring: Wiring | None,
    path: Path,
    findings: Findings,
) -> Resolution | None:
    origin = findings.origin(path)
    places = _places(_ordered_names(reach.nodes, parts), parts)
    if spec.function is not None:
        return Resolution(Way.FUNCTION, places, -1, spec.function, "", origin)
    if spec.sum is not None or spec.priority is not None:
        key = "sum" if spec.sum is not None else "priority"
        named = spec.sum if spec.sum is not None else spec.priority or ()
        if not _names_all(named, reach, parts, (*path, key), findings):
            return None
        if key == "priority":
            _check_layers(named, parts, (*path, key), findings)
        combined = [name for name in reach.nodes if name not in named]
        return Resolution(Way(key), _places((*combined, *named), parts), -1, "", "", origin)
    return _governed(spec, reach, parts, wiring, path, findings)


def _governed(
    spec: ResolutionSpec,
    reach: Reach,
    parts: Parts,
    wiring: Wiring | None,
    path: Path,
    findings: Findings,
) -> Resolution | None:
    """What an arbiter sees to: a blend, or that no two of them act at once."""
    origin = findings.origin(path)
    places = _ordered(reach.nodes, parts)
    key = "exclusive" if spec.exclusive is not None else "blend"
    place = -1
    if spec.exclusive is not None and len(spec.exclusive) != 1:
        if not _names_all(spec.exclusive, reach, parts, (*path, key), findings):
            return None
    else:
        name = spec.exclusive[0] if spec.exclusive is not None else spec.blend or ""
        arbiter = _arbiter(name, parts, (*path, key), findings)
        if arbiter is None or arbiter.arbiter is None:
            return None
        place = parts.index(name)
        if key == "blend":
            _check_weighed(arbiter, reach, (*path, key), parts, findings)
            return Resolution(Way.BLEND, places, place, "", "", origin)
    if wiring is None:
        return None  # what acts when is not known
    pairs = [
        (parts.index(first), parts.index(second)) for first, second in conflicts(reach.nodes, parts)
    ]
    answer = exclusion_of(wiring, pairs)
    if not answer.is_proved:
        findings.error("S345", (*path, key), answer.sentence, answer.help)
        return None
    return Resolution(Way.EXCLUSIVE, places, place, "", answer.sentence, origin)


def _names_all(
    named: tuple[str, ...], reach: Reach, parts: Parts, path: Path, findings: Findings
) -> bool:
    """Whether a resolution names the nodes that reach the channel, once, and none else."""
    wrong = False
    for i, name in enumerate(named):
        if name in named[:i]:
            findings.error("S343", (*path, i), f"'{name}' stands here twice", "name it once")
        elif name not in parts.nodes:
            remedy = did_you_mean(name, reach.nodes) or there_are(reach.nodes)
            findings.error("S322", (*path, i), f"no node is named '{name}'", remedy)
        elif name not in reach.nodes:
            remedy = f"leave it out: {listed(reach.nodes, last='and')} do"
            message = f"{name} does not act on '{reach.port.name}'"
            findings.error("S343", (*path, i), message, remedy)
        else:
            continue
        wrong = True
    missing = [
        name
        for name in reach.nodes
        if name not in named and not set(named) <= set(parts.nodes[name].spec.replaces)
    ]
    if missing and not wrong:
        message = f"{missing[0]} acts on '{reach.port.name}', too"
        findings.error(
            "S343", path, message, f"name it as well: [{', '.join((*named, missing[0]))}]"
        )
    return not wrong and not missing


def _arbiter(name: str, parts: Parts, path: Path, findings: Findings) -> Part | None:
    arbiters = [known for known, part in parts.nodes.items() if part.spec.arbiter is not None]
    if name in arbiters:
        return parts.nodes[name]
    remedy = did_you_mean(name, arbiters) or there_are(arbiters)
    if name in parts.nodes:
        others = "list two nodes or more, or " if path[-1] == "exclusive" else ""
        message = f"'{name}' is no arbiter"
        findings.error("S343", path, message, f"{others}name an arbiter: {remedy}")
    else:
        findings.error("S322", path, f"no node is named '{name}'", remedy)
    return None


def _check_weighed(
    arbiter: Part, reach: Reach, path: Path, parts: Parts, findings: Findings
) -> None:
    named = {name for acting in arbiter.spec.choices.values() for name in acting.act}
    for name in reach.nodes:
        if name not in named and not parts.nodes[name].spec.replaces:
            message = f"no choice of {arbiter.name} names {name}, so it has no weight"
            findings.error("S343", path, message, f"name it in a choice of {arbiter.name}")


def _check_layers(named: tuple[str, ...], parts: Parts, path: Path, findings: Findings) -> None:
    """A finding where layers that govern the nodes stand in another order than the priority."""
    for part in parts.nodes.values():
        if part.arbiter is None or part.arbiter.paradigm is not Paradigm.SUBSUMPTION:
            continue
        order = []
        for rule in part.arbiter.rules:
            acting = part.spec.choices.get(part.arbiter.choices[rule.choice])
            order += [name for name in (acting.act if acting else ()) if name in named]
        order = list(dict.fromkeys(order))
        ranked = [name for name in named if name in order]
        if ranked != order:
            message = f"the layers of {part.name} are in another order: {', '.join(order)}"
            findings.warning("S346", path, message, "put the highest layer first")


def _check_alike(reach: Reach, path: Path, findings: Findings) -> None:
    modes = dict.fromkeys(reach.modes.values())
    if len(modes) > 1:
        (one, mode), (other, unlike) = _unlike(reach)
        message = (
            f"{one} gives '{reach.port.name}' a {mode} and {other} "
            f"{'an' if unlike == 'acceleration' else 'a'} {unlike}: they can't be joined"
        )
        remedy = "realize the channel as the same by both, or resolve it by `priority`"
        findings.error("S344", path, message, remedy, key=True)


def _unlike(reach: Reach) -> tuple[tuple[str, str], tuple[str, str]]:
    items = list(reach.modes.items())
    return items[0], next(item for item in items if item[1] != items[0][1])


def _ordered_names(nodes: tuple[str, ...], parts: Parts) -> tuple[str, ...]:
    """Combined behaviors first."""
    combined = [name for name in nodes if parts.nodes[name].spec.replaces]
    return (*combined, *(name for name in nodes if name not in combined))


def _ordered(nodes: tuple[str, ...], parts: Parts) -> tuple[int, ...]:
    return _places(_ordered_names(nodes, parts), parts)


def _places(names: tuple[str, ...], parts: Parts) -> tuple[int, ...]:
    return tuple(parts.index(name) for name in names)
