"""Specs as text for the compiler's tests, and the compiler without a progress bar."""

from collections.abc import Callable
from typing import TypeAlias

import pytest

from compiler.compile import Compiled, compile_loaded
from spec_schema.load import load_source
from spec_schema.source import Source

Compile: TypeAlias = Callable[[str], Compiled]


@pytest.fixture(scope="session")
def compiled() -> Compile:
    """Compile a spec given as text."""

    def run(text: str) -> Compiled:
        loaded = load_source(Source("spec.yaml", text))
        return compile_loaded(loaded, lambda _what, _done, _of: None)

    return run


@pytest.fixture(scope="session")
def behavior() -> Callable[..., str]:
    """The text of a spec of plain numbers over [-1, 1], with a formula for each state."""

    def text(rates: dict[str, str], controls: tuple[str, ...] = (), more: str = "") -> str:
        relates = "relates: {agent: the base, environment: the goal}"
        states = "".join(
            f'  {name}: {{unit: "1", domain: [-1, 1], role: both, {relates}}}\n' for name in rates
        )
        settings = "".join(
            f'  {name}: {{unit: "1", domain: [0.5, 2], default: 1}}\n' for name in controls
        )
        formulas = "".join(f'    {name}: "{rate}"\n' for name, rate in rates.items())
        control = f"control:\n{settings}" if controls else ""
        return (
            f"specc: 1\nkind: behavior\nname: tested\nstate:\n{states}{control}"
            f"field:\n  formula:\n{formulas}{more}"
        )

    return text
