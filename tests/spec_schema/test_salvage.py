"""A faulty part is taken out, and the rest is checked on."""

from spec_schema.load import examine_source
from spec_schema.source import Source

GOOD = """specc: 1
kind: behavior
name: n
state:
  x: {unit: m, domain: [-1, 1], role: both, relates: {agent: a, environment: b}}
control:
  goal: {unit: m, domain: [-1, 1], default: 0}
field:
  formula: {x: "goal - x"}
"""


def test_a_sound_spec_loses_nothing() -> None:
    examined = examine_source(Source("s.yaml", GOOD))

    assert (examined.mistakes, examined.lost) == ((), frozenset())


def test_an_optional_part_goes_alone() -> None:
    examined = examine_source(Source("s.yaml", GOOD + "table: {method: quadratic}\n"))

    assert len(examined.mistakes) == 1
    assert examined.loaded is not None
    assert examined.lost == frozenset()


def test_a_declaration_that_is_wrong_goes_whole_and_is_remembered() -> None:
    examined = examine_source(
        Source(
            "s.yaml",
            GOOD.replace("default: 0", "default: high").replace(
                "domain: [-1, 1], default", "domain: 3, default"
            ),
        )
    )

    assert examined.loaded is not None
    assert examined.lost == {"goal"}


def test_without_states_nothing_is_left() -> None:
    examined = examine_source(Source("s.yaml", GOOD.replace("  x: {unit", "  - {unit")))

    assert examined.loaded is None
    assert examined.mistakes
