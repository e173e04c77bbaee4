"""Stamps that are off: of a topic, of one driven state, or of all states against all inputs."""

from typing import TypeAlias

from verifier.diagnosis.altered import Effect
from verifier.diagnosis.candidates.inputs import delay_of, origin_of
from verifier.diagnosis.parameters import varying
from verifier.diagnosis.scene import Scene

Group: TypeAlias = tuple[tuple[str, ...], tuple[str, ...]]
"""Inputs and states that are late together."""


def effects_on_clocks(scene: Scene) -> tuple[Effect, ...]:
    """Of topics, of all inputs, of all states, and of each state.

    All states that are late together leave the same trace as all inputs that act late together:
    both are tried, so that each is told beside the other.
    """
    inputs = tuple(each.name for each in varying(scene.program, scene.needs))
    states = tuple(each.name for each in scene.observed)
    bindings = {binding.name: binding for binding in scene.program.bindings}
    paths = {name: bindings[name].path for name in (*inputs, *states) if name in bindings}
    topics = _topics(inputs, states, paths)
    groups: list[Group] = [(inputs, ())] if len(inputs) > 1 else []
    if not scene.program.field.is_map:
        groups += [((), states), *(((), (name,)) for name in states)]
    for group in groups:
        topics.setdefault(group, "")
    return tuple(
        delay_of(mine, seen, scene.horizon, origin_of(bindings, (*mine, *seen)[0]), topic=topic)
        for (mine, seen), topic in topics.items()
    )


def _topics(
    inputs: tuple[str, ...], states: tuple[str, ...], paths: dict[str, str]
) -> dict[Group, str]:
    """Topics that hold several series, but not all, by these.

    One of a single input is the input's own. A topic that holds all states is left alone: its
    clock is off against the inputs just as theirs is against it.
    """
    found = {}
    for topic in dict.fromkeys(topic_of(path) for path in paths.values()):
        own = [name for name in paths if topic_of(paths[name]) == topic]
        mine = tuple(name for name in inputs if name in own)
        seen = tuple(name for name in states if name in own)
        if topic and len(seen) < len(states) and (seen or len(mine) > 1):
            found[mine, seen] = topic
    return found


def topic_of(path: str) -> str:
    """The topic of a path; empty for the columns of a table, which share a clock.

    >>> topic_of("/odom.pose.position.x"), topic_of("speed")
    ('/odom', '')
    """
    return path.split(".", maxsplit=1)[0] if path.startswith("/") else ""
