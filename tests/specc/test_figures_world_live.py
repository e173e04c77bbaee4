"""The view in the terminal: it fits, tells who acts, keeps time, and cleans up."""

import re
from io import StringIO
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.console import Console

from runtime.arrays import Array, Integers
from specc.figures.braille import Canvas
from specc.figures.live import View, live_view
from specc.figures.live_lines import live_lines
from specc.figures.live_window import has_display, open_window
from tests.specc.world_scenes import scene, trails

BOX = (0.0, 0.0, 4.0, 2.0)
SHOW_CURSOR = "\x1b[?25h"


def terminal(width: int = 80, height: int = 24) -> tuple[Console, StringIO]:
    out = StringIO()
    return Console(file=out, width=width, height=height, force_terminal=True), out


def shown_on(console: Console, speed: float | None = None, **clock: Any) -> None:
    """All of a run on a console."""
    run = trails(12.0)
    with live_view(scene(), run.doers, console, speed=speed, **clock) as show:
        for row, now in enumerate(run.times.tolist()):
            show(now, run.things[row], run.robots[row], run.acting[row])


class Clock:
    """A clock that goes on only by sleeping."""

    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now

    def sleep(self, seconds: float) -> None:
        self.now += seconds


def test_a_dot_is_where_braille_has_it() -> None:
    canvas = Canvas(2, 1, (0.0, 0.0, 3.0, 3.0), ascii_only=False)

    canvas.dots(np.array([[0.0, 3.0], [1.0, 0.0], [2.0, 2.0]]))

    assert canvas.text().plain == "⢁⠂"  # dots 1 and 8; dot 2


def test_what_is_outside_is_not_drawn() -> None:
    canvas = Canvas(10, 5, BOX, ascii_only=False)

    canvas.dots(np.array([[-1.0, 1.0], [9.0, 1.0], [1.0, -9.0], [1.0, 9.0]]))
    canvas.letter(9.0, 9.0, "x")

    assert canvas.text().plain.strip() == ""


@given(st.integers(0, 2**32 - 1), st.lists(st.text("abc", min_size=1, max_size=8), max_size=9))
def test_words_take_only_places_where_nothing_was(seed: int, words: list[str]) -> None:
    chance = np.random.default_rng(seed)
    canvas = Canvas(20, 10, (0.0, 0.0, 2.0, 2.0), ascii_only=False)
    canvas.dots(chance.uniform(0.0, 2.0, (30, 2)))
    before, written = canvas.text().plain, 0

    for word in words:
        x, y = chance.uniform(0.0, 2.0, 2).tolist()
        written += len(word) * canvas.word((x, y), word, reach=0.1)

    changed = [(a, b) for a, b in zip(before, canvas.text().plain, strict=True) if a != b]
    assert all(a == " " and b in "abc" for a, b in changed)
    assert len(changed) == written


def test_robots_lights_and_things_have_their_names() -> None:
    console, _ = terminal(120, 40)
    run, out = trails(), StringIO()
    moment = View(scene(), run.doers, console).at(1.0, run.things[0], run.robots[0], run.acting[0])

    Console(file=out, width=120, height=40, color_system=None).print(moment)

    words = set(re.findall(r"\w+", out.getvalue()))
    assert {"bulb", "torch", "desk", "crate", "r"} <= words


@pytest.mark.parametrize("size", [(80, 24), (44, 8), (30, 6), (200, 60)])
def test_it_fits_the_terminal(size: tuple[int, int]) -> None:
    console, out = terminal(*size)
    run = trails()
    moment = View(scene(), run.doers, console).at(1.0, run.things[9], run.robots[9], run.acting[9])
    plain = Console(file=out, width=size[0], height=size[1], color_system=None)

    plain.print(moment)

    lines = out.getvalue().splitlines()
    assert len(lines) <= size[1]
    assert max(map(len, lines)) <= size[0]


def test_it_tells_the_time_and_who_acts(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NO_COLOR", "1")
    console, out = terminal()

    shown_on(console)

    last = out.getvalue()
    assert "12.0 s" in last
    assert "avoid" in last
    assert not re.search(r"\x1b\[[0-9;]*[349][0-7]m", last)  # no colour


def test_a_replay_takes_as_long_as_its_run() -> None:
    console, _ = terminal()
    clock = Clock()

    shown_on(console, speed=2.0, clock=clock, sleep=clock.sleep)

    assert clock.now == pytest.approx(106.0, abs=1e-6)


def test_ctrl_c_ends_it_and_gives_the_cursor_back() -> None:
    console, out = terminal()

    def interrupt(_seconds: float) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        shown_on(console, speed=1.0, clock=Clock(), sleep=interrupt)
    assert out.getvalue().endswith(SHOW_CURSOR)


def test_an_exception_passes_and_gives_the_cursor_back() -> None:
    console, out = terminal()
    run = trails()

    def fail() -> None:
        with live_view(scene(), run.doers, console, speed=None) as show:
            show(0.0, run.things[0], run.robots[0], run.acting[0])
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fail()
    assert out.getvalue().endswith(SHOW_CURSOR)


def test_a_terminal_without_braille_gets_plain_letters() -> None:
    class Latin(StringIO):
        encoding = "latin-1"

    out = Latin()
    console = Console(file=out, width=80, height=24, force_terminal=True)

    shown_on(console)

    out.getvalue().encode("latin-1")


def test_a_pipe_gets_a_line_now_and_then_and_the_last_moment() -> None:
    out = StringIO()
    run = trails(12.3)

    with live_lines(scene(), run.doers, Console(file=out, width=200), duration=12.3) as show:
        for row, now in enumerate(run.times.tolist()):
            show(now, run.things[row], run.robots[row], run.acting[row])

    lines = out.getvalue().splitlines()
    assert [line.partition("  ")[0] for line in lines[:3]] == ["0 s", "0.5 s", "1 s"]
    assert lines[0] == "0 s  r: x 0.3 m, y 1 m, heading 0°; nobody acts"
    assert lines[-1].startswith("12.3 s  r: x 2.3 m, ")
    assert lines[-1].endswith("; avoid acts")
    assert "\x1b" not in out.getvalue()


def moments(run_time: float) -> tuple[float, Array, Array, Integers]:
    run = trails()
    row = int(np.searchsorted(run.times, run_time))
    return run_time, run.things[row], run.robots[row], run.acting[row]


def test_moments_that_come_too_fast_are_skipped_but_not_the_last() -> None:
    console, out = terminal()
    clock = Clock()

    with live_view(scene(), trails().doers, console, speed=None, clock=clock) as show:
        for tenth in range(100):
            show(*moments(tenth / 10.0))

    assert out.getvalue().count("drive") <= 3  # the first, the last, and rich's at the end
    assert "9.9 s" in out.getvalue()


def test_a_display_that_is_not_there_opens_no_window(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.platform", "linux")
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    monkeypatch.delenv("DISPLAY", raising=False)
    assert not has_display()
    assert open_window("run") is None

    monkeypatch.setenv("DISPLAY", ":9371")
    assert has_display()
    assert open_window("run") is None
