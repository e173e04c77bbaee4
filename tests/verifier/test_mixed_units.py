"""Units in each other's place."""

from itertools import combinations

import pytest

from runtime.program import Unit
from spec_schema.units import parse_unit
from verifier.mixed_units import alternatives

READ = "1 % rad deg rad/s deg/s rpm turn m cm mm m/s mm/s km/h cm^2 m/s^2 s ms kg Pa bar l m^3 V K"


def unit(text: str) -> Unit:
    return Unit(text, parse_unit(text).scale)


@pytest.mark.parametrize("text", READ.split())
def test_no_unit_is_thought_of_twice_nor_the_one_that_was_read(text: str) -> None:
    found = [(each.factor, each.offset) for each in alternatives(unit(text))]

    assert (1.0, 0.0) not in found
    for one, other in combinations(found, 2):
        assert one != pytest.approx(other, rel=1e-6)


@pytest.mark.parametrize("text", READ.split())
def test_a_unit_that_is_to_be_written_mends_what_was_read_in_another(text: str) -> None:
    """A log that holds 3 of it was read as 3 of another."""
    read = unit(text)
    for each in alternatives(read):
        if each.written:
            assert each.factor * 3.0 * read.scale == pytest.approx(unit(each.written).scale * 3.0)


@pytest.mark.parametrize(("long", "short"), [("degree", "deg"), ("radian", "rad"), ("kelvin", "K")])
def test_a_unit_that_is_spelled_out_has_the_alternatives_of_its_symbol(
    long: str, short: str
) -> None:
    found = [{(e.factor, e.offset) for e in alternatives(unit(text))} for text in (long, short)]

    assert found[0] == found[1]
    assert found[0]


def test_a_share_is_no_angle() -> None:
    assert [each.words for each in alternatives(unit("%"))] == ["shares for percent"]
