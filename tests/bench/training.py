"""How fast an arbiter is trained, part by part: `python -m tests.bench.training [SCENARIO]`.

Episodes of choices at random, on one process, beside the world alone under the same commands. Times
are the processor's, so that other work on the machine counts less. Then a policy is learnt from all
that was lived.
"""
# ruff: noqa: T201 - a bench prints

import argparse
from pathlib import Path
from time import process_time
from typing import Final

from lcs.policies.steps import joined
from specc.loading import load_scenario
from specc.training.challengers import policy_of
from specc.training.episode import Task, lived
from specc.training.pace import paced
from specc.training.settings import Settings
from specc.training.training import AtRandom
from specc.training.worlds import For, world

ERRAND: Final = Path(__file__).parents[2] / "specs" / "scenarios" / "errand_learned.yaml"


def main() -> None:
    """Print a line for each part."""
    parser = argparse.ArgumentParser()
    parser.add_argument("scenario", nargs="?", type=Path, default=ERRAND)
    parser.add_argument("--episodes", type=int, default=10)
    given = parser.parse_args()
    scenario = load_scenario(given.scenario).scenario
    tasks = [Task(world(For.LEARNING, i), AtRandom(), 1.0, i) for i in range(given.episodes)]
    pace = paced(scenario, tasks)
    steps = [lived(scenario, task).steps for task in tasks]
    policy_of(steps[0], scenario, Settings(), 0)  # to load kernels is no time of learning
    began = process_time()
    policy_of(joined(steps), scenario, Settings(), 0)
    learning = process_time() - began
    parts = {
        "the world alone": pace.world,
        "control": pace.control,
        "beginning and rewards": pace.rewards,
        "learning once": learning,
    }
    total = sum(parts.values())
    print(f"{scenario.name}: {given.episodes} episodes, {pace.decisions:,} decisions")
    print("| part | seconds | share | decisions a second |")
    print("|---|---|---|---|")
    for part, seconds in {**parts, "all": total}.items():
        print(
            f"| {part} | {seconds:.2f} | {seconds / total:.0%} | {pace.decisions / seconds:,.0f} |"
        )


if __name__ == "__main__":
    main()
