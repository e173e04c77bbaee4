"""A program that is bound to numbers of a log, for those who measure how it is read."""

from collections.abc import Mapping

from runtime.program import Binding, Field, Kind, Origin, Program, Role, State, Unit

_ONE = Unit("1", 1.0)


def bound(paths: Mapping[str, str]) -> Program:
    """A program that does nothing but name `paths`, each for a state of its own."""
    states = tuple(
        State(
            name, Kind.CONTINUOUS, Role.BOTH, _ONE, -1e9, 1e9, 0.0, None, (), ("a", "b"), "",
            "s:1:1",
        )
        for name in paths
    )  # fmt: skip
    bindings = tuple(
        Binding(name, path, _ONE, 0.0, 1.0, 0.0, None, (), "s:1:1") for name, path in paths.items()
    )
    return Program(
        "bound", "", states, (), (), (), Field(tuple(paths), "formula", 0.0, (), (), (), None, ""),
        None, bindings, None, (), None, Origin("s", "", ""),
    )  # fmt: skip
