"""The scenes of the fidelity tests, which serve here as well."""

import importlib.util
from pathlib import Path
from types import ModuleType

import pytest

_PATH = Path(__file__).parents[1] / "fidelity" / "conftest.py"


@pytest.fixture(scope="session")
def scenes() -> ModuleType:
    """Robots and programs of tests/verifier/fidelity/conftest.py."""
    spec = importlib.util.spec_from_file_location("fidelity_scenes", _PATH)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
