"""A faulty part is taken out, and the rest is checked on."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from compiler.check import check_examined
from spec_schema.diagnostics import SpecError
from spec_schema.load import examine_source
from spec_schema.places import as_written
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


@pytest.mark.parametrize(
    "bad", ["domain: [1, -1]", "domain: [-9, 9], hold: far", "domian: [-9, 9]"]
)
@pytest.mark.parametrize(
    "field",
    [
        'formula: {x: "goal - x", y: -y}',
        "sketch: {over: [x, y], points: [{is: attractor, at: [7, 0]}]}",
        "arrows: {over: [x, y], at: [[7, 0], [0, 1], [1, 0]], go: [[1, 0], [1, 1], [0, 1]]}",
    ],
)
def test_the_domain_of_a_stand_in_is_never_spoken_of(bad: str, field: str) -> None:
    """What stands in for a faulty declaration is ours: no message may follow from it."""
    text = GOOD.replace(
        "control:",
        f"  y: {{unit: m, {bad}, role: both, relates: {{agent: a, environment: b}}}}\ncontrol:",
    )
    text = text.replace('formula: {x: "goal - x"}', field).replace("[-1, 1], role", "[-9, 9], role")
    text += "fidelity: {tolerance: {x: 0.1 m, y: 0.1 m}, horizon: 1 s, region: {y: [-5, 5]}}\n"

    examined = examine_source(Source("s.yaml", text))

    own = {mistake.span for mistake in examined.mistakes}
    found = [d for d in check_examined(examined) if d.span not in own]
    assert [d for d in found if "y" in d.message.split() or d.code[:3] in {"S25", "S26"}] == []
    assert not any("-1" in f"{d.message} {d.help}" for d in found)


def test_a_formula_is_checked_although_a_declaration_that_it_reads_is_faulty() -> None:
    text = GOOD.replace(", relates: {agent: a, environment: b}", "").replace("goal - x", "sin(x)")

    codes = [found.code for found in check_examined(examine_source(Source("s.yaml", text)))]

    assert codes == ["S101", "S142"]


def test_without_states_nothing_is_left() -> None:
    examined = examine_source(Source("s.yaml", GOOD.replace("  x: {unit", "  - {unit")))

    assert examined.loaded is None
    assert examined.mistakes


SKETCH = (
    GOOD.split("control:", maxsplit=1)[0]
    + """  y: {unit: m, domain: [-1, 1], role: both, relates: {agent: a, environment: b}}
field:
  sketch:
    over: [x, y]
    points:
"""
)
FAULTY = "      - {is: attractor, at: [0]}\n"
SOUND = "      - {is: attractor, at: [0, 0]}\n"
LATE = "      - {is: attractor, at: [0, 0], rates: -1}\n"


@given(st.lists(st.sampled_from([FAULTY, SOUND]), max_size=14))
def test_a_mistake_after_faulty_items_is_told_at_its_own_item(before: list[str]) -> None:
    found = check_examined(examine_source(Source("s.yaml", SKETCH + "".join(before) + LATE)))

    line = len((SKETCH + "".join(before)).splitlines()) + 1
    late = next(d for d in found if d.code == "S212")
    assert late.path == f"$.field.sketch.points[{len(before)}].rates"
    assert late.span is not None
    assert late.span.line == line


def test_claims_after_a_faulty_one_are_told_at_their_own_places() -> None:
    expect = "expect:\n  - {one attractor: 3}\n  - one atractor\n"
    found = check_examined(examine_source(Source("s.yaml", GOOD + expect)))

    places = [d.path for d in found if d.path.startswith("$.expect")]
    assert places == ["$.expect[0]['one attractor']", "$.expect[1]['one atractor']"]


def test_what_other_mistakes_hide_is_told_with_them_but_not_what_they_cause() -> None:
    items = "      - {is: atractor, at: [0, [1]]}\n" + FAULTY
    found = examine_source(Source("s.yaml", SKETCH + items)).mistakes

    assert {d.path for d in found} == {
        "$.field.sketch.points[0].is",
        "$.field.sketch.points[0].at[1]",
        "$.field.sketch.points[1].at",
    }


def test_items_taken_out_in_turn_lead_back_to_the_text() -> None:
    kept = {("a",): (1, 3), ("a", 3, "b"): (2,)}

    assert as_written(("a", 1, "b", 0, "c"), kept) == ("a", 3, "b", 2, "c")


def test_nothing_is_refused_without_a_word() -> None:
    with pytest.raises(AssertionError):
        SpecError([])
