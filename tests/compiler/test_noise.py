"""Noise as a spec says it: numbers, quantities and expressions, in the state's unit."""

import math

import pytest

from compiler.compile import compile_loaded
from runtime.program import Program
from spec_schema.diagnostics import SpecError
from spec_schema.load import load_source
from spec_schema.source import Source

SPEC = """\
specc: 1
kind: behavior
name: roam
state:
  heading: {{unit: rad, domain: [-pi, pi], kind: periodic, role: both,
            relates: {{agent: nose, environment: north}}}}
control:
  wildness: {{unit: deg, domain: [0, 60], default: 20}}
constants:
  k: {{value: 1, unit: 1/s}}
field:
  formula: {{heading: -k*sin(heading)}}
noise: {{heading: {size}}}
output:
  wild: {{unit: deg, is: wildness}}
"""


def compiled(size: str) -> Program:
    source = Source("roam.yaml", SPEC.format(size=size))
    return compile_loaded(load_source(source), lambda *_: None).program


@pytest.mark.parametrize(
    ("size", "code"),
    [
        ("0.3", "0.3"),
        ("20 deg", repr(math.radians(20.0))),
        ("wildness", "wildness"),
        ("2*wildness", "2 wildness mul"),
        ("wildness*abs(sin(heading))", "wildness heading sin abs mul"),
    ],
)
def test_a_size_is_a_number_a_quantity_or_an_expression(size: str, code: str) -> None:
    (noise,) = compiled(size).noise

    assert (noise.state, noise.size.text) == ("heading", code)
    assert noise.origin.startswith("roam.yaml:13:")


@pytest.mark.parametrize(
    ("size", "words"),
    [("k", "rad"), ("20 cm", "rad"), ("-3", "standard deviation"), ("wild_ness", "wildness")],
)
def test_what_is_no_size_is_told(size: str, words: str) -> None:
    with pytest.raises(SpecError, match=words):
        compiled(size)
