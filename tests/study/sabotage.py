"""Each behavior of an architecture sabotaged in turn: does verifying the book name it, alone?

The robot runs specs in which one number or one output is another than in the book's; it is
recorded, and the recordings are held against the book. Minutes.
"""

import shutil
import sys
import tempfile
from dataclasses import dataclass, replace
from pathlib import Path

from runtime.recording.scenario_run import recorded_run
from specc.book.export import export_book
from specc.loading import compile_scenario_spec
from specc.scenarios.simulating import simulate_scenario
from specc.verifying.book_modules import BookVerdict, Standing
from specc.verifying.book_verdict import verify_book

SPECS = Path(__file__).parents[2] / "specs"
SCENARIO = "scenarios/light_hierarchy.yaml"
ARCHITECTURE = "architectures/light_hierarchy.yaml"


@dataclass(frozen=True)
class Sabotage:
    """One edit of a spec: what the robot does otherwise; `node` is to be named."""

    node: str
    how: str
    file: str
    old: str
    new: str


NONE = Sabotage("", "faithful", "avoid.yaml", "", "")
EVERY = (
    NONE,
    Sabotage(
        "avoid", "turns half as fast", "avoid.yaml", "spin: {value: 1.5", "spin: {value: 0.75"
    ),
    Sabotage(
        "avoid", "turns the other way", "avoid.yaml", "spin: {value: 1.5", "spin: {value: -1.5"
    ),
    Sabotage("seek", "0.4 of its gain", "phototaxis.yaml", "is: gain *", "is: 0.4 * gain *"),
    Sabotage("seek", "turns the other way", "phototaxis.yaml", "is: gain *", "is: -gain *"),
    Sabotage(
        "wander", "leans the other way", "wander.yaml", "lean: {value: 0.3", "lean: {value: -0.3"
    ),
    Sabotage("wander", "so, five times", "wander.yaml", "lean: {value: 0.3", "lean: {value: -1.5"),
)


def quiet(_what: str, _done: int, _of: int) -> None:
    """Nobody watches."""


def verdict_on(sabotage: Sabotage, book: Path, folder: Path, seeds: int) -> BookVerdict:
    """What the book's verification says of a robot that was sabotaged."""
    specs = folder / "specs"
    shutil.rmtree(specs, ignore_errors=True)
    shutil.copytree(SPECS, specs, ignore=shutil.ignore_patterns("recordings", "*.md"))
    file = specs / sabotage.file
    assert sabotage.old in file.read_text()
    file.write_text(file.read_text().replace(sabotage.old, sabotage.new, 1))
    scenario = compile_scenario_spec(specs / SCENARIO).scenario
    paths = []
    for seed in range(seeds):
        path = folder / f"run_{seed}.mcap"
        path.write_bytes(recorded_run(simulate_scenario(replace(scenario, seed=seed)).run))
        paths.append(path)
    return verify_book(book, paths, depth="verdict")


def main() -> None:
    """Print a line for each sabotage; `seeds` runs of each, 3 if not told."""
    seeds = int(sys.argv[1]) if len(sys.argv) > 1 else 3
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        export_book(SPECS / ARCHITECTURE, folder / "book", quiet, with_pdf=False)
        for each in EVERY:
            verdict = verdict_on(each, folder / "book", folder, seeds)
            failing = [m.piece.place.node for m in verdict.modules if m.standing is Standing.FAILS]
            told = ", ".join(f"{m.piece.place.node} {m.standing}" for m in verdict.modules)
            named = ", ".join(failing) or "nobody"
            print(f"{each.node or '-':7} {each.how:22} named: {named:8} ({told})", flush=True)


if __name__ == "__main__":
    main()
