"""At which values of its controls a module is shown: as the architecture sets them."""

from runtime.architecture import Architecture, Node
from runtime.program import Control
from specc.book.manifest import Setting

DEFAULT = "default"
"""The setting of what nobody sets otherwise."""


def settings_of(
    architecture: Architecture, node: Node
) -> tuple[tuple[Setting, ...], frozenset[str]]:
    """The settings of a module's controls, and the controls that a signal moves.

    The first is what holds while no choice sets anything; each other one is what choices set.
    """
    behaviors, arbiters = architecture.programs, architecture.arbiters
    spec = behaviors[node.behavior] if node.behavior >= 0 else arbiters[node.arbiter]
    controls = {control.name: control for control in spec.controls}
    own = {name: control.default for name, control in controls.items()}
    own |= {w.entry: w.value for w in node.inputs if w.signal < 0 and w.entry in controls}
    moving = frozenset(w.entry for w in node.inputs if w.signal >= 0 and w.entry in controls)
    found: dict[tuple[tuple[str, float], ...], list[str]] = {}
    for name, values in _set_by_choices(architecture, node):
        found.setdefault(tuple((own | values).items()), []).append(name)
    by_nobody = tuple(own.items())
    settings = [Setting(DEFAULT, tuple(found.pop(by_nobody, ())), dict(by_nobody))]
    for held, names in found.items():
        settings.append(Setting(_name(controls, own, dict(held)), tuple(names), dict(held)))
    return tuple(settings), moving


def _set_by_choices(architecture: Architecture, node: Node) -> list[tuple[str, dict[str, float]]]:
    """For each choice that sets controls of the node: `arbiter.choice`, and what it sets."""
    place = architecture.nodes.index(node)
    return [
        (f"{other.name}.{choice.name}", {s.entry: s.value for s in choice.sets if s.node == place})
        for other in architecture.nodes
        for choice in other.choices
        if any(s.node == place for s in choice.sets)
    ]


def _name(controls: dict[str, Control], own: dict[str, float], values: dict[str, float]) -> str:
    """What differs from the default, as `speed=0.4,wildness=0.6`, in the controls' own units."""
    changed = [name for name, value in values.items() if value != own[name]]
    return ",".join(f"{name}={values[name] / controls[name].unit.scale:.6g}" for name in changed)
