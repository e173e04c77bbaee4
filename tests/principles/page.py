"""`docs/principles.md`: a test compares it with this, figures and all.

After a change: `pytest tests/principles/test_table.py --bless`, and read the diff.
"""

from pathlib import Path

from tests.principles.table import PRINCIPLES, Principle

FOLDER = Path(__file__).parent
PAGE = FOLDER.parents[1] / "docs" / "principles.md"
HEAD = """# The principles of a valid simulation

Section 2.4 of the thesis (Bishop, "Simulation and Learning Techniques for Robot Control
Architectures") lists what a simulation owes so that what emerges in it means something: 1a to 1h of
space, 2a to 2g of time. Its own prototype kept those of space "with varying degrees of success",
and none of time but the first (section 2.5). Here is how specc keeps them, where, and what was
measured.

Each has a module of tests in `tests/principles/`, with real specs, the compiler, the scheduler and
the physics, and nothing in their place. `pytest tests/principles` runs them; they also compute the
figures below anew, and compare this page with them. `make study-principles` adds an hour under
load.

| | the principle | how it is kept | measured |
|---|---|---|---|"""

LOAD = """## Two runs, one of them under load

What 1f and 2c to 2g say together is that no time of a computer is in a run. So one scenario (two
robots, eight nodes at three rates that answer 0 to 350 ms late, one of them a module of one's own)
runs in two fresh processes. One is left alone, with one thread. Beside the other, busy processes
take its processors; its module and whatever is observed take random real times; it has four
threads, and another seed for Python's hashes. `tests/principles/test_load.py` compares the state
hash of every step and the bytes of the recordings; `make study-principles` does so for a simulated
hour. 200 simulated seconds, 48,001 states, on a computer of two processors that others used, too:

```
alone, 1 thread                               117 s   last hash f7e1b46e38d446a9aeaeeab2a07342dd
beside 2 busy processes, 4 threads,           218 s   last hash f7e1b46e38d446a9aeaeeab2a07342dd
held up at random for 153 s of them                   0 of 48,001 hashes differ; recordings equal
```
"""

HELD = """## What was broken to see the tests fail

A test that cannot fail holds nothing. So for each principle the code was broken once, in a scratch
copy, and the tests run.
"""


def names_of_tests(letter: str) -> list[str]:
    """The tests of a principle by their names, in the order of its module."""
    [module] = FOLDER.glob(f"test_{letter}_*.py")
    lines = module.read_text(encoding="utf-8").splitlines()
    return [line[4:].partition("(")[0] for line in lines if line.startswith("def test_")]


def page() -> str:
    """`docs/principles.md`."""
    rows = [f"| **{p.letter}** | {p.said} | {p.kept} | {p.figure()} |" for p in PRINCIPLES]
    held = [
        line
        for p in PRINCIPLES
        for line in (
            _heading(p),
            "",
            *(f"* {_words(name)}" for name in p.fails),
            "",
        )
    ]
    return "\n".join([HEAD, *rows, "", LOAD, HELD, *held]).rstrip() + "\n"


def _heading(one: Principle) -> str:
    where = f"`tests/principles/{_module(one.letter)}`"
    return f"**{one.letter}**, {where}. Broken: {one.broken}. Then failed:"


def _module(letter: str) -> str:
    [module] = FOLDER.glob(f"test_{letter}_*.py")
    return module.name


def _words(name: str) -> str:
    """The sentence that a test's name is."""
    return name.removeprefix("test_").replace("_", " ")
