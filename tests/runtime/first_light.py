"""The scenario of the library that tests run, compiled once, cut to what they need."""

import dataclasses
from functools import cache
from pathlib import Path

from compiler.world.scenario import compile_scenario
from runtime.run import Run, run
from runtime.scenario import Scenario

FILE = Path(__file__).parents[2] / "specs" / "scenarios" / "first_light.yaml"


@cache
def whole() -> Scenario:
    """As it stands in the library."""
    return compile_scenario(FILE, lambda _what, _done, _of: None).scenario


def first_light(duration: float = 3.0, seed: int = 3) -> Scenario:
    """Cut to so many seconds."""
    return dataclasses.replace(whole(), duration=duration, seed=seed)


@cache
def short_run() -> Run:
    """Three seconds of it, with the light on the floor."""
    return run(first_light(), light_every=1.0)
