"""The folder of an experiment: what it says, where its runs are kept, and whether it is one.

experiment.json             what is run
seed_0/checkpoint.npz       a run, to go on from
...                         figures, curves, rules and the summary, once all runs are done
"""

import dataclasses
from pathlib import Path
from typing import Final

from specc.faults import fault
from specc.files import json_bytes, write_atomically
from specc.kept import record_in, refuse_file, refuse_taken
from specc.learning.experiment import Experiment, experiment_of, record_of, usual

EXPERIMENT: Final = "experiment.json"
CHECKPOINT: Final = "checkpoint.npz"
SUMMARY: Final = "summary.txt"
RECORD: Final = "summary.json"
CURVES: Final = "learning.svg"
POPULATION: Final = "population.svg"

NAMES: Final = (SUMMARY, RECORD, CURVES, POPULATION)
"""What an experiment writes beside its own file and the folders of its runs."""


def begin_in(folder: Path, experiment: Experiment) -> None:
    """Write what is run, where nothing else is.

    Raises:
        SpecError: the folder holds an experiment (V403), is none or holds something that an
            experiment would write over (V405), or can't be written (V347).
    """
    refuse_file(folder, "V405")
    if (folder / EXPERIMENT).exists():
        remedy = f"`specc learn --resume -o {folder}` goes on with it; or name another folder"
        raise fault("V403", folder, "this folder holds an experiment already", remedy)
    taken = [folder / name for name in NAMES]
    taken += [run_folder(folder, seed) for seed in experiment.seeds]
    refuse_taken(taken, "V405", "experiment")
    write_experiment(folder, experiment)


def write_experiment(folder: Path, experiment: Experiment) -> None:
    """Say what is run there.

    Raises:
        SpecError: it can't be written (V347).
    """
    write_atomically(folder / EXPERIMENT, json_bytes(record_of(experiment)))


def experiment_in(folder: Path) -> Experiment:
    """What is run there.

    Raises:
        SpecError: the folder holds no experiment (V403), or none that can be read (V404), or is
            no folder (V405).
        OSError: it can't be read.
    """
    refuse_file(folder, "V405")
    path = folder / EXPERIMENT
    if not path.exists():
        remedy = "name the folder that -o named; or leave --resume out"
        raise fault("V403", folder, f"there is nothing to resume: no {EXPERIMENT}", remedy)
    return record_in(path, "V404", "experiment", experiment_of)


def continued(folder: Path, kept: Experiment, cycles: int | None) -> Experiment:
    """The experiment that a folder keeps, with so many cycles; None for as many as it has.

    Raises:
        SpecError: more were done already (V403), or it can't be written (V347).
    """
    if cycles in {None, kept.cycles}:
        return kept
    if cycles is not None and cycles < kept.cycles:
        unit = usual(kept.problem).unit
        message = f"{cycles:,} {unit}s are fewer than the {kept.cycles:,} that it is to have"
        raise fault("V403", folder, message, f"write more --{unit}s, or begin in another folder")
    longer = dataclasses.replace(kept, cycles=cycles)
    write_experiment(folder, longer)
    return longer


def run_folder(folder: Path, seed: int) -> Path:
    """Where the run of a seed is kept."""
    return folder / run_name(seed)


def run_name(seed: int) -> str:
    """The folder of a run in that of its experiment."""
    return f"seed_{seed}"


def checkpoint(folder: Path, seed: int) -> Path:
    """The file that a run goes on from."""
    return run_folder(folder, seed) / CHECKPOINT
