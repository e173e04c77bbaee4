"""The house as a whole: its names, its version, its start-up, its language and its machine."""

import importlib
import resource
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

import specc
from runtime import code
from spec_schema.expressions import tree

ROOT = Path(__file__).parents[1]
HEAVY = ("numba", "scipy", "matplotlib", "pint", "sympy", "networkx", "rosbags", "mcap", "sklearn")


def imported_by(statement: str) -> set[str]:
    """The top-level modules that a fresh interpreter has after `statement`."""
    program = f"import sys; {statement}; print(*{{name.partition('.')[0] for name in sys.modules}})"
    command = [sys.executable, "-c", program]
    return set(subprocess.run(command, capture_output=True, text=True, check=True).stdout.split())


def test_every_public_name_has_a_home_that_has_it() -> None:
    for name, home in specc.HOMES.items():
        assert hasattr(importlib.import_module(home), name)


def test_an_unknown_name_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="gaol"):
        specc.gaol  # noqa: B018  the look-up is what is tested


def test_importing_specc_loads_nothing_heavy() -> None:
    assert not imported_by("import specc") & {*HEAVY, "numpy", "pydantic"}


def test_checking_a_spec_loads_nothing_heavy() -> None:
    assert not imported_by("import compiler.check") & set(HEAVY)


def test_drawing_is_not_loaded_to_compute_a_portrait() -> None:
    assert not imported_by("import verifier.topology.portrait") & {"matplotlib", "networkx", "mcap"}


def test_help_starts_fast() -> None:
    def seconds(*arguments: str) -> float:
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run([sys.executable, *arguments], capture_output=True, check=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime

    # Designed for 0.35 s above a bare interpreter. Of the processor: the machine may be busy.
    command = ("-c", "from specc.cli import main; main(['--help'])")
    assert min(seconds(*command) - seconds("-c", "pass") for _ in range(3)) < 1.0


def test_every_spec_of_the_library_is_shipped_as_a_template() -> None:
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text())
    shipped = settings["tool"]["hatch"]["build"]["targets"]["wheel"]["force-include"]
    library = {
        p.relative_to(ROOT).as_posix()
        for p in (ROOT / "specs").rglob("*")
        if p.suffix in {".yaml", ".py"} and "recordings" not in p.parts
    }

    assert shipped.keys() == library


def test_the_language_and_the_machine_have_the_same_operations() -> None:
    assert code.ARITY == tree.ARITY
