"""Topics whose clock is off: all their series are late or early together."""

from verifier.diagnosis.altered import Effect
from verifier.diagnosis.candidates.inputs import delay_of, origin_of
from verifier.diagnosis.parameters import varying
from verifier.diagnosis.scene import Scene


def effects_on_clocks(scene: Scene) -> tuple[Effect, ...]:
    """Of topics that hold several series, but not all; one of a single input is the input's own.

    A topic that holds all driven states is left alone: its clock is off against the inputs just
    as theirs is against it.
    """
    inputs = [each.name for each in varying(scene.program, scene.needs)]
    states = [each.name for each in scene.observed]
    bindings = {binding.name: binding for binding in scene.program.bindings}
    paths = {name: bindings[name].path for name in (*inputs, *states) if name in bindings}
    effects = []
    for topic in dict.fromkeys(topic_of(path) for path in paths.values()):
        own = [name for name in paths if topic_of(paths[name]) == topic]
        mine = tuple(name for name in inputs if name in own)
        seen = tuple(name for name in states if name in own)
        if topic and len(seen) < len(states) and (seen or len(mine) > 1):
            origin = origin_of(bindings, own[0])
            effects.append(delay_of(mine, seen, f"clock of {topic}", scene.horizon, origin))
    return tuple(effects)


def topic_of(path: str) -> str:
    """The topic of a path; empty for the columns of a table, which share a clock.

    >>> topic_of("/odom.pose.position.x"), topic_of("speed")
    ('/odom', '')
    """
    return path.split(".", maxsplit=1)[0] if path.startswith("/") else ""
