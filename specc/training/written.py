"""All files that a training leaves in its folder, once it is over."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from runtime.progress import Progress
from runtime.scenario import Scenario
from spec_schema.arbiter import ArbiterSpec
from spec_schema.load import load
from spec_schema.source import Source
from specc.faults import fault
from specc.figures.palettes import PALETTES
from specc.figures.style import Picture, rendered
from specc.figures.style_names import Style
from specc.figures.training import Improving, draw_training
from specc.files import json_bytes, write_atomically, write_over
from specc.texts.amounts import counted
from specc.texts.training import training_record, training_text
from specc.training.episode import training_of
from specc.training.folder import CURVES, RECORD, SUMMARY, arbiter_name
from specc.training.judging import interval
from specc.training.result import Trained
from specc.training.spelled import spelled_in, with_spelled


def write_all(trained: Trained, folder: Path, style: Style, tell: Progress) -> list[str]:
    """Write the arbiter with its rules, the summary and the curves; their names in the folder.

    Raises:
        SpecError: one can't be written (V347).
    """
    names: list[str] = []
    for name, content in _files(trained, style):
        tell(f"writing {name}", len(names), 4)
        write_atomically(folder / name, content)
        names.append(name)
    return names


def write_in_place(before: Source, after: Source) -> Path:
    """Replace the arbiter's own text by that with its rules; its path.

    Raises:
        SpecError: it was changed in the meantime (V374), or can't be written (V347).
    """
    path = Path(before.name)
    write_over(path, before.text, after.text, "its arbiter was trained")
    return path


def kept_text(folder: Path, scenario: Scenario, now: Source, learner: str) -> Source:
    """The arbiter's own text as it is now, with the rules of a training that is finished.

    Raises:
        SpecError: what is kept is wrong, or holds nothing that was learnt (V412).
    """
    path = folder / arbiter_name(scenario)
    spec = load(path).spec
    learned = getattr(spec.by, learner) if isinstance(spec, ArbiterSpec) else None
    if not isinstance(spec, ArbiterSpec) or learned is None:
        message = f"this is not what the training left: it has nothing that {learner} learnt"
        raise fault("V412", path, message, "put it back; or train again in another folder")
    return with_spelled(now, learner, spelled_in(spec, learned))


def _files(trained: Trained, style: Style) -> Iterator[tuple[str, bytes]]:
    yield arbiter_name(trained.scenario), trained.edited.text.encode()
    yield SUMMARY, f"{training_text(trained)}\n".encode()
    yield RECORD, json_bytes(training_record(trained))
    yield CURVES, rendered(_curves(trained, style), "svg", PALETTES[style])


def _curves(trained: Trained, style: Style) -> Picture:
    """How the policies improved."""
    course, settings = trained.course, trained.begun.settings
    every = course.generations
    low, high = np.transpose([interval(each.tried.success, settings.tried_in) for each in every])
    improving = Improving(
        episodes=np.array([each.episodes for each in every]),
        explored=np.array([each.explored.reward for each in every]),
        tried=np.array([each.tried.reward for each in every]),
        explored_success=np.array([each.explored.success for each in every]),
        tried_success=np.array([each.tried.success for each in every]),
        low=low,
        high=high,
        best=every.index(trained.best),
        final=(trained.kept.trial.reward, trained.kept.trial.success),
        worlds=settings.tried_in,
    )
    about = (
        f"{settings.learner} learns how {training_of(trained.scenario).arbiter} decides, anew "
        f"after each race, at first from {counted(settings.first, 'episode')} at random."
    )
    return draw_training(improving, trained.scenario.name, about=[about], style=style)
