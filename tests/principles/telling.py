"""What one process tells of the loaded scenario: the state hash of every step, and its recording.

`python -m tests.principles.telling SECONDS PONDERS RECORDED`: PONDERS are seconds of real time that
whatever happens may hold it up, RECORDED how many of the SECONDS go into the recording.
"""

import dataclasses
import hashlib
import os
import sys
from pathlib import Path

from compiler.world.scenario import compile_scenario
from runtime.recording.scenario_run import recorded_run
from runtime.run import run
from runtime.scenario import Scenario
from tests.principles.loads import Burning
from tests.principles.scenes import Started

PONDERS = "SPECC_PONDERS"
"""The environment variable that the module of the scenario looks at."""
FILE = Path(__file__).parent / "loaded" / "scenario.yaml"


def loaded(seconds: float) -> Scenario:
    """The scenario, cut to so many seconds."""
    made = compile_scenario(FILE, lambda _what, _done, _of: None).scenario
    return dataclasses.replace(made, duration=seconds)


def main() -> None:
    """Print burnt seconds, the digest of the recording, and the hashes, a line each."""
    seconds, ponders, kept = map(float, sys.argv[1:])
    os.environ[PONDERS] = str(ponders)
    made = loaded(seconds)
    burning = Burning(ponders, os.getpid())
    started = Started(made, burning if ponders else None, allow_code=True)
    hashes = [started.scheduler.state_hash().hex()]
    hashes += [started.scheduler.state_hash().hex() for _ in started.steps()]
    short = dataclasses.replace(made, duration=kept)
    whole = run(short, allow_code=True, observer=burning if ponders else None, light_every=1.0)
    assert whole.digest.hex() == hashes[round(kept / made.step)]
    recording = hashlib.sha256(recorded_run(whole)).hexdigest()
    sys.stdout.write("\n".join([f"{burning.burnt:.3f}", recording, *hashes]) + "\n")


if __name__ == "__main__":
    main()
