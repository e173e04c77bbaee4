"""How old is what a node acts on: told in advance, and counted instant by instant."""

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from compiler.architecture.ages import at_a_tick
from compiler.check import check

PARTS = Path(__file__).parents[2] / "golden" / "bad" / "parts"
BODY = """
specc: 1
kind: body
name: late
shape: {{circle: 12 cm}}
mass: 3 kg
drive: {{differential: {{track: 20 cm, speed: 0.5 m/s, turn: 3 rad/s}}}}
sensors: {{ahead: {{senses: range, reach: 2 m, every: {every}, latency: {latency}}}}}
"""
NODES = """
specc: 1
kind: architecture
name: tried
body: late.yaml
nodes:
  {more}avoid: {{behavior: {parts}/avoid.yaml, period: 50 ms, response_time: 50 ms,
    sense: {{clearance: {{from: {read}, outside: clip}}}}}}
"""
SMOOTH = """smooth: {module: "modules:smooth", period: 100 ms, response_time: 100 ms,
    sense: {range: ahead.range}, tells: {range: m}}
  """


@given(every=st.integers(1, 60), latency=st.integers(0, 150), period=st.integers(1, 60))
def test_the_oldest_reading_at_a_tick_is_that_of_going_through_all_ticks(
    every: int, latency: int, period: int
) -> None:
    # An independent way: one tick after the other, once readings arrive, over a whole cycle.
    ticks = [t for t in range(0, latency + every * period + period, period) if t >= latency]
    oldest = max(t - max(s for s in range(0, t + 1, every) if s + latency <= t) for t in ticks)

    told = at_a_tick(every / 1000, latency / 1000, period / 1000)

    assert told == pytest.approx(oldest / 1000)


def answered(folder: Path, every: str, latency: str, *, smoothed: bool = False) -> list[str]:
    """What is said of the time of a node whose field changes at 1 per second: 0.5 s are allowed."""
    (folder / "late.yaml").write_text(BODY.format(every=every, latency=latency))
    read = "smooth.range" if smoothed else "ahead.range"
    text = NODES.format(parts=PARTS, read=read, more=SMOOTH if smoothed else "")
    (folder / "tried.yaml").write_text(text)
    return [found.message for found in check(folder / "tried.yaml") if found.code == "S353"]


@pytest.mark.parametrize(
    ("every", "latency", "late"),
    [
        ("50 ms", "400 ms", []),  # 0.4 + 0.05 + 0.05 s, at the very limit
        ("50 ms", "410 ms", ["550 ms"]),
        ("450 ms", "0 s", []),  # up to 0.4 s old at ticks of 50 ms
        ("500 ms", "0 s", ["550 ms"]),
        ("50 ms", "20 s", ["20.1 s"]),
    ],
)
def test_what_a_sensor_takes_counts_in_the_time_of_an_answer(
    tmp_path: Path, every: str, latency: str, late: list[str]
) -> None:
    told = answered(tmp_path, every, latency)

    assert [text.split(" late")[0].removeprefix("avoid answers up to ") for text in told] == late


def test_what_passes_through_a_node_is_older_by_what_that_takes(tmp_path: Path) -> None:
    # 0.1 s late and up to 0.05 s on the board: 0.1 + 0.2 through `smooth`, at ticks of 0.05 s.
    assert answered(tmp_path, "100 ms", "200 ms", smoothed=True) == []
    told = answered(tmp_path, "100 ms", "300 ms", smoothed=True)

    assert len(told) == 1
    assert "550 ms late, 450 ms of it since ahead sampled (through smooth)" in told[0]
