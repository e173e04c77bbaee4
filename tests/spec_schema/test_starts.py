"""Words and places of bodies and scenarios: each mistake is told once, with what to write."""

import pytest

from spec_schema.load import examine_source
from spec_schema.source import Source

SCENARIO = """specc: 1
kind: scenario
name: x
world: w.yaml
robots: {r: {architecture: a.yaml, at: AT}}
duration: 1 s
"""
BODY = """specc: 1
kind: body
name: x
shape: {polygon: [[0, 0], [1], [0, 1]]}
mass: 1 kg
drive: {differential: {track: 20 cm, speed: 0.5 m/s, turn: 3 rad/s}}
rest: {base.speed: STOP}
"""
PLACE = "write e.g. 'at: [1 m, 1 m, 90 deg]', or 'at: random'"
OWN = 'write a number in the variable\'s own unit, or one with its unit: "0.05 m"'


def told(text: str) -> list[tuple[str, str, str]]:
    found = examine_source(Source("x.yaml", text)).mistakes
    return [(each.code, each.message, each.help) for each in found]


@pytest.mark.parametrize(
    ("written", "code", "message", "remedy"),
    [
        ("yes", "S103", "expected a place or random, got the text 'yes'", PLACE),
        ("{x: 1}", "S103", "expected a place or random, got a mapping", PLACE),
        ("[1]", "S262", "a place is [x, y] or [x, y, direction]: 2 or 3 values, not 1", PLACE),
        ("[1, true]", "S103", "expected a number or a quantity, got true", OWN),
    ],
)
def test_a_start_that_is_none_is_one_mistake(
    written: str, code: str, message: str, remedy: str
) -> None:
    assert told(SCENARIO.replace("AT", written)) == [(code, message, remedy)]


@pytest.mark.parametrize("written", ["random", "[1, 2]", "[1 m, 2 m, 90 deg]"])
def test_a_place_and_random_are_starts(written: str) -> None:
    assert not told(SCENARIO.replace("AT", written))


def test_items_and_words_of_a_user_s_own_keys_are_called_by_what_they_are() -> None:
    example = "write e.g. 'polygon: [[0, 0], [0.2, 0], [0.1, 0.2]]'"

    assert told(BODY) == [
        ("S262", "number 2 of 'polygon' takes at least 2 (got 1)", example),
        ("S104", "unknown word 'STOP'", "did you mean 'stop'?\nexpected one of: stop, hold, coast"),
    ]
